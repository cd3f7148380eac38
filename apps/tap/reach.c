#include "tap/reach.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sim/random.h"
#include "text/error_text.h"
#include "text/text.h"

#define WAIT 2.5      /* s for the arm's motion to the resting finger */
#define AFTER 0.2     /* s from the end of the reach to that of the tap */
#define LATENCY 0.03  /* s from a reading's instant to its arrival */
#define NOISE 1e-3    /* m, sd of a reading, each axis */
#define FAST 1.5      /* m/s: no command is faster */
#define SHARE 0.93    /* of the joints' limits along n that commands may use */
#define LEAST 1.0     /* m/s^2 along n: below, a posture counts as singular */
#define FARTHEST 0.3  /* m before the wall at which drawn reaches begin */
#define TRAVEL 10.0   /* s within which the arm must reach its target place */
#define CLOSE 1e-3    /* m: it has reached the place */
#define HAND_MOST 1.2 /* m/s: fastest drawn reach */

/* ---- what is studied ---- */

/* Moves straight towards `to`; returns the distance from it at which the arm comes to rest. */
static double go_to(ethd__arm_motion *m, ethd_vec3 to) {
  const double periods = TRAVEL * m->table->servo.rate;
  double far = INFINITY;
  for (int i = 0; i < periods && far > CLOSE / 10; i++) {
    const ethd_vec3 left = ethd_vec3_sub(to, m->tool.x);
    far = ethd_vec3_norm(left);
    (void)ethd__arm_motion_step(m, ethd_vec3_scale(fmin(2, 0.3 / far), left), NULL);
  }
  return far;
}

static ethd_status visit(const ethd__reaches *r, const char *name, double before, ethd_ability *able, char *message) {
  ethd__arm_motion m;
  ethd__arm_motion_start(&r->table, NULL, &m);
  const double far = go_to(&m, ethd_vec3_sub(r->at, ethd_vec3_scale(before, r->n)));
  *able = ethd__arm_motion_able(&m, r->n);
  if (!(far <= CLOSE))
    return ethd__say(message, ETHD_E_UNREACHABLE,
                     "%s: from its posture the arm comes no nearer than %.3g m to the place %.3g m before the wall; "
                     "another wall is needed: --wall",
                     name, far, before);
  if (able->acceleration >= LEAST) return ETHD_OK;
  return ethd__say(message, ETHD_E_RANGE,
                   "%s: %.3g m before the wall the posture is singular: along the wall's normal the joints allow %.3g "
                   "m/s2, %.3g are needed; another posture or wall is needed",
                   name, before, able->acceleration, LEAST);
}

ethd_status ethd__reaches_prepare(ethd__reaches *r, const char *name, char message[ETHD_MESSAGE_MAX]) {
  ethd__arm_motion m;
  ethd_ability able;
  r->speed = FAST;
  r->acceleration = INFINITY;
  ethd__arm_motion_start(&r->table, NULL, &m);
  r->at = ethd_vec3_add(m.tool.x, ethd_vec3_scale(r->wall - ethd_vec3_dot(r->n, m.tool.x), r->n));
  for (int i = 0; i < 2; i++) {
    ethd_status status = visit(r, name, i ? fmax(0, FARTHEST - r->gap) : 0, &able, message);
    if (status) return status;
    r->speed = fmin(r->speed, SHARE * able.speed);
    r->acceleration = fmin(r->acceleration, SHARE * able.acceleration);
  }
  return ETHD_OK;
}

/* ---- the hand ---- */

ethd_status ethd__recorded_load(const char *path, const ethd__movement_form *form, ethd__recorded *out,
                                char message[ETHD_MESSAGE_MAX]) {
  char unsaid[ETHD_MESSAGE_MAX];
  ethd__movement_form rise = *form;
  *out = (ethd__recorded){0};
  ethd_status status = ethd__movement_load(path, form, &out->path, message);
  if (status) return status;
  rise.columns[2] = "z_m";
  status = ethd__movement_load(path, &rise, &out->rise, unsaid);
  if (!status || status == ETHD_E_UNKNOWN) return ETHD_OK; /* the column is missing */
  ethd__movement_free(&out->path);
  return ethd__say(message, status, "%s", unsaid);
}

void ethd__recorded_free(ethd__recorded *recorded) {
  ethd__movement_free(&recorded->path);
  ethd__movement_free(&recorded->rise);
}

