#include "check/conform_rig.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

ethd_verdict ethd__rig_answer(ethd_conform_answer *a, ethd_verdict verdict, const char *format, ...) {
  va_list args;
  va_start(args, format);
  vsnprintf(a->found, sizeof a->found, format, args);
  va_end(args);
  return a->verdict = verdict;
}

/* ---- time ---- */

static void await_tick(ethd__rig *r) {
  struct timespec t;
  r->now += r->period;
  if (r->def->is_virtual) return;
  t = (struct timespec){.tv_sec = (time_t)(r->now / 1000000000), .tv_nsec = (long)(r->now % 1000000000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL)) continue;
}

static int64_t clock_now(const ethd_conform_def *def) {
  struct timespec t;
  if (def->is_virtual) return 0;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

/* ---- a device ---- */

int ethd__rig_open(const ethd_conform_def *def, ethd__rig *r) {
  memset(r, 0, sizeof *r);
  r->def = def;
  r->period = llrint(1e9 * def->device->setup->period);
  r->now = clock_now(def);
  r->resolution = (double)INFINITY;
  r->finite = 1;
  return ethd_device_open(def->ids, def->from, def->device, &r->driver, &r->device, r->message) == ETHD_OK;
}

int ethd__rig_begin(const ethd_conform_def *def, ethd__rig *r, ethd_conform_answer *a) {
  if (!ethd__rig_open(def, r)) return ethd__rig_answer(a, ETHD_BROKEN, "open: %.140s", r->message), 0;
  ethd_status status = r->driver->start(r->device);
  if (status >= 0) return 1;
  r->driver->close(r->device);
  return ethd__rig_answer(a, ETHD_BROKEN, "start: %s", ethd_status_sentence(status)), 0;
}

void ethd__rig_end(ethd__rig *r) {
  (void)!r->driver->stop(r->device);
  r->driver->close(r->device);
}

static void look(ethd__rig *r, const ethd_sense *s) {
  const ethd_sense *before = &r->sense;
  double dt = 1e-9 * (double)(s->time_ns - before->time_ns);
  for (int i = 0; i < 2; i++) {
    double step = fabs(s->q[i] - before->q[i]);
    r->finite &= isfinite(s->q[i]) != 0;
    if (!r->samples || !(dt > 0)) continue;
    if (step > 0) r->resolution = fmin(r->resolution, step);
    r->speed = fmax(r->speed, step / dt);
  }
  r->backwards += r->samples && dt < 0;
  r->ahead += s->time_ns > r->now;
  r->faults |= s->faults | s->grave;
  r->samples++;
}

/* One period: I/O, read, and the torque unless it is NULL. */
static void tick(ethd__rig *r, const double *torque) {
  ethd_sense s = {0};
  ethd_command command = {.safe = torque == NULL};
  if (torque) memcpy(command.torque, torque, sizeof command.torque);
  await_tick(r);
  for (uint32_t u = 0, n = r->driver->units(r->device); u < n; u++)
    (void)!r->driver->service(r->device, u, r->now);
  ethd_status status = r->driver->read(r->device, r->now, &s);
  r->failed += status < 0;
  if (status == ETHD_OK) {
    look(r, &s);
    r->sense = s;
  }
  if (r->samples) r->age = fmax(r->age, 1e-9 * (double)(r->now - r->sense.time_ns));
  if (torque) r->failed += r->driver->write(r->device, r->now, &command) < 0;
}

void ethd__rig_run(ethd__rig *r, double seconds, int joint, double torque) {
  const double both[2] = {joint == 0 ? torque : 0, joint == 1 ? torque : 0};
  for (int k = 0, n = (int)ceil(seconds * 1e9 / (double)r->period); k < n; k++) tick(r, both);
}

double ethd__rig_acceleration(ethd__rig *r, int joint, double torque, int write, double window) {
  double q[3], both[2] = {joint == 0 ? torque : 0, joint == 1 ? torque : 0};
  int n = (int)ceil(window * 1e9 / (double)r->period);
  for (int k = 0; k < 3; k++) {
    for (int i = 0; k && i < n; i++) tick(r, write ? both : NULL);
    q[k] = r->sense.q[joint];
  }
  return (q[2] - 2 * q[1] + q[0]) / (window * window);
}
