/* The servo as a driver: its remarks and limits, and its table. */
#include <math.h>
#include <string.h>

#include "servo/device.h"
#include "servo/words.h"

static uint32_t units(const void *device) {
  (void)device;
  return 1;
}

static ethd_limits limits(const void *device) {
  const ethd__servo_device *d = device;
  int32_t count = d->map.roles[ETHD__SERVO_READING_COUNT];
  ethd_limits limits = ethd_limits_device();
  limits.speed = d->speed;
  /* the finger's sensor says its rate: three missing readings count as old, nine as lost */
  limits.finger_age = count < 0 ? (double)INFINITY : 3 / d->map.registers[count].rate;
  limits.finger_lost = 3 * limits.finger_age;
  /* one spacing of samples, and a second one because one answer may be missing */
  limits.gap = 1e-9 * (double)ethd__servo_old(d);
  for (int i = 0; i < 2; i++) {
    int32_t r = d->map.roles[ETHD__SERVO_TORQUE1 + i];
    if (r >= 0) limits.torque = fmin(limits.torque, ethd__servo_most(&d->map.registers[r]));
  }
  return limits;
}

static uint32_t joints(const void *device) {
  const ethd__servo_device *d = device;
  uint32_t bits = 0;
  for (int i = 0; i < 2; i++)
    if (d->joint[i] >= 0) bits |= 1u << d->joint[i];
  return bits;
}

static double at(const ethd_histogram *h, double share) { return 1e-9 * (double)ethd_histogram_at(h, share); }

/* The largest joint angle that one count stands for; NAN when positions aren't in counts. */
static double count_of(const ethd__servo_map *map) {
  double most = (double)NAN;
  for (int i = 0; i < 2; i++) {
    int32_t r = map->roles[ETHD__SERVO_POSITION1 + i];
    if (r < 0 || !(map->registers[r].counts > 0)) continue;
    most = fmax(most, fabs(ethd__servo_joint(&map->registers[r], 1) - ethd__servo_joint(&map->registers[r], 0)));
  }
  return most;
}

static uint32_t figures(const void *device, ethd_figure *out, uint32_t max) {
  const ethd__servo_device *d = device;
  const ethd__servo_counts *c = &d->link.counts;
  const ethd_figure all[] = {
      {"servo exchanges", "1", (double)c->exchanges},
      {"servo round trip p50", "s", at(&d->trip, 0.5)},
      {"servo round trip p99", "s", at(&d->trip, 0.99)},
      {"servo round trip max", "s", 1e-9 * (double)d->trip.max},
      {"servo feedback age p50", "s", at(&d->age, 0.5)},
      {"servo feedback age p99", "s", at(&d->age, 0.99)},
      {"servo feedback age max", "s", 1e-9 * (double)d->age.max},
      {"servo answers missing", "1", (double)c->missing},
      {"servo answers stale", "1", (double)c->stale},
      {"servo answers damaged or refused", "1", (double)(c->garbled + c->busy + c->refused + c->failed)},
      {"servo links lost", "1", (double)c->lost},
      {"servo links made", "1", (double)c->connects},
      {"joint angle a count", "rad", count_of(&d->map)},
      {"delay from measurement to torque", "s", 1e-9 * (double)d->exchange_ns},
      {"guardian acted", "1", d->guardian.page ? (double)atomic_load(&d->guardian.page->acts) : 0},
  };
  uint32_t n = sizeof all / sizeof *all;
  if (n > max) n = max;
  memcpy(out, all, n * sizeof *out);
  return n;
}

/* Remarks in this order: the duration of an exchange, until it is measured; the number of unconfirmed registers; a too
   coarse torque; a doubtful inertia; the guardian; the line's own delay; then the map's gaps. */
static const char *remark(const void *device, uint32_t i) {
  const ethd__servo_device *d = device;
  const char *own[8];
  uint32_t n = 0;
  if (!d->link.counts.connects) own[n++] = d->wire;
  if (d->unconfirmed[0]) own[n++] = d->unconfirmed;
  if (d->coarse[0]) own[n++] = d->coarse;
  for (int axis = 0; axis < 2; axis++)
    if (d->inertia[axis][0]) own[n++] = d->inertia[axis];
  if (d->guarded[0]) own[n++] = d->guarded;
  if (d->link.bus.fd >= 0 && !d->link.bus.at_once)
    own[n++] = "the serial line's driver holds bytes back: answers may be late (FTDI: 1 into "
               "/sys/bus/usb-serial/devices/ttyUSB0/latency_timer; step 1)";
  if (d->map.transport == ETHD__SERVO_RTU && !(d->map.turnaround > 0))
    own[n++] = "bus.turnaround is 0: ethd-conform --probe measures how long the drive takes to answer (step 3)";
  return i < n ? own[i] : ethd__servo_risk(&d->map, i - n);
}

const ethd_driver ethd_driver_servo = {
    .size = sizeof(ethd_driver),
    .abi = ETHD_DRIVER_ABI,
    .id = "servo",
    .brief = "servo drive on a Modbus, by a register map",
    .params = ethd__servo_params,
    .param_count = ETHD__SERVO_PARAMS,
    .keys = ethd__servo_keys,
    .open = ethd__servo_open,
    .start = ethd__servo_start,
    .read = ethd__servo_read,
    .write = ethd__servo_write,
    .units = units,
    .service = ethd__servo_service,
    .safe = ethd__servo_safe,
    .stop = ethd__servo_stop,
    .close = ethd__servo_close,
    .limits = limits,
    .figures = figures,
    .remark = remark,
    .clear = ethd__servo_clear,
    .home = ethd__servo_home,
    .why = ethd__servo_why,
    .prepare = ethd__servo_prepare,
    .joints = joints,
};