/* Draws a reach of minimum jerk that has `speed` at the wall; false: that needs a faster hand than HAND_MOST. */
static bool draw(const ethd__reaches *r, double speed, uint64_t k, ethd_path *out) {
  const ethd__sim_key key = {r->seed, k};
  const double before = 0.15 + (FARTHEST - 0.15) * ethd__uniform(key, ETHD__STREAM_START, 0);
  const double beyond = 0.05 + 0.1 * ethd__uniform(key, ETHD__STREAM_OVERSHOOT, 0);
  double low = 0, high = 1; /* the share of the time at which the wall is crossed */
  for (int i = 0; i < 60; i++) {
    const double s = (low + high) / 2;
    if (s * s * s * (10 + s * (6 * s - 15)) < before / (before + beyond))
      low = s;
    else
      high = s;
  }
  const double share = 16 * low * low * (1 - low) * (1 - low); /* of the greatest speed */
  *out = (ethd_path){.from = {before, 0.06 * ethd__uniform(key, ETHD__STREAM_LATERAL, 0) - 0.03},
                     .to_x = -beyond,
                     .speed = fmin(HAND_MOST, speed / share),
                     .profile = ETHD_PROFILE_MINIMUM_JERK};
  return speed / share <= HAND_MOST;
}

static ethd_path path_of(const ethd__movement *m) {
  return (ethd_path){.samples = m->samples, .sample_count = m->count};
}

/* Shifts a movement so that it has slowed to `speed` when the finger meets the wall. */
static bool lay(const ethd__recorded *recorded, double speed, ethd__arm_finger *f) {
  ethd__touchdown at;
  ethd__movement_touchdown(&recorded->path, speed, &at);
  f->path = path_of(&recorded->path);
  f->meet = ethd_vec3_add(f->meet, ethd_vec3_scale(at.x.x, f->n));
  f->meet = ethd_vec3_sub(f->meet, ethd_vec3_scale(at.x.y, f->across));
  if (recorded->rise.count) {
    ethd_vec z, v;
    f->rise = path_of(&recorded->rise);
    ethd_path_at(&f->rise, at.t, &z, &v);
    f->meet = ethd_vec3_sub(f->meet, ethd_vec3_scale(z.y, f->up));
  }
  return !at.never_fast;
}

/* Returns whether the hand reaches this speed. */
static bool put_finger(const ethd__reaches *r, double speed, uint64_t k, ethd__arm_finger *out) {
  const ethd__sim_key key = {r->seed, k};
  *out = ethd__arm_finger_at(ethd_vec3_sub(r->at, ethd_vec3_scale(ETHD_REACH_FINGER, r->n)), r->n);
  out->begin = WAIT + ethd__uniform(key, ETHD__STREAM_PHASE, 0) / r->rate;
  out->rate = r->rate;
  out->latency = LATENCY;
  out->noise = NOISE;
  out->bias = r->bias;
  out->seed = r->seed;
  out->tap = k;
  if (r->recorded_count) return lay(&r->recorded[k % r->recorded_count], speed, out);
  return draw(r, speed, k, &out->path);
}

/* ---- the rig ---- */

static ethd_status set_gains(const ethd__reaches *r, ethd_space_setup *setup, char *message) {
  static const char *const fixed[] = {"space.period", "space.command", "space.effector", "space.radius",
                                      "space.finger_radius"};
  char quote[ETHD_QUOTE_MAX];
  ethd_error error;
  for (size_t i = 0; i < r->gain_count; i++) {
    const ethd__gain *gain = &r->gains[i];
    double value;
    if (!ethd__number(gain->value, strlen(gain->value), &value))
      return ethd__say(message, ETHD_E_SYNTAX, "--set: %s: found %s, a number is allowed", gain->key,
                       ethd__quote(gain->value, strlen(gain->value), quote));
    for (size_t k = 0; k < sizeof fixed / sizeof *fixed; k++)
      if (!strcmp(gain->key, fixed[k]))
        return ethd__say(message, ETHD_E_ARGUMENT, "--set: %s: the arm's table and --gap give it", gain->key);
    const ethd_status status = ethd_space_set(setup, gain->key, value, &error);
    if (!status || status == ETHD_E_UNKNOWN) continue;
    ethd_error_text("--set", &error, message);
    return status;
  }
  return ETHD_OK;
}

ethd_status ethd__reach_open(const ethd__reaches *r, const char *law, ethd__reach_rig *out,
                             char message[ETHD_MESSAGE_MAX]) {
  ethd_error error;
  *out = (ethd__reach_rig){.reaches = r, .setup = ethd_space_setup_default(), .sim.table = r->table};
  ethd_space_setup *s = &out->setup;
  s->effector = ETHD_EFFECTOR_PLATE;
  s->period = r->table.limits.period;
  s->finger_radius = ETHD_REACH_FINGER;
  s->radius = r->gap + ETHD_REACH_FINGER;
  s->speed = r->speed;
  s->acceleration = r->acceleration;
  const ethd_law *const *laws = r->laws ? r->laws : ethd_laws;
  ethd_status status = ethd_space_choose(s, "transition", law, laws, &error);
  if (status == ETHD_E_UNKNOWN)
    return ethd__say(
        message, status,
        "--transition: %.40s: an unknown name; ethd-check --laws lists the library's laws, --plugin FILE.so "
        "adds your own",
        law);
  if (!status && (status = set_gains(r, s, message))) return status;
  if (!status) status = ethd_space_create(s, &out->space, &error);
  if (status) ethd_error_text("--arm", &error, message);
  return status;
}

