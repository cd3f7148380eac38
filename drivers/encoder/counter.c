#include "encoder/counter.h"

#include <math.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "encoder/counter_input.h"
#include "ethd/cell.h"
#include "text/error_text.h"

#define HOME_PAUSE 1000000 /* ns */

typedef struct counter {
  ethd__counter_settings settings;
  ethd__encoder_def def[2];
  char inertia[2][192]; /* remarks about it; empty: there is none */
  double period;
  ethd_cell *cell; /* of snapshots */

  /* I/O thread, and start */
  pthread_mutex_t lock;
  ethd__counter_input input;
  int32_t failed; /* the count can't be read; [rt] reads this too */

  /* [rt], and start */
  ethd__counter_snapshot taken;
  ethd__encoder encoder[2];
  double torque[2]; /* of the last command */
  uint64_t marks[2];
  int32_t lost; /* after a grave jump: the angle is no longer known */

  /* any thread */
  bool clear; /* wrong marks are acknowledged */
  bool safe;  /* since the last start the device has removed its torque */
} counter;

/* ---- I/O ---- */

static ethd_status sample(counter *c, int64_t now_ns) {
  ethd_status status = ethd__counter_sample(&c->input, now_ns);
  __atomic_store_n(&c->failed, status != ETHD_OK, __ATOMIC_RELAXED);
  return status;
}

static ethd_status counter_service(void *device, uint32_t unit, int64_t now_ns) {
  counter *c = device;
  (void)unit;
  pthread_mutex_lock(&c->lock);
  ethd_status status = sample(c, now_ns);
  if (!status) ethd_cell_put(c->cell, &c->input.latest);
  pthread_mutex_unlock(&c->lock);
  c->input.calls->pause((int64_t)(0.5e9 * c->period));
  return status;
}

/* ---- [rt] ---- */

/* Steps one joint's encoder, and puts q, dq and faults into *out. */
static void step(counter *c, int j, ethd_sense *out) {
  const ethd__counter_snapshot *s = &c->taken;
  ethd__count count = {.time_ns = s->time_ns, .edge_ns = s->edge_ns[j], .raw = s->raw[j], .index = s->index[j]};
  if (s->marks[j] != c->marks[j]) count.flags = ETHD__COUNT_INDEX;
  c->marks[j] = s->marks[j];
  double torque = __atomic_load_n(&c->safe, __ATOMIC_RELAXED) ? 0 : c->torque[j];
  out->faults |= ethd__encoder_step(&c->def[j], &c->encoder[j], &count, torque, &out->grave);
  out->q[j] = c->encoder[j].q;
  out->dq[j] = c->encoder[j].dq;
}

/* Makes the next mark the first one again. */
static void forget_marks(counter *c) {
  for (int j = 0; j < 2; j++) {
    c->encoder[j].misindexed = false;
    c->encoder[j].marks = 0;
  }
}

