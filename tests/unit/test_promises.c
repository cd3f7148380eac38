/* What control.h and guard.h promise of the torque, held against random posts, faults, acknowledgements, limits, lost
   samples and late ticks by a judge that knows nothing of the controller but its inputs and outputs.
   ETHD_PROMISES: how many ticks; make stress asks for 1e8. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unit/rig.h"

#define PERIOD 1e-3
#define NOT_KNOWN 1e6 /* Nm */

static uint64_t seed;

static double uniform(void) {
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return (double)(seed >> 11) * 0x1p-53;
}

static bool chance(double p) { return uniform() < p; }
static double from_to(double a, double b) { return a + (b - a) * uniform(); }

/* ---- random setups ---- */

static ethd_scene *scenes[3];

static ethd_setup random_setup(void) {
  static const ethd_transition_law *const transitions[] = {&ethd_transition_abrupt, &ethd_transition_smooth,
                                                           &ethd_transition_offset, &ethd_transition_predictive};
  static const ethd_contact_law *const contacts[] = {&ethd_contact_kelvin_voigt, &ethd_contact_spring,
                                                     &ethd_contact_hunt_crossley};
  ethd_setup s = ethd_setup_default();
  ethd_limits *l = &s.limits;
  ethd_setup_transition(&s, transitions[(int)(4 * uniform())]);
  ethd_setup_contact(&s, contacts[(int)(3 * uniform())]);
  if (chance(0.8)) s.scene = scenes[(int)(3 * uniform())];
  s.swap_time = chance(0.1) ? 0 : from_to(0.001, 0.05);
  if (chance(0.7)) s.dynamics = (ethd_dynamics){{from_to(0.05, 0.5), from_to(0.05, 0.5)}, 0.1, 0.5, from_to(0, 0.005)};
  if (chance(0.8)) l->torque = chance(0.05) ? 0 : from_to(0.2, 3);
  if (chance(0.3)) l->torque_rate = from_to(1, 500);
  if (chance(0.3)) l->speed = from_to(0.3, 2);
  if (chance(0.3)) l->workspace[0] = from_to(0.1, 0.24), l->workspace[1] = from_to(0.26, 0.4);
  if (chance(0.3)) l->margin = from_to(0, 0.03);
  if (chance(0.3)) l->nominal_torque = from_to(0.05, 0.5), l->heat_time = from_to(0.01, 1);
  if (chance(0.3)) l->energy = from_to(1e-4, 1e-2);
  if (chance(0.3)) l->clean_time = from_to(0, 0.05);
  if (chance(0.3)) l->gap = from_to(0.003, 0.02);
  if (chance(0.3)) l->finger_age = from_to(0.005, 0.02), l->finger_lost = from_to(0.02, 0.05);
  l->stop_time = 3;
  return s;
}

/* ---- random senses ---- */

typedef struct world {
  ethd_vec x, v, finger;
  int64_t time_ns;
} world;

static void walk(world *w) {
  for (double *v = &w->v.x; v <= &w->v.y; v++) *v = 0.98 * *v + from_to(-0.05, 0.05);
  if (chance(0.001)) w->v = (ethd_vec){from_to(-2, 2), from_to(-2, 2)};
  w->x = ethd_vec_add(w->x, ethd_vec_scale(PERIOD, w->v));
  w->x.x = fmin(fmax(w->x.x, 0.15), 0.35);
  w->x.y = fmin(fmax(w->x.y, 0.15), 0.35);
  w->finger = (ethd_vec){w->x.x + from_to(-0.004, 0.004), w->x.y + from_to(-0.004, 0.004)};
}

