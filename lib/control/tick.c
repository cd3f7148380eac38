#include <string.h>

#include "control/places.h"

#define GAP_MAX 1000000 /* periods: a longer gap is no longer a gap of a loop */

/* Periods since the last step. */
static int64_t periods(const ethd_sense *sense) ETHD_RT {
  int64_t missed = sense->missed > 0 ? sense->missed : 0;
  return missed < GAP_MAX ? missed + 1 : GAP_MAX;
}

/* ---- what forbids a tick ---- */

/* v - v is 0, or NaN for what isn't finite. */
static int two_finite(const double v[2]) ETHD_RT { return (v[0] - v[0]) + (v[1] - v[1]) == 0; }

static int pose_is_good(const double pose[6]) ETHD_RT {
  return two_finite(pose) && two_finite(pose + 2) && two_finite(pose + 4);
}

static int input_is_good(const ethd_sense *s, ethd__failure *f) ETHD_RT {
  f->fault = ETHD_FAULT_INPUT;
  f->value = 0;
  if (!two_finite(s->q)) return 0;
  f->value = ETHD_HAVE_DQ;
  if ((s->have & ETHD_HAVE_DQ) && !two_finite(s->dq)) return 0;
  f->value = ETHD_HAVE_FINGER;
  if ((s->have & (ETHD_HAVE_FINGER | ETHD_HAVE_START)) && !two_finite(s->finger)) return 0;
  if ((s->have & ETHD_HAVE_FINGER) && !two_finite(s->finger_v)) return 0;
  f->value = ETHD_HAVE_RING;
  if ((s->have & ETHD_HAVE_RING) && !two_finite(s->ring)) return 0;
  f->value = ETHD_HAVE_BODY;
  for (int i = 0; i < ETHD_BODIES_MAX && (s->have & ETHD__HAVE_BODIES); i++)
    if ((s->have & ((int64_t)ETHD_HAVE_BODY << i)) && !pose_is_good(s->bodies + 6 * i)) return 0;
  f->fault = ETHD_FAULT_NONE;
  return 1;
}

/* No two steps further apart than the limit, on either clock. A bus's first sample may be from before the loop
   ran: by how much it's older says nothing of the clock. */
static int clock_is_good(const ethd__plan *plan, const ethd__state *state, const ethd_sense *s, int64_t n) ETHD_RT {
  const double most = plan->setup.limits.gap, way = (double)n * plan->setup.period;
  if (isinf(most)) return 1;
  double passed = 1e-9 * (double)(int64_t)((uint64_t)s->time_ns - (uint64_t)state->time_ns);
  return way <= most && (state->counters.ticks < 2 || fabs(passed - way) <= most);
}

static int joints_are_good(const double joints[4], const double q[2]) ETHD_RT {
  return q[0] >= joints[0] && q[0] <= joints[1] && q[1] >= joints[2] && q[1] <= joints[3];
}

static int reach_is_good(const double reach[2], ethd_vec x) ETHD_RT {
  double r = ethd_vec_norm(x);
  return r >= reach[0] && r <= reach[1];
}

#define HOT 1.05 /* of what a motor stands for ever */

/* Limits that most setups don't have. */
static void look_further(const ethd__plan *plan, ethd__state *state, const ethd_sense *s, int64_t n) ETHD_RT {
  const ethd_limits *limits = &plan->setup.limits;
  ethd__rows *met = &state->met;
  if (!clock_is_good(plan, state, s, n)) met->grave |= ETHD_FAULT_BIT(ETHD_FAULT_CLOCK);
  if (!joints_are_good(limits->joints, s->q)) met->grave |= ETHD_FAULT_BIT(ETHD_FAULT_WORKSPACE);
  if (limits->nominal_torque < (double)INFINITY &&
      !(ethd_guard_heat(limits, &state->guard, (double)n * plan->setup.period) <= HOT))
    met->grave |= ETHD_FAULT_BIT(ETHD_FAULT_HEAT);
  state->time_ns = s->time_ns;
}

static int within_budget(const ethd__plan *plan, const ethd_sense *s, ethd__failure *f) ETHD_RT {
  if (1e-9 * (double)s->step_ns <= plan->setup.limits.step_time) return 1;
  *f = (ethd__failure){ETHD_FAULT_BUDGET, (double)s->step_ns};
  return 0;
}

/* ---- one tick ---- */

/* What is left of a swap's difference after `t` s. */
static double fade_share(double t, double swap_time) ETHD_RT { return t < swap_time ? 1 - t / swap_time : 0; }

static void fade(const ethd__plan *plan, ethd__state *state, double dt, double tau[2]) ETHD_RT {
  if (isinf(state->fade.elapsed)) return;
  state->fade.elapsed += dt;
  double share = fade_share(state->fade.elapsed, plan->setup.swap_time);
  /* periods add up to swap_time only within rounding */
  if (share < 1e-9) {
    state->fade.elapsed = (double)INFINITY;
    return;
  }
  tau[0] += share * state->fade.delta[0];
  tau[1] += share * state->fade.delta[1];
  state->guard.steep = 0; /* the fade's slope is no law's */
}

