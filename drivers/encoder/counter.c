#include "encoder/counter.h"

#include <errno.h>
#include <linux/counter.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "ethd/cell.h"
#include "file/error_text.h"

#define EVENTS 64        /* in one call */
#define CALLS_MAX 64     /* in one service: the rest waits for the next */
#define HOME_PAUSE 1000000 /* ns */

/* What the I/O thread hands over. */
typedef struct snapshot {
  int64_t time_ns, edge_ns[2];
  uint64_t raw[2], index[2], marks[2]; /* index: count at the last mark; marks: how many so far */
} snapshot;

typedef struct counter {
  ethd__counter_settings settings;
  ethd__encoder_def def[2];
  double period;
  const ethd__counter_calls *calls;
  ethd__kernel_count counts[2];
  ethd_cell *cell;

  /* I/O thread, and start */
  pthread_mutex_t lock;
  snapshot latest;
  uint64_t events, bad_events, failures;
  int32_t failed; /* also [rt]'s: the count can't be read */

  /* [rt], and start */
  snapshot taken;
  ethd__encoder encoder[2];
  double torque[2]; /* of the last command */
  uint64_t marks[2];
  int32_t lost;     /* a jump was grave: the angle isn't known any more */
} counter;

/* ---- I/O ---- */

static int joint_of(const counter *c, int device, const struct counter_event *e) {
  for (int j = 0; j < 2; j++)
    if (c->counts[j].device == device && e->watch.component.parent == c->settings.count[j]) return j;
  return -1;
}

/* Figures are read while they rise. */
static void raise_by_one(uint64_t *count) { __atomic_store_n(count, *count + 1, __ATOMIC_RELAXED); }
static double seen(const uint64_t *count) { return (double)__atomic_load_n(count, __ATOMIC_RELAXED); }

static void take_event(counter *c, int device, const struct counter_event *e) {
  int j = joint_of(c, device, e);
  raise_by_one(&c->events);
  if (j < 0 || e->status) {
    raise_by_one(&c->bad_events);
  } else if (e->watch.event == COUNTER_EVENT_INDEX) {
    c->latest.index[j] = e->value;
    c->latest.marks[j]++;
  } else if (e->watch.event == COUNTER_EVENT_CHANGE_OF_STATE) {
    c->latest.edge_ns[j] = (int64_t)e->timestamp;
    c->latest.raw[j] = e->value;
  }
}

/* All that wait. -1: the device is gone. */
static int take_events(counter *c, int j) {
  struct counter_event events[EVENTS];
  if (c->counts[j].shared) return 0;
  for (int call = 0; call < CALLS_MAX; call++) {
    ssize_t n = c->calls->read(c->counts[j].device, events, sizeof events);
    if (n < 0 && errno != EAGAIN && errno != EINTR && errno != ENODATA) return -1;
    if (n <= 0) return 0;
    for (size_t i = 0; i < (size_t)n / sizeof *events; i++) take_event(c, c->counts[j].device, &events[i]);
    if ((size_t)n < sizeof events) return 0;
  }
  return 0;
}

/* A count whose edges are known has its value from the last of them: both belong together. */
static int take_count(counter *c, int j) {
  uint64_t raw;
  if (c->def[j].stamps && c->latest.edge_ns[j]) return 0;
  if (ethd__kernel_count_read(c->calls, &c->counts[j], &raw)) return -1;
  c->latest.raw[j] = raw;
  return 0;
}

static ethd_status sample(counter *c, int64_t now_ns) {
  int bad = 0;
  c->latest.time_ns = now_ns;
  for (int j = 0; j < 2; j++) bad |= take_events(c, j) | take_count(c, j);
  __atomic_store_n(&c->failed, bad, __ATOMIC_RELAXED);
  if (!bad) return ETHD_OK;
  raise_by_one(&c->failures);
  return ETHD_E_DEVICE;
}

static ethd_status counter_service(void *device, uint32_t unit, int64_t now_ns) {
  counter *c = device;
  (void)unit;
  pthread_mutex_lock(&c->lock);
  ethd_status status = sample(c, now_ns);
  if (!status) ethd_cell_put(c->cell, &c->latest);
  pthread_mutex_unlock(&c->lock);
  c->calls->pause((int64_t)(0.5e9 * c->period));
  return status;
}

/* ---- [rt] ---- */

/* The row of one joint's sample; q, dq and faults into *out. */
static void step(counter *c, int j, ethd_sense *out) ETHD_RT {
  const snapshot *s = &c->taken;
  ethd__count count = {.time_ns = s->time_ns, .edge_ns = s->edge_ns[j], .raw = s->raw[j], .index = s->index[j]};
  if (s->marks[j] != c->marks[j]) count.flags = ETHD__COUNT_INDEX;
  c->marks[j] = s->marks[j];
  out->faults |= ethd__encoder_step(&c->def[j], &c->encoder[j], &count, c->torque[j], &out->grave);
  out->q[j] = c->encoder[j].q;
  out->dq[j] = c->encoder[j].dq;
}

static ethd_status counter_read(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT {
  counter *c = device;
  (void)now_ns;
  if (__atomic_load_n(&c->failed, __ATOMIC_RELAXED)) return ETHD_E_DEVICE;
  if (ethd_cell_take(c->cell, &c->taken) != ETHD_OK) return ETHD_STALE;
  for (int j = 0; j < 2; j++) step(c, j, out);
  out->time_ns = c->taken.time_ns;
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

static void counter_safe(void *device) ETHD_RT {
  counter *c = device;
  c->torque[0] = c->torque[1] = 0;
}

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
                             .sign = (int32_t)p[ETHD__COUNTER_SIGN1 + j],
                             .home = p[ETHD__COUNTER_HOME] != 0,
                             .stamps = p[ETHD__COUNTER_STAMPS] != 0};
}