static ethd_sense random_sense(world *w, const ethd_arm *arm) {
  ethd_sense s = {0};
  walk(w);
  s.missed = chance(0.02) ? (int64_t)(5 * uniform()) : 0;
  w->time_ns += (s.missed + 1) * 1000000;
  s.time_ns = s.sample_ns = w->time_ns;
  ck_assert_int_eq(ethd_arm_angles(arm, w->x, -1, s.q), ETHD_OK);
  if (chance(0.7)) {
    ethd_pose pose;
    ethd_arm_pose(arm, s.q, &pose);
    ethd_pose_joints(&pose, w->v, s.dq);
    s.have |= ETHD_HAVE_DQ;
  }
  if (chance(0.5)) {
    s.have |= ETHD_HAVE_FINGER;
    ethd_vec_put(w->finger, s.finger);
    ethd_vec_put(w->v, s.finger_v);
  } else if (chance(0.5)) {
    s.have |= ETHD_HAVE_CENTRE;
    ethd_vec_put(ethd_vec_sub(w->finger, w->x), s.centre);
  }
  if (chance(0.001)) s.q[(int)(2 * uniform())] = chance(0.5) ? NAN : 1e300;
  if (chance(0.002)) s.faults = ETHD_FAULT_BIT(1 + (int)((ETHD_FAULT_COUNT - 1) * uniform()));
  if (chance(0.001)) s.grave = ETHD_FAULT_BIT(1 + (int)((ETHD_FAULT_COUNT - 1) * uniform()));
  return s;
}

/* ---- the judge ---- */

typedef struct judge {
  ethd_setup rules;     /* the setup that rules */
  double last[2];       /* Nm, commanded at the last tick */
  double old[2], since; /* size of the torque at the last swap; s since then, INFINITY: none that still fades */
  double delta[2];      /* Nm: that torque less what the new setup gives */
  double soft;          /* s since an acknowledgement; INFINITY: long ago */
  double heat[2];
  double blind;  /* s since the last tick that had a measurement */
  int64_t stops; /* ticks of a stop so far */
  bool faulty, let_go;
  uint64_t swaps, cleared, stopped; /* how often each was seen */
} judge;

static double left_of(double since, double swap_time) {
  return since < swap_time * (1 - 1e-9) ? 1 - since / swap_time : 0;
}

static bool is_measured(const ethd_sense *s) { return fabs(s->q[0]) < 1e7 && fabs(s->q[1]) < 1e7; }

/* limits.torque, and what a hot motor may have by the model that guard.h names */
static double most_of(const judge *j, int i) {
  const ethd_limits *l = &j->rules.limits;
  double most = l->torque;
  if (isfinite(l->nominal_torque) && j->heat[i] > 0.9) most = fmin(most, l->nominal_torque * 0.1 / (j->heat[i] - 0.9));
  return most;
}

static void heat(judge *j, double dt) {
  const ethd_limits *l = &j->rules.limits;
  if (!isfinite(l->nominal_torque)) return;
  for (int i = 0; i < 2; i++) {
    double load = fabs(j->last[i]) / l->nominal_torque;
    j->heat[i] += (1 - exp(-dt / l->heat_time)) * (fmin(load, 1e3) * fmin(load, 1e3) - j->heat[i]);
  }
}

static void judge_limits(const judge *j, const ethd_command *c, const ethd_trace *t, double left, double dt) {
  const double small = 1e-9;
  for (int i = 0; i < 2; i++) {
    double most = most_of(j, i), allowed = j->old[i] > most ? most + left * (j->old[i] - most) : most;
    ck_assert_msg(isfinite(c->torque[i]) && fabs(c->torque[i]) <= allowed * (1 + small) + small,
                  "tick %ld: %g Nm, %g allowed, %g left", (long)t->tick, c->torque[i], allowed, left);
    ck_assert_double_eq(c->torque[i], t->tau[i]);
    if (t->fault || !isfinite(j->rules.limits.torque_rate) || (left > 0 && j->old[i] == NOT_KNOWN)) continue;
    double change = fabs(c->torque[i] - j->last[i]), rise = j->rules.limits.torque_rate * dt;
    ck_assert_msg(change <= rise * (1 + small) + small || fabs(c->torque[i]) >= allowed * (1 - small) ||
                      t->guard & (ETHD_GUARD_FINITE | ETHD_GUARD_SPEED | ETHD_GUARD_WORKSPACE),
                  "tick %ld: %g Nm more, %g allowed", (long)t->tick, change, rise);
  }
}

