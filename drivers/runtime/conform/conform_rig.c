#include "conform/conform_rig.h"

#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "clock.h"

#define CLEARING 0.3 /* s */
#define PAUSED 0.1   /* s: longer spacings don't count, since no sample was requested in between */
#define IDLE 1000000 /* ns: sleep of an I/O thread without work */
#define STEPS 8      /* steps of the angle that an acceleration must cause to be seen */
#define LOOK 0.01    /* s between two checks of the joints' motion, */
#define SETTLE 200   /* attempts at most */
#define STANDS 0.02  /* rad/s: a slower joint stands */

ethd_verdict ethd__conform_rig_answer(ethd_conform_answer *a, ethd_verdict verdict, const char *format, ...) {
  va_list args;
  va_start(args, format);
  vsnprintf(a->found, sizeof a->found, format, args);
  va_end(args);
  return a->verdict = verdict;
}

bool ethd__conform_stopped(const ethd_conform_def *def) { return def->stop && *def->stop; }

ethd_status ethd__conform_ask(const ethd_conform_def *def, const ethd__conform_question *questions, int count,
                              double push, ethd_conform_answer *answers) {
  bool broken = false;
  for (int i = 0; i < count; i++) {
    ethd_conform_answer *a = &answers[i];
    a->question = questions[i].name;
    if (i && answers[0].verdict == ETHD_VERDICT_BROKEN)
      ethd__conform_rig_answer(a, ETHD_VERDICT_NOT_ASKED, "the device can't be opened, or its table is broken");
    else if (questions[i].moves && !(def->torque > 0 && isfinite(push)))
      ethd__conform_rig_answer(a, ETHD_VERDICT_NOT_ASKED, "it would move the device");
    else if (!ethd__conform_stopped(def))
      (void)questions[i].ask(def, a);
    if (ethd__conform_stopped(def)) ethd__conform_rig_answer(a, ETHD_VERDICT_NOT_ASKED, "stopped");
    broken |= a->verdict == ETHD_VERDICT_BROKEN;
  }
  if (ethd__conform_stopped(def)) return ETHD_E_UNFINISHED;
  return broken ? ETHD_E_DEVICE : ETHD_OK;
}

/* ---- time ---- */

void ethd__conform_rig_await(ethd__conform_rig *r) {
  struct timespec t;
  r->now += r->period;
  if (r->def->device->is_virtual) return;
  t = (struct timespec){.tv_sec = (time_t)(r->now / 1000000000), .tv_nsec = (long)(r->now % 1000000000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL)) continue;
  r->late = fmax(r->late, 1e-9 * (double)(ethd__clock_now() - r->now));
}

/* ---- I/O, as in the loop: by threads, or with the tick of a virtual clock ---- */

static void *run_unit(void *unit_) {
  const ethd__conform_rig_unit *unit = unit_;
  ethd__conform_rig *r = unit->rig;
  const struct timespec pause = {.tv_nsec = IDLE};
  while (!atomic_load(&r->stop))
    if (ethd_device_service(r->device, unit->number, ethd__clock_now())) nanosleep(&pause, NULL);
  return NULL;
}

static void start_units(ethd__conform_rig *r) {
  atomic_store(&r->stop, 0);
  for (uint32_t u = 0, n = ethd_device_units(r->device); u < n && !r->def->device->is_virtual; u++) {
    r->unit[u] = (ethd__conform_rig_unit){.rig = r, .number = u};
    if (pthread_create(&r->unit[u].thread, NULL, run_unit, &r->unit[u])) return;
    r->units++;
  }
}

static void stop_units(ethd__conform_rig *r) {
  atomic_store(&r->stop, 1);
  for (; r->units; r->units--) pthread_join(r->unit[r->units - 1].thread, NULL);
}

/* ---- a device ---- */

bool ethd__conform_rig_open(const ethd_conform_def *def, ethd__conform_rig *r) {
  memset(r, 0, sizeof *r);
  r->def = def;
  r->period = llrint(1e9 * (def->device->space ? def->device->space->period : def->device->setup->period));
  r->now = def->device->is_virtual ? 0 : ethd__clock_now();
  r->resolution = (double)INFINITY;
  r->finite = 1;
  return ethd_device_open(def->ids, def->from, def->device, &r->device, r->message) == ETHD_OK;
}

bool ethd__conform_rig_begin(const ethd_conform_def *def, ethd__conform_rig *r, ethd_conform_answer *a) {
  if (!ethd__conform_rig_open(def, r))
    return ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "open: %.140s", r->message), 0;
  ethd_status status = ethd__conform_rig_start(r);
  if (status >= 0) return 1;
  ethd_device_close(r->device);
  return ethd__conform_rig_answer(a, ETHD_VERDICT_BROKEN, "start: %s", ethd_status_sentence(status)), 0;
}

/* Lets the device do its I/O for a while, without a loop. */
static void serve(ethd__conform_rig *r, double seconds) {
  const struct timespec pause = {.tv_nsec = IDLE};
  for (int64_t left = (int64_t)(1e9 * seconds); left > 0; left -= r->period) {
    int64_t now = r->def->device->is_virtual ? (r->now += r->period) : ethd__clock_now();
    for (uint32_t u = 0, n = ethd_device_units(r->device); u < n; u++) (void)!ethd_device_service(r->device, u, now);
    if (!r->def->device->is_virtual) nanosleep(&pause, NULL);
  }
}