void ethd__reach_close(ethd__reach_rig *rig) {
  ethd_space_destroy(rig->space);
  rig->space = NULL;
}

/* ---- a tap ---- */

static double now(const ethd__reach_rig *rig) { return 1e-9 * (double)ethd__arm_sim_time_ns(&rig->sim); }

static void step(ethd__reach_rig *rig, ethd_space_trace *trace) {
  const ethd__reaches *r = rig->reaches;
  ethd_space_sense sense = {0};
  ethd_space_command command;
  ethd__arm_sim_read(&rig->sim, &sense);
  const ethd_ability able = ethd__arm_motion_able(&rig->sim.motion, r->n);
  memcpy(sense.ability, &able, sizeof sense.ability);
  ethd_vec3_put(rig->sim.motion.v, sense.commanded);
  sense.have |= ETHD_SPACE_HAVE_ABILITY | ETHD_SPACE_HAVE_COMMANDED;
  const ethd_vec3 x = ethd_vec3_of(sense.x);
  const ethd_vec3 near = ethd_vec3_add(x, ethd_vec3_scale(r->wall - ethd_vec3_dot(r->n, x), r->n));
  const ethd_surface wall = {.point = near, .n = r->n, .id = 1, .material = -1};
  (void)ethd_space_step(rig->space, &sense, &wall, 1, &command, trace); /* a fault is in the trace */
  ethd__arm_sim_write(&rig->sim, &command);
}

static ethd__reach_row look(const ethd__reach_rig *rig, const ethd_space_trace *trace) {
  const ethd__reaches *r = rig->reaches;
  ethd__tool plate;
  ethd_vec3 v, finger, finger_v;
  ethd__arm_sim_true(&rig->sim, &plate, &v);
  ethd__arm_finger_true(&rig->sim.finger, now(rig), &finger, &finger_v);
  return (ethd__reach_row){.t = now(rig),
                           .plate = ethd_vec3_dot(r->n, plate.x) - r->wall,
                           .commanded = ethd_vec3_dot(r->n, rig->sim.motion.tool.x) - r->wall,
                           .finger = ethd_vec3_dot(r->n, finger) + ETHD_REACH_FINGER - r->wall,
                           .v_plate = ethd_vec3_dot(r->n, v),
                           .v_commanded = ethd_vec3_dot(r->n, rig->sim.motion.v),
                           .v_finger = ethd_vec3_dot(r->n, finger_v),
                           .state = trace->state};
}

static bool keep(ethd__reach_rows *rows, const ethd__reach_row *row) {
  if (rows->count == rows->room) {
    const size_t room = rows->room ? 2 * rows->room : 4096;
    ethd__reach_row *more = realloc(rows->row, room * sizeof *more);
    if (!more) return false;
    rows->row = more;
    rows->room = room;
  }
  rows->row[rows->count++] = *row;
  return true;
}

static ethd__reason reason_of(const ethd__reach *tap, bool fast) {
  if (tap->fault) return ETHD_TAP_FAULT;
  if (!fast) return ETHD_TAP_TOO_SLOW;
  if (isnan(tap->felt)) return ETHD_TAP_NO_CONTACT;
  return tap->felt < -ETHD_REACH_EARLY ? ETHD_TAP_EARLY_CONTACT : ETHD_TAP_OK;
}

ethd_status ethd__reach_run(ethd__reach_rig *rig, double speed, uint64_t k, ethd__reach *out, ethd__reach_rows *rows) {
  ethd_space_trace trace;
  *out = (ethd__reach){.felt = NAN, .speed = NAN};
  if (rows) rows->count = 0;
  ethd_space_reset(rig->space);
  const bool fast = put_finger(rig->reaches, speed, k, &rig->sim.finger);
  ethd__arm_sim_start(&rig->sim);
  const double begin = rig->sim.finger.begin, end = begin + ethd_path_end(&rig->sim.finger.path) + AFTER;
  while (now(rig) < end && !out->fault) {
    step(rig, &trace);
    const ethd__reach_row row = look(rig, &trace);
    out->fault = (ethd_fault)trace.fault;
    if (row.t < begin) continue;
    if (isnan(out->felt) && row.finger >= row.plate) {
      out->felt = row.plate;
      out->speed = row.v_plate;
      if (rows) rows->touch = rows->count;
    }
    if (rows && !keep(rows, &row)) return ETHD_E_MEMORY;
  }
  out->reason = reason_of(out, fast);
  return ETHD_OK;
}
