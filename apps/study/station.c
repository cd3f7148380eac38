#include "study/station.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "cli/cli.h"
#include "tap/seen.h"
#include "text/error_text.h"

#define SECONDS 6.0   /* of a tap at most */
#define BEAT 20000000 /* ns */
#define LOOK 1000000  /* ns between two looks at a tap */
#define LEFT 0.004    /* m that the finger must move in a tap, as on the screen */
#define CLEAN 3.0     /* s until an acknowledged device must be at rest */

static void rest(long ns) {
  const struct timespec t = {.tv_nsec = ns};
  nanosleep(&t, NULL);
}

/* ---- rows, on the recorder's thread ---- */

/* An acknowledged device was enabled shortly before the tap enables it again, and if the recorder is late that row
   comes first: the tap begins with the last row of a start. */
static void begin(ethd__station *s, const ethd_loop_row *row) {
  const bool is_first = s->phase == ETHD_PHASE_DUE;
  s->phase = ETHD_PHASE_TAP;
  s->stage.rows.count = 0;
  s->approach = (ethd__approach){0};
  s->last = (size_t)(SECONDS / s->rule.period);
  s->begin_ns = row->trace.sense.time_ns;
  s->touched = false;
  if (is_first) ethd__markers_send(s->desk->markers, "trial-begin", &s->turn, s->begin_ns, "-");
  memcpy(s->stage.heat, row->heat, sizeof row->heat);
}

static void add(ethd__station *s, const ethd_loop_row *row) {
  ethd__tap_rows *rows = &s->stage.rows;
  s->status = row->lost && rows->count ? ETHD_E_FULL : ethd__tap_rows_room(rows);
  if (s->status) {
    s->phase = ETHD_PHASE_OVER;
    return;
  }
  rows->trace[rows->count] = row->trace;
  rows->truth[rows->count] = ethd__seen(&row->trace, &s->stage.setup, s->slack, s->begin_ns);
  if (ethd__approach_step(&s->approach, &s->rule, &rows->trace[rows->count], &rows->truth[rows->count]))
    s->last = rows->count + (size_t)floor(ETHD_TAP_AFTER / s->rule.period + 0.5);
  if (!s->touched && rows->truth[rows->count].pad > 0) {
    s->touched = true;
    ethd__markers_send(s->desk->markers, "contact", &s->turn, row->trace.sense.time_ns, "-");
  }
  if (rows->count++ >= s->last || row->trace.fault) s->phase = ETHD_PHASE_OVER;
}

static void take(void *self, const ethd__row *any) {
  const ethd_loop_row *row = &any->plane;
  ethd__station *s = self;
  pthread_mutex_lock(&s->lock);
  bool waits = s->phase == ETHD_PHASE_DUE || s->phase == ETHD_PHASE_TAP;
  if (waits && row->marks & ETHD_ROW_STARTED) begin(s, row);
  if (s->phase == ETHD_PHASE_TAP) add(s, row);
  pthread_mutex_unlock(&s->lock);
}

static ethd__phase set_phase(ethd__station *s, ethd__phase phase) {
  pthread_mutex_lock(&s->lock);
  ethd__phase was = s->phase;
  s->phase = phase;
  pthread_mutex_unlock(&s->lock);
  return was;
}

static ethd__phase phase_of(ethd__station *s) {
  pthread_mutex_lock(&s->lock);
  ethd__phase phase = s->phase;
  pthread_mutex_unlock(&s->lock);
  return phase;
}

/* ---- the loop ---- */

static ethd_loop_row latest(ethd__station *s) { return ethd__recorder_latest(&s->session.recorder).plane; }

static const char *stopped(void *self) {
  int64_t fault = latest(self).trace.fault;
  return fault ? ethd_fault_sentence((ethd_fault)fault) : NULL;
}

static void pass(ethd__station *s) {
  if (s->session.is_virtual) {
    ethd__session_tick(&s->session);
  } else {
    rest(LOOK);
    ethd__session_poll(&s->session);
  }
}

/* ---- a tap ---- */

/* When this returns, the strategy is active. */
static ethd_status take_strategy(ethd__station *s, const char *law, char *message) {
  ethd__session *session = &s->session;
  ethd__setup_copy setup = session->setup;
  if (!strcmp(setup.plane.transition->law.id, law)) return ETHD_OK;
  ethd_status status = ethd_config_transition(session->config, law, &setup.plane, message);
  return status ? status : ethd__session_post(session, &setup, "transition", law, message);
}

static void make_ready(ethd__station *s, const ethd__taken *taken) {
  s->stage.study = &s->desk->study;
  s->stage.law = taken->stage->law;
  s->turn = taken->turn;
  s->stage.setup = s->session.setup.plane;
  s->rule = ethd__stage_rule(&s->stage, taken->speed, s->stage.setup.finger_radius);
  s->rule.carried = true;
  s->status = ETHD_OK;
}

/* s of the tap; 0 before it has begun. */
static double time_of(ethd__station *s, const ethd_loop_row *row) {
  pthread_mutex_lock(&s->lock);
  double t = s->phase == ETHD_PHASE_TAP ? 1e-9 * (double)(row->trace.sense.time_ns - s->begin_ns) : 0;
  pthread_mutex_unlock(&s->lock);
  return t;
}

static bool tell_watcher(ethd__station *s) {
  ethd_loop_row row = latest(s);
  double t = time_of(s, &row);
  return !s->watcher.look || s->watcher.look(s->watcher.self, t, (ethd_vec){row.trace.xf[0], row.trace.xf[1]});
}