static void blank(const ethd_sense *sense, ethd_trace *out) ETHD_RT {
  const size_t own = offsetof(ethd_trace, tick);
  out->sense = *sense;
  memset((char *)out + own, 0, sizeof *out - own);
  out->object = -1;
  out->beta = 1;
  out->rf = out->d_re = out->d_fe = out->v_n = (double)NAN;
}

/* The laws' torque with what is left of a fade, into out->tau_raw. */
static int compute(const ethd__plan *plan, ethd__state *state, const ethd_sense *sense, double dt, ethd_pose *pose,
                   ethd_trace *out, ethd__failure *failure) ETHD_RT {
  if (!ethd__evaluate(plan, state, sense, dt, pose, out, failure)) return 0;
  fade(plan, state, dt, out->tau_raw);
  return 1;
}

/* The guard comes last. A fault takes the torque away at once, not at the rate's pace. */
static void guard(const ethd__plan *plan, ethd__state *state, const ethd_pose *pose, double dt, ethd_trace *out,
                  ethd__failure *failure) ETHD_RT {
  ethd_vec v = {out->v[0], out->v[1]};
  if (failure->fault != ETHD_FAULT_NONE) state->met.faults |= ETHD_FAULT_BIT(failure->fault);
  if (failure->fault != ETHD_FAULT_NONE || state->fault) {
    memset(out->tau_raw, 0, sizeof out->tau_raw);
    memset(state->guard.last, 0, sizeof state->guard.last);
  }
  if (failure->fault == ETHD_FAULT_INPUT) return; /* nothing is known of the ring */
  if (plan->looks_further && !reach_is_good(plan->setup.limits.reach, pose->x))
    state->met.grave |= ETHD_FAULT_BIT(ETHD_FAULT_WORKSPACE);
  if (ethd__rows_any(&state->met)) ethd__rows_stop(&state->met, &state->guard);
  memcpy(out->tau, out->tau_raw, sizeof out->tau);
  out->guard = ethd_guard_step(&plan->setup.limits, &state->guard, pose, v, dt, out->tau);
  if (failure->fault == ETHD_FAULT_NONE && out->guard & ETHD_GUARD_SPEED)
    *failure = (ethd__failure){ETHD_FAULT_SPEED, ethd_vec_norm(v)};
}

/* ---- swap ---- */

static void start_fade(ethd__state *state, const double from[2], const double to[2]) ETHD_RT {
  for (int i = 0; i < 2; i++) state->fade.delta[i] = from[i] - to[i];
  state->fade.elapsed = 0;
}

static void migrate_estimators(const ethd__plan *from, const ethd__plan *to, ethd__state *state) ETHD_RT {
  if (memcmp(from->velocity.p, to->velocity.p, sizeof from->velocity.p) != 0 ||
      from->velocity.method != to->velocity.method)
    for (int i = 0; i < 2; i++) {
      double speed = state->velocity[i].speed;
      memset(&state->velocity[i], 0, sizeof state->velocity[i]);
      state->velocity[i].speed = speed;
    }
  if (state->filter.started &&
      (memcmp(from->filter.p, to->filter.p, sizeof from->filter.p) != 0 || from->filter.method != to->filter.method)) {
    ethd_vec x, v;
    ethd_filter_output(&from->filter, &state->filter, &x, &v);
    ethd_filter_start(&to->filter, &state->filter, x, v);
  }
}

/* A law that stays keeps its state; a new one starts from zero, and so does everything in a new scene. */
static void migrate(const ethd__plan *from, const ethd__plan *to, ethd__state *state) ETHD_RT {
  migrate_estimators(from, to, state);
  for (int place = 0; place < ETHD__PLACES; place++)
    if (ethd__place_scene(&from->setup, place) != ethd__place_scene(&to->setup, place))
      ethd__place_forget(&state->places[place]);
  if (from->setup.tracking != to->setup.tracking)
    ethd__block_reset(&to->setup.tracking->law, to->setup.tracking_p, state->tracking);
  for (int i = 0; i < ETHD_CONTACTS_MAX; i++) {
    ethd__slot *slot = &state->slots[i];
    if (ethd__place_scene(&from->setup, slot->place) != ethd__place_scene(&to->setup, slot->place)) slot->used = 0;
    if (from->setup.transition != to->setup.transition)
      ethd__block_reset(&to->setup.transition->law, to->setup.transition_p, slot->transition);
    if (from->setup.contact != to->setup.contact)
      ethd__block_reset(&to->setup.contact->law, to->setup.contact_p, slot->contact);
  }
}

