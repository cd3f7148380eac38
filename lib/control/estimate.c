#include "control/estimate.h"

#include "arm_pose.h"
#include "core/finger.h"
#include "estimate/filter_methods.h"
#include "estimate/fit_methods.h"
#include "estimate/velocity_methods.h"

/* v - v is 0 for a finite number, and NaN for any other. */
static bool is_finite(double v) { return v - v == 0; }

/* ---- ring ---- */

/* An enormous torque, which some estimators use as input, must not spoil the state for good: an impossible speed, or
   NaN, restarts the estimator. */
static double joint_speed(const ethd__tick *t, double dt, int i) {
  ethd_velocity_state *s = &t->state->velocity[i];
  double speed = ethd__velocity_step(&t->plan->velocity, s, t->sense->q[i], t->state->guard.last[i], dt);
  if (!(fabs(speed) <= ETHD_SENSE_SPEED_MAX)) memset(s, 0, sizeof *s);
  return speed;
}

static void remember(ethd__state *state, int64_t time_ns, ethd_vec x) {
  uint64_t i = state->remembered++ % ETHD__HISTORY;
  state->history[i].time_ns = time_ns;
  state->history[i].x = x;
}

/* Returns b - a in s, for any a <= b. */
static double seconds(int64_t a, int64_t b) { return 1e-9 * (double)((uint64_t)b - (uint64_t)a); }

#define ROUNDED 1e-3 /* periods: a stamp that differs by less counts as a whole tick's */
#define LEAST 0.1    /* periods: samples closer than this give no good speed */
#define GAP 0.05     /* s: no exchange of a bus is longer */

/* Returns the time from the last joint sample to this one, s, by their stamps. A bus that isn't synchronous with the
   ticks gives samples whose spacing varies, although each arrives at a tick: with the ticks' time the speed would seem
   to vary, which would disturb a stop. If the stamps differ by more than limits.gap from the ticks' time, or don't
   rise, their clock is wrong, and the ticks' time counts. */
static double sample_spacing(const ethd__tick *t) {
  const double period = t->plan->setup.period;
  const uint64_t passed = (uint64_t)t->sense->time_ns - (uint64_t)t->state->velocity_ns;
  if (passed == (uint64_t)t->plan->period_ns && t->dt == period) return t->dt; /* nearly always */
  if (t->sense->time_ns <= t->state->velocity_ns) return t->dt;
  const double stamped = seconds(t->state->velocity_ns, t->sense->time_ns), off = fabs(stamped - t->dt);
  const bool used = off > ROUNDED * period && off <= fmin(t->plan->setup.limits.gap, GAP) && stamped >= LEAST * period;
  return used ? stamped : t->dt;
}

/* Returns the time from joint i's last sample to this one, s; a sample was taken `age` before its sense's instant. A
   repeated sample has the ticks' time, as in sample_spacing. */
static double own_spacing(const ethd__tick *t, double dt, int i) {
  double *last = &t->state->age[i], now = t->sense->have & ETHD_HAVE_AGE ? t->sense->age[i] : 0;
  const double own = dt + (*last - now);
  *last = now;
  return own >= LEAST * t->plan->setup.period ? own : t->dt;
}

static void joint_speeds(const ethd__tick *t, double qd[2]) {
  const double dt = sample_spacing(t);
  t->state->velocity_ns = t->sense->time_ns;
  for (int i = 0; i < 2; i++) {
    const double own = own_spacing(t, dt, i);
    qd[i] = t->sense->have & ETHD_HAVE_DQ ? t->sense->dq[i] : joint_speed(t, own, i);
  }
}

/* Gives both joints' angles at the sense's instant. */
static void joint_angles(const ethd__tick *t, const double qd[2], double q[2]) {
  memcpy(q, t->sense->q, sizeof t->sense->q);
  for (int i = 0; i < 2 && t->sense->have & ETHD_HAVE_AGE; i++) q[i] += qd[i] * t->sense->age[i];
}

/* Returns the instant `s` seconds before `instant`; it wraps round like the clock. */
static int64_t before(int64_t instant, double s) { return (int64_t)((uint64_t)instant - (uint64_t)(int64_t)(1e9 * s)); }

