#include <string.h>

#include "fp_mode.h"
#include "guard/parts.h"

static bool is_outside(const double w[4], ethd_vec x) {
  return !(x.x >= w[0] && x.x <= w[1] && x.y >= w[2] && x.y <= w[3]);
}

static int32_t breach(const ethd_limits *limits, ethd_vec x, ethd_vec v) {
  int32_t bits = 0;
  if (!(ethd_vec_norm(v) <= limits->speed)) bits |= ETHD_GUARD_SPEED;
  if (is_outside(limits->workspace, x)) bits |= ETHD_GUARD_WORKSPACE;
  return bits;
}

/* Clamps a value, which isn't NaN, to within `most` of the centre; returns true if it was outside. */
static bool clamp(double centre, double most, double *value) {
  double lo = centre - most, hi = centre + most;
  if (*value >= lo && *value <= hi) return false;
  *value = *value < lo ? lo : hi;
  return true;
}

static void count(ethd_guard_state *s, int32_t bits) {
  for (; bits; bits &= bits - 1) s->counts[__builtin_ctz((unsigned)bits)]++;
}

/* Counts steep ticks and stops the ring after too many in a row. It judges the requested torque, so a step that the
   rate limiter spreads over many ticks is steep only once. */
static int32_t steep(const ethd_limits *limits, ethd_guard_state *s, double dt, const double torque[2]) {
  double most = limits->torque_rate * dt * (1 + 1e-9);
  bool too_steep = fabs(torque[0] - s->asked[0]) > most || fabs(torque[1] - s->asked[1]) > most;
  s->steep = too_steep ? s->steep + 1 : 0;
  memcpy(s->asked, torque, sizeof s->asked);
  if (s->steep < ETHD_STEEP_MAX || !limits->latch) return 0;
  s->stopping |= ETHD_GUARD_STEEP; /* the ring is stopped from the next tick on */
  return ETHD_GUARD_STEEP;
}

/* Returns the largest torque of a joint, Nm, that limit and heat allow; *bit says which of them decides. */
static double most_of(const ethd_limits *limits, const ethd_guard_state *s, int i, int32_t *bit) {
  *bit = ETHD_GUARD_TORQUE;
  if (!(limits->nominal_torque < (double)INFINITY)) return limits->torque;
  const double heat = ethd__guard_cool(limits, s->heat[i]);
  if (heat >= limits->torque) return limits->torque;
  *bit = ETHD_GUARD_HEAT;
  return heat;
}

int32_t ethd__guard_limit(const ethd_limits *limits, const ethd_guard_device *device, ethd_guard_state *s,
                          const ethd_guard_motion *m, double torque[2]) {
  int32_t bits = breach(limits, m->pose->x, m->v), bit;
  if (limits->latch) s->stopping |= bits;
  const bool stopping = bits || s->stopping;
  if (stopping) {
    ethd__guard_stop(limits, device, s, m, torque);
    bits |= s->stopping & ETHD_GUARD_FAULT;
  } else {
    s->stop.begun = 0;
    if (limits->margin > 0 && ethd__guard_wall(limits, device, m, torque)) bits |= ETHD_GUARD_MARGIN;
  }
  if (!((torque[0] - torque[0]) + (torque[1] - torque[1]) == 0)) { /* x - x is NaN for an x that isn't finite */
    bits |= ETHD_GUARD_FINITE;
    torque[0] = torque[1] = 0;
    s->last[0] = s->last[1] = 0; /* clears the last torque, so that the rate limit can't delay the drop to zero */
  }
  if (!stopping && limits->torque_rate < (double)INFINITY) bits |= steep(limits, s, m->dt, torque);
  for (int i = 0; i < 2; i++) {
    const double most = most_of(limits, s, i, &bit);
    if (clamp(0, most, &torque[i])) bits |= bit;
  }
  return bits;
}

/* The rate's window may lie outside of limits that have just become stricter, so the limits are applied last. */
int32_t ethd__guard_finish(const ethd_limits *limits, ethd_guard_state *s, const ethd__guard_faded *faded, double dt,
                           int32_t bits, double torque[2]) {
  const bool rated = limits->torque_rate < (double)INFINITY && !ethd__guard_stops(s, bits);
  int32_t bit;
  for (int i = 0; i < 2 && (rated || faded); i++) {
    double most = most_of(limits, s, i, &bit);
    if (faded && faded->from[i] > most)
      most = faded->share < 1 ? most + faded->share * (faded->from[i] - most) : faded->from[i];
    if (faded && clamp(0, most, &torque[i])) bits |= bit;
    if (!rated || !clamp(s->last[i], limits->torque_rate * dt, &torque[i])) continue;
    bits |= ETHD_GUARD_RATE;
    if (clamp(0, most, &torque[i])) bits |= bit;
  }
  s->last[0] = torque[0];
  s->last[1] = torque[1];
  s->cut = bits & ETHD_GUARD_TORQUE ? s->cut + dt : 0;
  if (bits) count(s, bits);
  return bits;
}

ETHD__FP_APART static int32_t both_halves(const ethd_limits *limits, const ethd_guard_device *device,
                                          ethd_guard_state *s, const ethd_guard_motion *m, double torque[2]) {
  const int32_t bits = ethd__guard_limit(limits, device, s, m, torque);
  return ethd__guard_finish(limits, s, NULL, m->dt, bits, torque);
}

int32_t ethd_guard_step(const ethd_limits *limits, const ethd_guard_device *device, ethd_guard_state *s,
                        const ethd_guard_motion *m, double torque[2]) {
  ETHD__FP_RETURN(int32_t, both_halves(limits, device, s, m, torque));
}