static ethd_status open_counts(counter *c, const char *file, char *message) {
  ethd_status status = ETHD_OK;
  for (int j = 0; j < 2 && !status; j++) {
    status = ethd__kernel_count_open(c->calls, &c->settings, j, j ? &c->counts[0] : NULL, &c->counts[j], message);
    if (status) return status;
    c->def[j] = define(&c->settings, j, c->counts[j].ceiling);
    ethd_error error = {0};
    status = ethd__encoder_check(&c->def[j], c->period, &error);
    if (status) ethd_error_text(file, &error, message);
  }
  for (int j = 0; j < 2 && !status; j++)
    status = ethd__kernel_count_watch(c->calls, &c->settings, j, c->counts, message);
  return status;
}

static void counter_close(void *device) {
  counter *c = device;
  if (!c) return;
  for (int j = 2; j--;) ethd__kernel_count_close(c->calls, &c->counts[j]);
  ethd_cell_destroy(c->cell);
  pthread_mutex_destroy(&c->lock);
  free(c);
}

static counter *make(void) {
  counter *c = calloc(1, sizeof *c);
  if (!c) return NULL;
  c->calls = ethd__counter_calls_now;
  for (int j = 0; j < 2; j++) c->counts[j] = (ethd__kernel_count){.device = -1, .count = -1};
  pthread_mutex_init(&c->lock, NULL);
  if (ethd_cell_create(sizeof(snapshot), &c->cell, NULL) == ETHD_OK) return c;
  counter_close(c);
  return NULL;
}

static ethd_status counter_open(const ethd_device_def *def, void **out, char message[ETHD_MESSAGE_MAX]) {
  counter *c = make();
  *out = NULL;
  if (!c) return ethd__say(message, ETHD_E_MEMORY, "counter: %s", ethd_status_sentence(ETHD_E_MEMORY));
  c->period = def->setup->period;
  ethd_status status = ethd__counter_settings_read(def, &c->settings, message);
  if (!status) status = open_counts(c, def->file, message);
  if (status)
    counter_close(c);
  else
    *out = c;
  return status;
}

/* ---- starting ---- */

static int is_homed(const counter *c) { return c->encoder[0].homed && c->encoder[1].homed; }

/* By hand: until each encoder's index mark has passed. */
static ethd_status home(counter *c) {
  int64_t most = (int64_t)rint(c->settings.p[ETHD__COUNTER_HOME_TIME] * 1e9 / HOME_PAUSE), t = 0;
  for (; !is_homed(c) && t < most; t++) {
    ethd_sense s = {0};
    ethd_status status = sample(c, t * HOME_PAUSE);
    if (status) return status;
    c->taken = c->latest;
    for (int j = 0; j < 2; j++) step(c, j, &s);
    if (s.grave) return ETHD_E_DEVICE;
    c->calls->pause(HOME_PAUSE);
  }
  for (int j = 0; j < 2; j++) ethd__encoder_pause(&c->encoder[j]);
  return is_homed(c) ? ETHD_OK : ETHD_E_DEVICE;
}

static int is_misindexed(const counter *c) { return c->encoder[0].misindexed || c->encoder[1].misindexed; }

/* After a grave jump the angles are found anew: by homing, or from the counts as they are. */
static ethd_status counter_start(void *device) {
  counter *c = device;
  ethd_status status = ETHD_OK;
  if (is_misindexed(c)) return ETHD_E_DEVICE;
  pthread_mutex_lock(&c->lock);
  for (int j = 0; j < 2; j++) {
    if (c->lost) ethd__encoder_restart(&c->encoder[j]);
    ethd__encoder_pause(&c->encoder[j]);
    c->torque[j] = 0;
    c->marks[j] = c->latest.marks[j];
  }
  c->lost = 0;
  if (c->def[0].home && !is_homed(c)) status = home(c);
  pthread_mutex_unlock(&c->lock);
  return status;
}

static ethd_status counter_stop(void *device) { return counter_safe(device), ETHD_OK; }

/* ---- for people ---- */

static uint32_t counter_units(const void *device) { return (void)device, 1; }
static ethd_limits counter_limits(const void *device) { return (void)device, ethd_limits_none(); }

static const char *counter_remark(const void *device, uint32_t i) {
  const counter *c = device;
  const char *said[4] = {NULL};
  uint32_t n = 0;
  if (is_misindexed(c)) said[n++] = "an encoder's index marks had a wrong distance: check its coupling, then open it anew";
  if (isinf(c->def[0].freeze_torque)) said[n++] = "counter.freeze_torque is inf: a frozen encoder isn't noticed";
  if (isinf(c->def[0].reverse_torque)) said[n++] = "counter.reverse_torque is inf: a reversed encoder isn't noticed";
  return i < n ? said[i] : NULL;
}

static uint32_t counter_figures(const void *device, ethd_figure *out, uint32_t max) {
  const counter *c = device;
  const ethd_figure all[] = {{"counter events", "1", seen(&c->events)},
                             {"counter events with a failure", "1", seen(&c->bad_events)},
                             {"counter reads that failed", "1", seen(&c->failures)}};
  uint32_t n = max < 3 ? max : 3;
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
    .open = counter_open,
    .start = counter_start,
    .read = counter_read,
    .write = counter_write,
    .units = counter_units,
    .service = counter_service,
    .safe = counter_safe,
    .stop = counter_stop,
    .close = counter_close,
    .limits = counter_limits,
    .figures = counter_figures,
    .remark = counter_remark,
};