/* A fault rules: zero torque, or a stop's, which never pushes, and ends for good. */
static void judge_fault(judge *j, const ethd_command *c, const ethd_trace *t) {
  const double power = c->torque[0] * t->qd[0] + c->torque[1] * t->qd[1];
  const bool zero = c->torque[0] == 0 && c->torque[1] == 0;
  /* a torque that was steep for too long is stopped from the next tick on */
  if (t->guard & ETHD_GUARD_STEEP) return;
  ck_assert_msg(power <= 1e-12, "tick %ld: a stop gives %g W", (long)t->tick, power);
  ck_assert_msg(!j->let_go || zero, "tick %ld: torque after the ring was let go", (long)t->tick);
  ck_assert_msg(ethd_fault_reaction((ethd_fault)t->fault, 0) != ETHD_REACTION_ZERO || zero,
                "tick %ld: torque under a fault that takes it away", (long)t->tick);
  ck_assert(!c->safe || zero);
  j->let_go = j->let_go || c->safe;
  j->stops++;
  ck_assert_msg(j->let_go || (double)j->stops * PERIOD <= 3, "tick %ld: a stop without an end", (long)t->tick);
}

/* The laws rule: what they ask for, within the limits, under the fades of limit.c's promise. Only where no wall of the
   margin and no rate takes part, which the trace doesn't show. */
static void judge_fades(judge *j, const ethd_command *c, const ethd_trace *t, bool swapped, double left) {
  const ethd_limits *l = &j->rules.limits;
  const double soft = j->soft == 0 ? 0 : 1 - left_of(j->soft, j->rules.swap_time);
  if (soft == 1) j->soft = INFINITY; /* a longer swap_time doesn't bring it back */
  for (int i = 0; i < 2; i++) {
    double g = fmin(fmax(t->tau_raw[i], -most_of(j, i)), most_of(j, i));
    if (swapped) j->delta[i] = c->torque[i] - soft * g;
    if (l->margin > 0 || isfinite(l->torque_rate) || (left > 0 && j->old[i] == NOT_KNOWN)) continue;
    double most = most_of(j, i), allowed = j->old[i] > most ? most + left * (j->old[i] - most) : most;
    double is = fmin(fmax(soft * g + left * j->delta[i], -allowed), allowed);
    ck_assert_msg(fabs(c->torque[i] - is) <= 1e-9 * (1 + fabs(is)),
                  "tick %ld: %g Nm, expected %g; %g raw, soft %g, left %g of %g, limit %g", (long)t->tick, c->torque[i],
                  is, t->tau_raw[i], soft, left, j->delta[i], allowed);
  }
}