/* Waits until the tap is over; false when it is stopped before. */
static bool follow(ethd__station *s) {
  bool go = true;
  while (go && phase_of(s) != ETHD_PHASE_OVER) {
    pass(s);
    go = !ethd__stop && !ethd_loop_ended(s->session.loop) && tell_watcher(s);
  }
  return set_phase(s, ETHD_PHASE_IDLE) == ETHD_PHASE_OVER;
}

/* A finger that stood at its place until the time was over has made no tap: the person rested, or went away. A fault
   counts in any case. */
static bool was_tap(const ethd__tap_rows *rows) {
  const double *from = NULL;
  for (size_t i = 0; i < rows->count; i++) {
    const double *at = rows->truth[i].finger;
    if (rows->trace[i].fault) return true;
    if (isnan(at[0] + at[1])) continue;
    if (!from) from = at;
    if (hypot(at[0] - from[0], at[1] - from[1]) > LEFT) return true;
  }
  return false;
}

static ethd_status tap(void *self, const ethd__turn *turn, ethd__taken *out, char message[ETHD_MESSAGE_MAX]) {
  ethd__station *s = self;
  ethd_status status = ethd__desk_prepare(s->desk, turn, out, message);
  if (!status) status = take_strategy(s, out->stage->law, message);
  if (status) return status;
  if (stopped(s)) return ETHD_STATUS_EMPTY; /* enabling would clear a fault that nobody has acknowledged */
  make_ready(s, out);
  set_phase(s, ETHD_PHASE_DUE);
  status = ethd__session_enable(&s->session);
  if (status) {
    set_phase(s, ETHD_PHASE_IDLE);
    return ethd__say(message, status, "enabling the device: %s", ethd_status_sentence(status));
  }
  if (!follow(s)) return ETHD_STATUS_EMPTY;
  if (s->status) return ethd__say(message, s->status, "the tap's ticks: %s", ethd_status_sentence(s->status));
  if (!was_tap(&s->stage.rows)) return ETHD_STATUS_EMPTY;
  out->stage = &s->stage;
  out->seed = out->tap = 0;
  out->hand = ETHD_HAND_DEVICE;
  out->movement = NULL;
  const ethd_sim_tap circumstances = {.finger_radius = s->stage.setup.finger_radius, .commanded = out->speed->centre};
  ethd__stage_judge(&s->stage, &s->rule, &circumstances, &out->result);
  return ETHD_OK;
}

/* ---- a device that has stopped itself ---- */

static bool is_clean(const ethd__session *s) {
  double needed;
  const double clean = ethd__session_clean_time(s, &needed);
  return clean >= needed;
}

/* Somebody has acknowledged the fault; if it persists, it stops the device again. */
static ethd_status acknowledge(void *self, char message[ETHD_MESSAGE_MAX]) {
  ethd__station *s = self;
  double until = ethd__session_time(&s->session) + CLEAN;
  while (!is_clean(&s->session) && ethd__session_time(&s->session) < until && !ethd__stop) pass(s);
  if (!ethd__session_acknowledge(&s->session)) return ETHD_OK;
  ethd_status status = ethd__session_enable(&s->session);
  return status ? ethd__say(message, status, "enabling the device: %s", ethd_status_sentence(status)) : ETHD_OK;
}

static ethd_vec finger(void *self) {
  ethd_loop_row row = latest(self);
  return (ethd_vec){row.trace.xf[0], row.trace.xf[1]};
}

static int64_t now(void *self) { return latest(self).trace.sense.time_ns; }

ethd__source ethd__station_source(ethd__station *s) {
  return (ethd__source){.self = s,
                        .hand = ETHD_HAND_DEVICE,
                        .tap = tap,
                        .stopped = stopped,
                        .acknowledge = acknowledge,
                        .finger = finger,
                        .now = now};
}

/* ---- opening, closing ---- */

/* This thread stops the device at once on a signal, even while [main] waits for a person or a disk. */
static void *keep(void *self) {
  ethd__station *s = self;
  while (!atomic_load(&s->end)) {
    if (ethd__stop)
      ethd_loop_raise(s->session.loop, ETHD_FAULT_APPLICATION);
    else
      ethd_loop_beat(s->session.loop);
    rest(BEAT);
  }
  return NULL;
}

ethd_status ethd__station_open(ethd__desk *desk, const char *config, const char *folder, bool is_virtual,
                               ethd__station *out, char message[ETHD_MESSAGE_MAX]) {
  const ethd__session_options options = {
      .config = config, .folder = folder, .sink = {out, take}, .is_virtual = is_virtual, .loop = ethd_loop_default()};
  memset(out, 0, sizeof *out);
  out->desk = desk;
  out->slack = desk->protocol->slack;
  pthread_mutex_init(&out->lock, NULL);
  ethd_status status = ethd__session_open(&options, &out->session, message);
  if (status) return status;
  out->kept = !is_virtual && pthread_create(&out->keeper, NULL, keep, out) == 0;
  if (is_virtual || out->kept) return ETHD_OK;
  char unsaid[ETHD_MESSAGE_MAX];
  (void)!ethd__station_close(out, unsaid);
  return ethd__no_memory(message, NULL);
}

ethd_status ethd__station_close(ethd__station *s, char message[ETHD_MESSAGE_MAX]) {
  ethd__session_halt(&s->session, ethd__stop);
  atomic_store(&s->end, 1);
  if (s->kept) pthread_join(s->keeper, NULL);
  ethd_status status = ethd__session_end(&s->session, message);
  ethd__session_free(&s->session);
  ethd__tap_rows_free(&s->stage.rows);
  pthread_mutex_destroy(&s->lock);
  return status;
}
