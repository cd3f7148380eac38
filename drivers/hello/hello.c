/* A driver to copy, of two modelled motors, J dw/dt = torque - b w. A real driver puts its hardware in place of the
   model: its encoders in `read`, its amplifier in `write`, its brake or enable line in `start` and `safe`.

   Built in, [device] driver = hello; or as a file of its own, driver = file:hello.so:
     cc -shared -fPIC -DHELLO=ethd_driver_plugin hello.c -o hello.so $(pkg-config --cflags ethd-drivers) */
#include <stdlib.h>

#include "ethd/control.h"
#include "ethd/driver.h"

#ifndef HELLO
#define HELLO ethd_driver_hello
#endif
#define INERTIA 0.02      /* kg m^2 */
#define FRICTION 0.05     /* Nms/rad */
#define WATCHDOG 20000000 /* ns: without a write for so long there is no torque */

typedef struct hello {
  double q[2], w[2], torque[2];
  int64_t now, written; /* ns */
  _Atomic int32_t safe; /* set by any thread */
} hello;

static ethd_status open_hello(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  hello *h = *device = calloc(1, sizeof *h);
  ethd_status status = h ? ethd_settings_read(&HELLO, def, NULL, NULL, message) : ETHD_E_MEMORY;
  return status ? status : ethd_arm_angles(&def->setup->arm, (ethd_vec){0.25, 0.25}, -1, h->q);
}

/* Begins at rest where the device stands, without a torque from before. */
static ethd_status start(void *device) {
  hello *h = device;
  *h = (hello){.q = {h->q[0], h->q[1]}};
  return ETHD_OK;
}

static ethd_status read_joints(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT {
  hello *h = device;
  double dt = h->now ? 1e-9 * (double)(now_ns - h->now) : 0;
  int alive = !h->safe && now_ns - h->written <= WATCHDOG;
  for (int i = 0; i < 2; i++) h->w[i] += dt / INERTIA * ((alive ? h->torque[i] : 0) - FRICTION * h->w[i]);
  for (int i = 0; i < 2; i++) out->q[i] = h->q[i] += dt * h->w[i];
  out->time_ns = h->now = now_ns;
  return ETHD_OK;
}

static ethd_status write_torque(void *device, int64_t now_ns, const ethd_command *command) ETHD_RT {
  hello *h = device;
  for (int i = 0; i < 2; i++) h->torque[i] = command->torque[i];
  h->written = now_ns;
  return ETHD_OK;
}

static void safe(void *device) ETHD_RT { ((hello *)device)->safe = 1; }

static ethd_limits limits(const void *device) {
  ethd_limits limits = ethd_limits_device();
  limits.torque = 1;                                         /* Nm */
  limits.finger_age = limits.finger_lost = (double)INFINITY; /* for the finger's sensor to say */
  return (void)device, limits;
}

const ethd_driver HELLO = {.size = sizeof(ethd_driver),
                           .abi = ETHD_DRIVER_ABI,
                           .id = "hello",
                           .brief = "two simulated motors; an example to copy",
                           .open = open_hello,
                           .start = start,
                           .read = read_joints,
                           .write = write_torque,
                           .safe = safe,
                           .close = free,
                           .limits = limits,
                           .prepare = open_hello /* it touches nothing */};