ethd_status ethd__conform_rig_start(ethd__conform_rig *r) {
  if (ethd__conform_stopped(r->def)) return ETHD_E_UNFINISHED; /* no device is enabled after a stop */
  ethd_status status = ethd_device_start(r->device);
  if (status < 0) {
    ethd_device_clear(r->device);
    serve(r, CLEARING);
    status = ethd_device_start(r->device);
  }
  if (status < 0) return status;
  start_units(r);
  if (!r->def->device->is_virtual) r->now = ethd__clock_now(); /* a start takes its time */
  return status;
}

void ethd__conform_rig_stop(ethd__conform_rig *r) {
  stop_units(r);
  (void)!ethd_device_stop(r->device);
}

void ethd__conform_rig_end(ethd__conform_rig *r) {
  ethd__conform_rig_stop(r);
  ethd_device_close(r->device);
}

void ethd__conform_rig_hush(ethd__conform_rig *r, double seconds) {
  const struct timespec pause = {.tv_nsec = IDLE};
  const int64_t end = ethd__clock_now() + (int64_t)(1e9 * seconds);
  stop_units(r);
  while (ethd__clock_now() < end && !ethd__conform_stopped(r->def)) nanosleep(&pause, NULL);
  start_units(r);
  r->now = ethd__clock_now();
}

static void note_joints(ethd__conform_rig *r, const ethd_sense *s) {
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
  if (r->samples && dt > 0 && dt < PAUSED) {
    r->span += dt;
    r->spans++;
  }
  r->ahead += s->time_ns > (r->def->device->is_virtual ? r->now : ethd__clock_now());
  r->samples++;
}

/* Notes a reading of the finger, from any sensor. */
static void note_reading(ethd__conform_rig *r, const ethd_sense *s) {
  if (!(s->have & (ETHD_HAVE_FINGER | ETHD_HAVE_CENTRE | ETHD_HAVE_RAYS))) return;
  r->ahead += s->sample_ns > (r->def->device->is_virtual ? r->now : ethd__clock_now());
  r->backwards += r->readings && s->sample_ns < r->reading_ns;
  r->reading_ns = s->sample_ns;
  r->readings++;
}

/* One period: does the I/O, reads, and writes the torque unless it is NULL. */
static void tick(ethd__conform_rig *r, const double *torque) {
  ethd_sense s = {0};
  ethd_command command = {.safe = torque == NULL};
  if (ethd__conform_stopped(r->def)) {
    ethd_device_safe(r->device);
    return;
  }
  if (torque) memcpy(command.torque, torque, sizeof command.torque);
  ethd__conform_rig_await(r);
  for (uint32_t u = 0, n = ethd_device_units(r->device); u < n && r->def->device->is_virtual; u++)
    (void)!ethd_device_service(r->device, u, r->now);
  ethd_status status = ethd_device_read(r->device, r->now, &s);
  r->failed += status < 0;
  r->faults |= s.faults;
  r->grave |= s.grave;
  note_reading(r, &s);
  if (status == ETHD_OK) {
    note_joints(r, &s);
    r->sense = s;
  }
  if (r->samples) r->age = fmax(r->age, 1e-9 * (double)(r->now - r->sense.time_ns));
  if (torque) r->failed += ethd_device_write(r->device, r->now, &command) < 0;
}

void ethd__conform_rig_run(ethd__conform_rig *r, double seconds, int joint, double torque) {
  const double both[2] = {joint == 0 ? torque : 0, joint == 1 ? torque : 0};
  for (int k = 0, n = (int)ceil(seconds * 1e9 / (double)r->period); k < n; k++) tick(r, both);
}

void ethd__conform_rig_settle(ethd__conform_rig *r) {
  double q[2] = {0, 0};
  int moves = 1;
  for (int k = 0; k < SETTLE && moves; k++) {
    ethd__conform_rig_run(r, LOOK, 0, 0);
    moves = k == 0 || !(fmax(fabs(r->sense.q[0] - q[0]), fabs(r->sense.q[1] - q[1])) <= LOOK * STANDS);
    memcpy(q, r->sense.q, sizeof q);
  }
}

double ethd__conform_rig_least(const ethd__conform_rig *r, double window) {
  return isinf(r->resolution) ? 0 : STEPS * r->resolution / (window * window);
}

double ethd__conform_rig_spacing(const ethd__conform_rig *r) { return r->spans ? r->span / r->spans : 0; }

double ethd__conform_rig_acceleration(ethd__conform_rig *r, int joint, double torque, int write, double window) {
  double q[3], t[3], both[2] = {joint == 0 ? torque : 0, joint == 1 ? torque : 0};
  int64_t begin = r->sense.time_ns;
  int n = (int)ceil(window * 1e9 / (double)r->period);
  for (int k = 0; k < 3; k++) {
    for (int i = 0; k && i < n; i++) tick(r, write ? both : NULL);
    q[k] = r->sense.q[joint];
    t[k] = 1e-9 * (double)(r->sense.time_ns - begin);
  }
  if (!(t[2] > t[1] && t[1] > t[0])) return 0; /* too few samples came to show an acceleration */
  return 2 * ((q[2] - q[1]) / (t[2] - t[1]) - (q[1] - q[0]) / (t[1] - t[0])) / (t[2] - t[0]);
}