/* The old setup once more, on a copy; then the new one, and the difference starts to fade. */
static void swap(const ethd__entry *e, ethd__state *state, ethd__state *scratch, const ethd_sense *sense, double dt,
                 ethd_pose *pose, ethd_trace *out, ethd__failure *failure) ETHD_RT {
  double old[2];
  memcpy(scratch, state, sizeof *scratch);
  int held = compute(e->from, scratch, sense, dt, pose, out, failure);
  memcpy(old, out->tau_raw, sizeof old);
  migrate(e->from, e->plan, state);
  if (!held) ethd__estimate(e->plan, state, sense, dt, pose, out);
  if (!held || !ethd__evaluate(e->plan, state, sense, dt, pose, out, failure)) return;
  start_fade(state, old, out->tau_raw);
  memcpy(out->tau_raw, old, sizeof old);
}

/* ---- the whole tick ---- */

/* The torque before the guard, out->tau_raw; what prevents it, *failure. */
static void drive(const ethd__entry *e, ethd__state *state, ethd__state *scratch, const ethd_sense *sense, double dt,
                  ethd_pose *pose, ethd_trace *out, ethd__failure *failure) ETHD_RT {
  int blind = failure->fault == ETHD_FAULT_INPUT;
  int idle = blind || state->fault || failure->fault != ETHD_FAULT_NONE;
  if (!blind) ethd__places_take(state, sense);
  if (!idle && e->from && !e->soft) {
    swap(e, state, scratch, sense, dt, pose, out, failure);
    return;
  }
  if (e->from) migrate(e->from, e->plan, state);
  if (idle) { /* the estimators go on, so that the trace and a later resume are right */
    if (!blind) ethd__estimate(e->plan, state, sense, dt, pose, out);
  } else if (compute(e->plan, state, sense, dt, pose, out, failure) && e->soft) {
    const double zero[2] = {0, 0};
    start_fade(state, zero, out->tau_raw);
    memset(out->tau_raw, 0, sizeof out->tau_raw);
  }
}

/* Rows that are known before anything is worked out; those that take the torque away are the failure. */
static ethd__failure look(const ethd__plan *plan, ethd__state *state, const ethd_sense *sense, int64_t n) ETHD_RT {
  ethd__failure failure = {ETHD_FAULT_NONE, 0};
  state->met = (ethd__rows){0, 0};
  if (sense->faults | sense->grave) ethd__rows_take(&state->met, sense);
  int good = input_is_good(sense, &failure);
  if (plan->looks_further) look_further(plan, state, sense, n);
  if (!good || state->fault) return failure;
  if (!within_budget(plan, sense, &failure) || !ethd__rows_any(&state->met)) return failure;
  failure.fault = ethd__rows_zero(&state->met);
  failure.value = (state->met.grave & ETHD_FAULT_BIT(failure.fault)) != 0;
  return failure;
}

ethd__failure ethd__tick(const ethd__entry *e, ethd__state *state, ethd__state *scratch, const ethd_sense *sense,
                         ethd_trace *out) {
  ethd_pose pose; /* stays unknown on a blind tick, where nothing needs it */
  int64_t n = periods(sense), gap = state->blind + n < GAP_MAX ? state->blind + n : GAP_MAX;
  double dt = (double)gap * e->plan->setup.period;
  ethd__failure failure = look(e->plan, state, sense, n);
  state->blind = failure.fault == ETHD_FAULT_INPUT ? gap : 0;
  blank(sense, out);
  out->swap = e->from != NULL;
  drive(e, state, scratch, sense, dt, &pose, out, &failure);
  guard(e->plan, state, &pose, dt, out, &failure);
  if (out->guard == ETHD_GUARD_TORQUE && !state->fault && !ethd__rows_any(&state->met))
    ethd__rows_cut(&state->met, &state->guard); /* frequent, and nothing else */
  else if (out->guard || state->fault || ethd__rows_any(&state->met))
    out->fault = ethd__judge(e->plan, state, out->guard, n);
  out->tick = (int64_t)state->counters.ticks++;
  return failure;
}

/* An estimator that a number out of all measure has spoilt would never recover. */
static void heal(ethd__state *state) ETHD_RT {
  for (int i = 0; i < 2; i++)
    if (!isfinite(state->velocity[i].speed)) memset(&state->velocity[i], 0, sizeof state->velocity[i]);
  if (!two_finite(state->filter.x) || !two_finite(state->filter.v)) memset(&state->filter, 0, sizeof state->filter);
}

/* After an acknowledged fault: contacts begin anew. */
void ethd__resume(const ethd__plan *plan, ethd__state *state) {
  heal(state);
  __atomic_store_n(&state->fault, ETHD_FAULT_NONE, __ATOMIC_RELAXED);
  state->before = (ethd__rows){0, 0}; /* what lasts is a new occurrence */
  state->guard.stopping = state->guard.stopped = 0;
  state->fade.elapsed = (double)INFINITY;
  for (int i = 0; i < ETHD_CONTACTS_MAX; i++) state->slots[i].used = 0;
  ethd__block_reset(&plan->setup.tracking->law, plan->setup.tracking_p, state->tracking);
}