static ethd_status counter_read(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT {
  counter *c = device;
  (void)now_ns;
  if (__atomic_load_n(&c->clear, __ATOMIC_RELAXED)) {
    __atomic_store_n(&c->clear, 0, __ATOMIC_RELAXED);
    forget_marks(c);
  }
  if (__atomic_load_n(&c->failed, __ATOMIC_RELAXED)) return ETHD_E_DEVICE;
  if (ethd_cell_take(c->cell, &c->taken) != ETHD_OK) return ETHD_STATUS_STALE;
  for (int j = 0; j < 2; j++) step(c, j, out);
  out->time_ns = c->taken.time_ns;
  out->have &= ~(int64_t)ETHD_HAVE_AGE; /* of another driver's samples */
  if (c->encoder[0].has_dq && c->encoder[1].has_dq) out->have |= ETHD_HAVE_DQ;
  if (out->grave & ETHD_FAULT_BIT(ETHD_FAULT_ENCODER_JUMP)) c->lost = 1;
  return ETHD_OK;
}

static ethd_status counter_write(void *device, int64_t now_ns, const ethd_command *command) ETHD_RT {
  counter *c = device;
  (void)now_ns;
  for (int j = 0; j < 2; j++) c->torque[j] = command->safe ? 0 : command->torque[j];
  return ETHD_OK;
}

static void counter_safe(void *device) ETHD_RT { __atomic_store_n(&((counter *)device)->safe, true, __ATOMIC_RELAXED); }

/* ---- opening ---- */

static ethd__encoder_def define(const ethd__counter_settings *s, int j, uint64_t ceiling) {
  const double *p = s->p;
  return (ethd__encoder_def){.ceiling = ceiling,
                             .counts_per_turn = (int64_t)p[ETHD__COUNTER_COUNTS_PER_TURN],
                             .ratio = p[ETHD__COUNTER_RATIO],
                             .offset = p[ETHD__COUNTER_OFFSET1 + j],
                             .speed_max = p[ETHD__COUNTER_SPEED_MAX],
                             .freeze_torque = p[ETHD__COUNTER_FREEZE_TORQUE],
                             .freeze_time = p[ETHD__COUNTER_FREEZE_TIME],
                             .reverse_torque = p[ETHD__COUNTER_REVERSE_TORQUE],
                             .reverse_time = p[ETHD__COUNTER_REVERSE_TIME],
                             .inertia = p[ETHD__COUNTER_INERTIA],
                             .sign = p[ETHD__COUNTER_SIGN1 + j] > 0 ? -1 : 1,
                             .home = p[ETHD__COUNTER_HOME] != 0,
                             .stamps = p[ETHD__COUNTER_STAMPS] != 0};
}

static ethd_status define_both(counter *c, const ethd_device_def *def, const uint64_t ceilings[2], char *message) {
  ethd_status status = ETHD_OK;
  for (int j = 0; j < 2 && !status; j++) {
    ethd_error error = {0};
    c->def[j] = define(&c->settings, j, ceilings[j]);
    status = ethd__encoder_check(&c->def[j], c->period, &error);
    if (status) ethd_error_text(def->file, &error, message);
    if (!status) (void)!ethd__encoder_doubt(&c->def[j], def->setup, j, c->inertia[j], sizeof c->inertia[j]);
  }
  return status;
}

static void counter_close(void *device) {
  counter *c = device;
  ethd__counter_input_close(&c->input);
  ethd_cell_destroy(c->cell);
  pthread_mutex_destroy(&c->lock);
  free(c);
}

#define WIDTH 32 /* bits, until the kernel's ceiling is read */

static ethd_status counter_prepare(const ethd_device_def *def, void **out, char message[ETHD_MESSAGE_MAX]) {
  counter *c = *out = calloc(1, sizeof *c);
  if (!c) return ETHD_E_MEMORY;
  c->period = def->setup->period;
  pthread_mutex_init(&c->lock, NULL);
  ethd_status status = ethd_cell_create(sizeof(ethd__counter_snapshot), &c->cell, NULL);
  if (!status) status = ethd__counter_settings_read(def, &c->settings, message);
  uint32_t width = (uint32_t)c->settings.p[ETHD__COUNTER_WIDTH];
  uint64_t ceiling = ethd__count_ceiling(width ? width : WIDTH);
  return status ? status : define_both(c, def, (const uint64_t[2]){ceiling, ceiling}, message);
}

static ethd_status counter_open(const ethd_device_def *def, void **out, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = counter_prepare(def, out, message);
  counter *c = *out;
  if (!status) status = ethd__counter_input_open(&c->settings, &c->input, message);
  if (status) return status;
  return define_both(c, def, (const uint64_t[2]){c->input.counts[0].ceiling, c->input.counts[1].ceiling}, message);
}

/* ---- starting ---- */

static bool is_homed(const counter *c) { return c->encoder[0].homed && c->encoder[1].homed; }

/* Homing by hand: waits until each encoder's index mark has passed. */
static ethd_status home(counter *c) {
  int64_t most = (int64_t)rint(c->settings.p[ETHD__COUNTER_HOME_TIME] * 1e9 / HOME_PAUSE), t = 0;
  for (; !is_homed(c) && t < most; t++) {
    ethd_sense s = {0};
    ethd_status status = sample(c, t * HOME_PAUSE);
    if (status) return status;
    c->taken = c->input.latest;
    for (int j = 0; j < 2; j++) step(c, j, &s);
    if (s.grave) return ETHD_E_DEVICE;
    c->input.calls->pause(HOME_PAUSE);
  }
  for (int j = 0; j < 2; j++) ethd__encoder_pause(&c->encoder[j]);
  return is_homed(c) ? ETHD_OK : ETHD_E_DEVICE;
}

static bool is_misindexed(const counter *c) { return c->encoder[0].misindexed || c->encoder[1].misindexed; }

/* After a grave jump the angles are found again: by homing, or from the present counts. */
static ethd_status counter_start(void *device) {
  counter *c = device;
  ethd_status status = ETHD_OK;
  if (is_misindexed(c)) return ETHD_E_DEVICE;
  pthread_mutex_lock(&c->lock);
  for (int j = 0; j < 2; j++) {
    if (c->lost) ethd__encoder_restart(&c->encoder[j]);
    ethd__encoder_pause(&c->encoder[j]);
    c->torque[j] = 0;
    c->marks[j] = c->input.latest.marks[j];
  }
  c->lost = 0;
  __atomic_store_n(&c->safe, false, __ATOMIC_RELAXED);
  if (c->def[0].home && !is_homed(c)) status = home(c);
  pthread_mutex_unlock(&c->lock);
  return status;
}

/* Assigns these angles to the present counts. */
static ethd_status counter_home(void *device, const double q[2]) {
  counter *c = device;
  if (!q) return ETHD_OK; /* homing by index marks is done by start */
  pthread_mutex_lock(&c->lock);
  for (int j = 0; j < 2; j++) ethd__encoder_place(&c->def[j], &c->encoder[j], q[j]);
  c->lost = 0;
  pthread_mutex_unlock(&c->lock);
  return ETHD_OK;
}

/* ---- for people ---- */

/* The I/O thread goes on counting while these figures are read. */
static double seen(const uint64_t *count) { return (double)__atomic_load_n(count, __ATOMIC_RELAXED); }

static uint32_t counter_units(const void *device) { return (void)device, 1; }

/* An acknowledgement means that a person has inspected the coupling. */
static void counter_clear(void *device) { __atomic_store_n(&((counter *)device)->clear, 1, __ATOMIC_RELAXED); }

static const char *counter_why(const void *device) {
  return is_misindexed(device) ? "an encoder's index marks had a wrong distance: check its coupling, then ack" : "";
}

static const char *counter_remark(const void *device, uint32_t i) {
  const counter *c = device;
  const char *said[6] = {NULL};
  uint32_t n = 0;
  if (is_misindexed(c)) said[n++] = "an encoder's index marks had a wrong distance: check its coupling, then ack";
  if (isinf(c->def[0].freeze_torque)) said[n++] = "counter.freeze_torque is inf: a frozen encoder isn't noticed";
  if (isinf(c->def[0].reverse_torque)) said[n++] = "counter.reverse_torque is inf: a reversed encoder isn't noticed";
  for (int j = 0; j < 2; j++)
    if (c->inertia[j][0]) said[n++] = c->inertia[j];
  return i < n ? said[i] : NULL;
}

static uint32_t counter_figures(const void *device, ethd_figure *out, uint32_t max) {
  const counter *c = device;
  const ethd_figure all[] = {
      {"counter events", "1", seen(&c->input.events)},
      {"counter events with a failure", "1", seen(&c->input.bad_events)},
      {"counter reads that failed", "1", seen(&c->input.failures)},
      {"joint angle a count", "rad", 2 * M_PI / ((double)c->def[0].counts_per_turn * c->def[0].ratio)}};
  uint32_t n = max < 4 ? max : 4;
  memcpy(out, all, n * sizeof *out);
  return n;
}

const ethd_driver ethd_driver_counter = {
    .size = sizeof(ethd_driver),
    .abi = ETHD_DRIVER_ABI,
    .id = "counter",
    .brief = "encoders behind the kernel's counters; never run on hardware",
    .params = ethd__counter_params,
    .param_count = ETHD__COUNTER_PARAMS,
    .keys = ethd__counter_keys,
    .open = counter_open,
    .start = counter_start,
    .read = counter_read,
    .write = counter_write,
    .units = counter_units,
    .service = counter_service,
    .safe = counter_safe,
    .close = counter_close,
    .figures = counter_figures,
    .remark = counter_remark,
    .clear = counter_clear,
    .home = counter_home,
    .why = counter_why,
    .prepare = counter_prepare,
};