/* One tick. would: what the setup before would have commanded; NULL: a fault would have ruled. */
static void judge_tick(judge *j, const ethd_sense *s, ethd_status status, const ethd_command *c, const ethd_trace *t,
                       const ethd_command *would, const ethd_setup *posted, bool cleared) {
  const double periods = (double)(1 + s->missed) * PERIOD, dt = j->blind + periods;
  heat(j, periods);
  if (t->swap) j->rules = *posted;
  j->blind = is_measured(s) ? 0 : dt;
  ck_assert_int_eq(status < 0, t->fault != 0);
  ck_assert_int_eq(!is_measured(s), t->fault && c->safe && !is_measured(s));
  if (cleared) { /* the torque rises from zero, also where a stop still braked */
    j->soft = 0, j->since = INFINITY, j->stops = 0, j->let_go = j->faulty = false, j->cleared++;
    memset(j->last, 0, sizeof j->last);
  } else if (is_measured(s)) {
    j->soft += dt;
  }
  const bool swapped = t->swap && !t->fault && !cleared;
  if (swapped) {
    j->since = 0;
    j->swaps++;
    for (int i = 0; i < 2; i++) {
      j->old[i] = would ? fabs(would->torque[i]) : NOT_KNOWN;
      ck_assert_msg(!would || c->torque[i] == would->torque[i] || isfinite(j->rules.limits.torque_rate),
                    "tick %ld: a swap jumps by %g Nm", (long)t->tick, c->torque[i] - would->torque[i]);
    }
  } else if (is_measured(s)) {
    j->since += dt;
  }
  const double left = left_of(j->since, j->rules.swap_time);
  if (t->fault) {
    if (!j->faulty) j->stopped++;
    j->faulty = true;
    j->since = j->soft = INFINITY;
    judge_limits(j, c, t, 0, dt);
    judge_fault(j, c, t);
  } else {
    ck_assert_msg(!j->faulty, "tick %ld: a fault went without an acknowledgement", (long)t->tick);
    judge_limits(j, c, t, swapped ? 1 : left, dt);
    judge_fades(j, c, t, swapped, swapped ? 1 : left);
  }
  memcpy(j->last, c->torque, sizeof j->last);
}

/* ---- the run ---- */

static uint64_t events_of(ethd_control *control, int kind) {
  ethd_event e;
  uint64_t n = 0;
  while (ethd_control_poll(control, &e) == ETHD_OK) n += (int)e.kind == kind;
  return n;
}

/* A run of some thousand ticks from one seed. A rehearsal of the tick under the setup that still rules says what that
   would have commanded. */
static void run(uint64_t number, int ticks, judge *sum) {
  ethd_control *control;
  world w = {.x = {0.255, 0.25}};
  judge j = {.since = INFINITY, .soft = INFINITY};
  seed = number;
  j.rules = random_setup();
  ck_assert_int_eq(ethd_control_create(&j.rules, &control, NULL), ETHD_OK);
  for (int i = 0; i < ticks; i++) {
    const bool posts = chance(0.01);
    const ethd_setup posted = posts ? random_setup() : j.rules;
    ethd_command command, would;
    ethd_trace trace;
    const ethd_sense s = random_sense(&w, &j.rules.arm);
    const bool held = ethd_control_rehearse(control, &s, &would) == ETHD_OK;
    if (posts) ck_assert_int_eq(ethd_control_post(control, &posted, NULL), ETHD_OK);
    if (chance(j.faulty ? 0.05 : 0.001)) ethd_control_acknowledge(control);
    const ethd_status status = ethd_control_step(control, &s, &command, &trace);
    const bool cleared = events_of(control, ETHD_EVENT_CLEARED) > 0;
    judge_tick(&j, &s, status, &command, &trace, held ? &would : NULL, &posted, cleared);
  }
  sum->swaps += j.swaps, sum->cleared += j.cleared, sum->stopped += j.stopped;
  ethd_control_destroy(control);
}

TEST(test_promises) {
  const char *asked = getenv("ETHD_PROMISES");
  const uint64_t ticks = asked ? (uint64_t)strtod(asked, NULL) : 3000000;
  judge sum = {0};
  for (int i = 0; i < 3; i++)
    scenes[i] = rig_scene((const char *const[]){RIG_WALL, "circle 0.25 0.30 0.03\n", "segment 0.2 0.2 0.3 0.22\n"}[i]);
  for (uint64_t done = 0, number = 1; done < ticks; done += 3000) run(number++, 3000, &sum);
  printf("%lu ticks: %lu swaps, %lu faults, %lu acknowledgements\n", (unsigned long)ticks, (unsigned long)sum.swaps,
         (unsigned long)sum.stopped, (unsigned long)sum.cleared);
  ck_assert_uint_gt(sum.swaps, 0);
  ck_assert_uint_gt(sum.cleared, 0);
  for (int i = 0; i < 3; i++) ethd_scene_destroy(scenes[i]);
}