/* Returns the ring's position at an earlier instant: linear between ticks, constant before the history. */
static ethd_vec ring_at(const ethd__state *state, int64_t time_ns) {
  uint64_t now = state->remembered - 1;
  uint64_t oldest = now >= ETHD__HISTORY ? now - ETHD__HISTORY + 1 : 0;
  uint64_t k = now;
  while (k > oldest && state->history[k % ETHD__HISTORY].time_ns > time_ns) k--;
  ethd_vec a = state->history[k % ETHD__HISTORY].x;
  int64_t ta = state->history[k % ETHD__HISTORY].time_ns;
  if (k == now || ta >= time_ns) return a;
  ethd_vec b = state->history[(k + 1) % ETHD__HISTORY].x;
  int64_t tb = state->history[(k + 1) % ETHD__HISTORY].time_ns;
  double share = seconds(ta, time_ns) / seconds(ta, tb);
  return ethd_vec_add(a, ethd_vec_scale(share, ethd_vec_sub(b, a)));
}

/* ---- the finger's readings ---- */

/* Returns the position to which the reading is relative: the ring's at the instant of the filter's `reference`. */
static ethd_vec reference(const ethd__tick *t) {
  if (t->plan->filter.reference == ETHD_REFERENCE_TICK) return t->ring.x;
  if (t->sense->have & ETHD_HAVE_RING) return ethd_vec_of(t->sense->ring);
  return ring_at(t->state, t->sense->sample_ns);
}

/* Returns the finger's velocity minus the ring's mean velocity while the frame's rays were taken. */
static ethd_vec relative_velocity(const ethd__tick *t) {
  const ethd__plan *plan = t->plan;
  ethd_vec first = ring_at(t->state, before(t->sense->sample_ns, plan->lag_most));
  ethd_vec last = ring_at(t->state, before(t->sense->sample_ns, plan->lag_least));
  ethd_vec ring_v = ethd_vec_scale(1 / (plan->lag_most - plan->lag_least), ethd_vec_sub(last, first));
  return ethd_vec_sub(ethd_vec_of(t->state->filter.v), ring_v);
}

static ethd_status fit(const ethd__tick *t, ethd_finger *out) {
  const ethd__plan *plan = t->plan;
  if (plan->lag_least == plan->lag_most || !t->state->filter.started)
    return ethd_fit_step(&plan->fit, t->sense->rays, out);
  return ethd__fit_moving(&plan->fit, t->sense->rays, plan->setup.ray_lag, relative_velocity(t), out);
}

static bool is_world(const ethd__tick *t) {
  return (t->sense->have & (ETHD_HAVE_CENTRE | ETHD_HAVE_WORLD)) == (ETHD_HAVE_CENTRE | ETHD_HAVE_WORLD);
}

/* Gives this tick's reading, relative to the ring, or in R_0 if it was measured in R_0; false: it isn't usable. */
static bool reading(const ethd__tick *t, ethd_vec *out) {
  if (t->sense->have & ETHD_HAVE_CENTRE) {
    *out = ethd_vec_of(t->sense->centre);
    return fabs(out->x) <= ETHD_SENSE_LENGTH_MAX && fabs(out->y) <= ETHD_SENSE_LENGTH_MAX;
  }
  ethd_finger finger;
  if (fit(t, &finger) != ETHD_OK) return false;
  t->state->finger_radius = finger.radius;
  *out = finger.centre;
  return true;
}

/* Returns true if the reading isn't from the future and isn't the last one again. It compares stamps because ages are
   sums of periods, whose rounding could make the same reading seem newer. */
static bool is_new(const ethd__tick *t) {
  return t->sense->sample_ns <= t->sense->time_ns &&
         (t->state->filter.used == 0 || t->sense->sample_ns != t->state->reading_ns);
}

/* Returns whether a reading's noise is possible; NaN isn't. */
static bool noise_is_possible(const ethd__tick *t) {
  return t->sense->finger_noise >= 0 && t->sense->finger_noise <= ETHD_SENSE_LENGTH_MAX;
}

/* Returns whether a reading puts the finger's centre outside the ring. */
static bool is_outside(const ethd__tick *t, ethd_vec reading) {
  if (is_world(t)) reading = ethd_vec_sub(reading, ring_at(t->state, t->sense->sample_ns));
  return !(ethd_vec_norm(reading) <= t->plan->setup.ring_radius);
}

