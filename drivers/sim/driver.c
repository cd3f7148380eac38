#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "add_sense.h"
#include "ethd/driver.h"
#include "ethd/sim.h"
#include "finger/limits.h"
#include "sim/plant.h"
#include "sim/settings.h"
#include "text/error_text.h"

#define CATCH_UP_MAX 1000 /* periods: after a longer gap simulated time falls behind */

typedef struct device {
  ethd_sim *sim;
  ethd_sim_def def;
  ethd_sim_tap tap;
  _Atomic int32_t safe; /* any thread's */
  bool no_finger;
  bool written;      /* `held` and `due_ns` are known */
  int64_t due_ns;    /* the tick at which the next read is expected */
  ethd_command held; /* of the last write */
} device;

static ethd_status load_plant(const ethd_device_def *def, const ethd_setting *setting, ethd_plant *out, char *message) {
  const char *plant = setting ? setting->value : ETHD__PLANT;
  ETHD__FREED char *path = ethd__plant_path(plant, def->folder);
  ethd_status status = path ? ethd_plant_load(path, out, message) : ethd__no_memory(message, NULL);
  if (path && status == ETHD_E_FILE && !strpbrk(plant, "/.") && access(path, F_OK))
    (void)ethd__say(message, status, "%s: %s; ETHD_DATA_DIR may name the folder of the installed plants", path,
                    strerror(errno));
  return status;
}

static ethd_status create(const ethd_device_def *def, const ethd__sim_settings *s, device *d, char *message) {
  ethd_error error = {0};
  ethd_status status = load_plant(def, s->plant, &d->def.plant, message);
  if (status) return status;
  ethd__sim_settings_finger(s, &d->def.plant);
  d->no_finger = s->p[ETHD__SIM_EMPTY] > 0;
  if (d->no_finger) d->def.plant.pad_stiffness = 0;
  status = ethd_sim_create(&d->def, &d->sim, &error);
  if (!status) {
    ethd_vec meet = {s->p[ETHD__SIM_MEET_X], s->p[ETHD__SIM_MEET_Y]};
    ethd_sim_draw(&d->def.plant, (uint64_t)s->p[ETHD__SIM_SEED], (uint64_t)s->p[ETHD__SIM_TAP], s->p[ETHD__SIM_SPEED],
                  meet, &d->tap);
    if (d->no_finger) { /* then there is only the ring */
      d->tap.path.from = meet;
      d->tap.path.to_x = meet.x;
    }
    status = ethd_sim_start(d->sim, &d->tap);
    if (status) ethd__sim_refuse(&error, status, "sim", NAN, NAN, NAN);
  }
  if (status) ethd_error_text(def->file, &error, message);
  return status;
}

static ethd_status sim_open(const ethd_device_def *def, void **out, char message[ETHD_MESSAGE_MAX]) {
  ethd__sim_settings s;
  *out = NULL;
  ethd_status status = ethd__sim_settings_read(def, &s, message);
  if (status) return status;
  device *d = *out = calloc(1, sizeof *d);
  if (!d) return ETHD_E_MEMORY;
  d->def = (ethd_sim_def){.arm = def->setup->arm,
                          .ring_radius = def->setup->ring_radius,
                          .period = def->setup->period,
                          .step = s.p[ETHD__SIM_STEP],
                          .tolerance = s.p[ETHD__SIM_TOLERANCE]};
  return create(def, &s, d, message);
}

/* Begins the tap again. */
static ethd_status start(void *device_) {
  device *d = device_;
  d->safe = 0;
  d->written = 0;
  return ethd_sim_start(d->sim, &d->tap);
}

static int64_t period_ns(const device *d) { return (int64_t)rint(1e9 * d->def.period); }

/* Simulates the periods that the loop missed, under the torque that it left. */
static void catch_up(device *d, int64_t now_ns) {
  if (d->safe) d->held.safe = 1;
  for (int i = 0; d->written && i < CATCH_UP_MAX && now_ns - d->due_ns >= period_ns(d); i++) {
    ethd_sim_write(d->sim, &d->held);
    d->due_ns += period_ns(d);
  }
}

static ethd_status sim_read(void *device_, int64_t now_ns, ethd_sense *out) ETHD_RT {
  device *d = device_;
  ethd_sense own;
  catch_up(d, now_ns);
  ethd_sim_read(d->sim, &own);
  if (d->no_finger) own.have = 0;
  ethd__sense_add(&own, true, out);
  return ETHD_OK;
}

/* Writes the command. With a virtual clock a period passes here. */
static ethd_status sim_write(void *device_, int64_t now_ns, const ethd_command *command) ETHD_RT {
  device *d = device_;
  d->held = *command;
  if (d->safe) d->held.safe = 1;
  d->written = 1;
  d->due_ns = now_ns + period_ns(d);
  ethd_sim_write(d->sim, &d->held);
  return ETHD_OK;
}

static void safe(void *device_) ETHD_RT { ((device *)device_)->safe = 1; }

static void close_device(void *device_) {
  device *d = device_;
  if (!d) return;
  ethd_sim_destroy(d->sim);
  free(d);
}

static ethd_limits limits(const void *device_) {
  const device *d = device_;
  const ethd_plant *plant = &d->def.plant;
  ethd_limits limits = ethd_limits_torque(plant->force_limit * fmin(d->def.arm.link1, d->def.arm.link2));
  if (plant->reading <= ETHD_READING_RAYS) return limits;
  ethd__finger_limits(plant->rate, plant->latency, &limits); /* the same as the real sensor's driver states */
  return limits;
}

static ethd_dynamics dynamics(const void *device_) {
  return ethd_plant_dynamics(&((const device *)device_)->def.plant);
}

const ethd_driver ethd_driver_sim = {
    .size = sizeof(ethd_driver),
    .abi = ETHD_DRIVER_ABI,
    .id = "sim",
    .brief = "simulated device: plausible, fitted to the paper's Table 1, not measured",
    .params = ethd__sim_params,
    .param_count = ETHD__SIM_PARAMS,
    .keys = ethd__sim_keys,
    .open = sim_open,
    .start = start,
    .read = sim_read,
    .write = sim_write,
    .safe = safe,
    .close = close_device,
    .limits = limits,
    .dynamics = dynamics,
    .prepare = sim_open, /* it touches nothing */
};
