/* Your own driver, for amplifiers on a slow bus: the control thread only uses two cells, and an I/O thread makes the exchanges. The amplifiers are a model here (J dw/dt = torque - b w); put yours into `exchange`.
   As a program it tests the driver against its contract:

     cc driver.c $(pkg-config --cflags --libs ethd-drivers) -o driver && ./driver

   As a shared object it is a driver for every program: [device] driver = file:driver.so

     cc -shared -fPIC driver.c $(pkg-config --cflags ethd-drivers) -o driver.so */
#include <ethd/cell.h>
#include <ethd/conform.h>
#include <ethd/loop.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

#define INERTIA 0.02      /* kg m^2 */
#define FRICTION 0.05     /* Nms/rad */
#define WATCHDOG 20000000 /* ns: without an exchange for so long the amplifiers let go */
#define FAR 20.0          /* rad: no joint turns that far */

typedef struct answer {
  double q[2]; /* rad */
  int64_t at;  /* ns */
} answer;

typedef struct bus {
  ethd_cell *orders, *answers;
  _Atomic int32_t safe; /* set by any thread: no torque until the next start */
  _Atomic int32_t anew; /* set by start: the running I/O thread begins from rest */
  _Atomic int32_t bad;  /* an answer was damaged: from the I/O thread to the control thread */
  answer seen;          /* the control thread's */
  ethd_command taken;   /* the I/O thread's, as all that follows */
  double q[2], w[2];    /* the model's angles and speeds */
  int64_t now, heard;   /* ns */
} bus;

/* One exchange: torques out, angles back. Here a real driver blocks for as long as its bus takes. Data from the bus are checked before use; every comparison with NaN is false. Without a good answer the loop removes the torque. */
static ethd_status exchange(bus *b, int64_t now_ns) {
  double dt = b->now ? 1e-9 * (double)(now_ns - b->now) : 0;
  int alive = now_ns - b->heard <= WATCHDOG;
  for (int i = 0; i < 2; i++) {
    b->w[i] += dt / INERTIA * ((alive ? b->taken.torque[i] : 0) - FRICTION * b->w[i]);
    b->q[i] += dt * b->w[i];
  }
  b->now = now_ns;
  answer a = {{b->q[0], b->q[1]}, now_ns};
  int good = fabs(a.q[0]) < FAR && fabs(a.q[1]) < FAR;
  if (good) ethd_cell_put(b->answers, &a);
  if (!good) b->bad = 1;
  return good ? ETHD_OK : ETHD_E_DEVICE;
}

static ethd_status open_bus(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  bus *b = *device = calloc(1, sizeof *b);
  ethd_error error;
  ethd_status status = b ? ethd_settings_read(&ethd_driver_plugin, def, NULL, NULL, message) : ETHD_E_MEMORY;
  if (!status) status = ethd_cell_create(sizeof(ethd_command), &b->orders, &error);
  if (!status) status = ethd_cell_create(sizeof(answer), &b->answers, &error);
  if (!status) status = ethd_arm_angles(&def->setup->arm, (ethd_vec){0.25, 0.25}, -1, b->q);
  if (!status) b->seen = (answer){{b->q[0], b->q[1]}, 0}; /* for a `read` before any service, which is STALE */
  return status;
}

/* Begins at rest, without an earlier torque. An I/O thread may be in `service`, and sets its own data itself. */
static ethd_status start(void *device) {
  bus *b = device;
  ethd_cell_put(b->orders, &(ethd_command){.safe = 1});
  b->bad = 0;
  b->anew = 1;
  b->safe = 0;
  return ETHD_OK;
}

/* No thread uses the bus any more: the last message is zero torque. */
static ethd_status stop(void *device) {
  bus *b = device;
  b->safe = 1;
  b->taken = (ethd_command){.safe = 1};
  return exchange(b, b->now);
}

static uint32_t units(const void *device) { return (void)device, 1; }

static ethd_status service(void *device, uint32_t unit, int64_t now_ns) {
  bus *b = device;
  if (atomic_exchange(&b->anew, 0)) b->w[0] = b->w[1] = 0, b->now = b->heard = 0;
  if (ethd_cell_take(b->orders, &b->taken) == ETHD_OK) b->heard = now_ns;
  if (b->safe) b->taken = (ethd_command){.safe = 1};
  return (void)unit, exchange(b, now_ns);
}

static ethd_status read_joints(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT {
  bus *b = device;
  ethd_status status = ethd_cell_take(b->answers, &b->seen);
  for (int i = 0; i < 2; i++) out->q[i] = b->seen.q[i];
  out->time_ns = b->seen.at;
  if (atomic_exchange(&b->bad, 0)) out->faults |= ETHD_FAULT_BIT(ETHD_FAULT_REPLY_BAD);
  return (void)now_ns, status; /* ETHD_STATUS_STALE: the loop waits for the next one */
}

static ethd_status write_torque(void *device, int64_t now_ns, const ethd_command *command) ETHD_RT {
  ethd_cell_put(((bus *)device)->orders, command);
  return (void)now_ns, ETHD_OK;
}

static void safe(void *device) ETHD_RT { ((bus *)device)->safe = 1; }
static ethd_limits limits(const void *device) {
  ethd_limits limits = ethd_limits_device(); /* its gap, 5 ms, is the spacing of samples; a slower bus sets its own */
  return (void)device, limits.torque = 1, limits;
}

static void close_bus(void *device) {
  bus *b = device;
  ethd_cell_destroy(b->orders);
  ethd_cell_destroy(b->answers);
  free(b);
}

/* The symbol that a shared object must export. */
const ethd_driver ethd_driver_plugin = {.size = sizeof(ethd_driver),
                                        .abi = ETHD_DRIVER_ABI,
                                        .id = "mine",
                                        .brief = "two amplifiers on a slow bus",
                                        .open = open_bus,
                                        .start = start,
                                        .read = read_joints,
                                        .write = write_torque,
                                        .units = units,
                                        .service = service,
                                        .safe = safe,
                                        .stop = stop,
                                        .close = close_bus,
                                        .limits = limits};

int main(void) {
  static const char *const words[] = {"kept", "BROKEN", "at risk", "not asked"};
  const ethd_driver *const drivers[] = {&ethd_driver_plugin, NULL};
  ethd_setup setup = ethd_setup_default();
  const ethd_device_def device = {.setup = &setup, .folder = ".", .is_virtual = 1};
  const ethd_conform_def questions = {"mine", drivers, &device, 0.1, NULL};
  ethd_conform_answer answers[ETHD_QUESTIONS];
  ethd_status status = ethd_conform(&questions, answers);
  for (int i = 0; i < ETHD_QUESTIONS; i++)
    printf("%-9s %-10s %s\n", answers[i].question, words[answers[i].verdict], answers[i].found);
  return status ? 1 : 0;
}