/* Corrects the filter. A reading is dropped (false) when it puts the finger's centre outside the ring or when the
   filter's gate rejects it. */
static bool use(const ethd__tick *t, ethd_vec reading) {
  const ethd__plan *plan = t->plan;
  ethd_filter_state *filter = &t->state->filter;
  bool outside = plan->watches_finger && is_outside(t, reading);
  uint32_t gated = filter->gated;
  ethd_vec x = is_world(t) ? reading : ethd_vec_add(reading, reference(t));
  double age = seconds(t->sense->sample_ns, t->sense->time_ns);
  ethd_status status =
      outside ? ETHD_STATUS_STALE : ethd__filter_update(&plan->filter, filter, x, age, t->sense->finger_noise);
  /* unreachable: readings, ages and noises are bounded, so that the filter's numbers stay finite */
  if (!is_finite(filter->x[0] + filter->x[1]) || !is_finite(filter->v[0] + filter->v[1]))
    memset(filter, 0, sizeof *filter); /* unreachable, as above; the filter would start anew with the next reading */
  if (plan->watches_finger)
    ethd__finger_doubt(&t->state->core, &t->state->implausible, outside || filter->gated != gated);
  return status == ETHD_OK;
}

static void correct(const ethd__tick *t) {
  ethd_vec seen;
  if (!is_new(t) || !noise_is_possible(t) || !reading(t, &seen) || !use(t, seen)) {
    t->state->core.counters.readings_dropped++;
    return;
  }
  t->state->reading_ns = t->sense->sample_ns;
  t->state->reading_age = seconds(t->sense->sample_ns, t->sense->time_ns);
}

/* ---- the finger ---- */

/* The age counts from the sample's instant, so it includes the reading's latency. The half nanosecond accepts a reading
   that is exactly as old as the limit. */
static void watch(const ethd__tick *t) {
  ethd__state *state = t->state;
  const double limits[2] = {t->plan->setup.limits.finger_age, t->plan->setup.limits.finger_lost};
  double age = 1e-9 * ((double)((uint64_t)t->sense->time_ns - (uint64_t)state->reading_ns) - 0.5);
  state->absent = ethd__finger_age(&state->core, age, limits, state->absent, t->dt);
}

static void filter(const ethd__tick *t) {
  const ethd_filter *method = &t->plan->filter;
  ethd_filter_state *s = &t->state->filter;
  if (t->sense->have & ETHD_HAVE_START)
    ethd_filter_start(method, s, ethd_vec_of(t->sense->finger), (ethd_vec){0, 0});
  else if (s->started)
    ethd__filter_predict(method, s, t->dt);
  if (t->sense->have & (ETHD_HAVE_CENTRE | ETHD_HAVE_RAYS)) correct(t);
  if (t->plan->watches_finger && s->used > 0) watch(t);
}

/* A finger that was never seen counts as in the ring's centre and moving with it, so that the ring follows nothing. */
static void finger(ethd__tick *t) {
  t->finger = t->ring;
  if (t->sense->have & ETHD_HAVE_FINGER) {
    t->finger = (ethd__motion){ethd_vec_of(t->sense->finger), ethd_vec_of(t->sense->finger_v)};
    return;
  }
  filter(t);
  if (t->state->filter.started) ethd__filter_output(&t->plan->filter, &t->state->filter, &t->finger.x, &t->finger.v);
}

/* ---- both ---- */

void ethd__estimate(ethd__tick *t) {
  ethd_trace *out = t->trace;
  double q[2];
  joint_speeds(t, out->qd);
  joint_angles(t, out->qd, q);
  ethd__arm_pose(&t->plan->setup.arm, q, &t->pose);
  t->ring = (ethd__motion){t->pose.x, ethd_pose_velocity(&t->pose, out->qd)};
  remember(t->state, t->sense->time_ns, t->ring.x);
  finger(t);
  ethd_vec_put(t->ring.x, out->x);
  ethd_vec_put(t->ring.v, out->v);
  ethd_vec_put(t->finger.x, out->xf);
  ethd_vec_put(t->finger.v, out->vf);
  out->rf = t->state->finger_radius;
}
