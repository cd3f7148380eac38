#include <string.h>

#include "guard/parts.h"

/* A stop damps the ring until it is slower than STILL. STILL is the paper's v_th (eq. 11), below which a ring counts as
   standing still. STOP_DAMPING is a fifth of the paper's B_d. Any device that renders the paper's wall is stable with
   it: with a tick of delay a free mass m is stable up to a damping of 0.83 m/T, so at 1 kHz 20 Ns/m suit 24 g and more.
   A ring of 0.12 kg that moves at 0.2 m/s stands still after 14 ms. */
#define STOP_DAMPING 20.0 /* Ns/m */
#define STILL 0.020       /* m/s */

static bool is_outside(const double w[4], ethd_vec x) ETHD_RT {
  return !(x.x >= w[0] && x.x <= w[1] && x.y >= w[2] && x.y <= w[3]);
}

static int32_t breach(const ethd_limits *limits, ethd_vec x, ethd_vec v) ETHD_RT {
  int32_t bits = 0;
  if (!(ethd_vec_norm(v) <= limits->speed)) bits |= ETHD_GUARD_SPEED;
  if (is_outside(limits->workspace, x)) bits |= ETHD_GUARD_WORKSPACE;
  return bits;
}

/* Replaces the torque by damping while the ring moves and by zero once it stands still: the arm is counterweighted. */
static void stop(ethd_guard_state *s, const ethd_pose *pose, ethd_vec v, double torque[2]) ETHD_RT {
  if (s->stopping && ethd_vec_norm(v) < STILL) s->stopped = 1;
  torque[0] = torque[1] = 0;
  if (!s->stopped) ethd_pose_torques(pose, ethd_vec_scale(-STOP_DAMPING, v), torque);
}

/* Brings a value, which isn't NaN, to within `most` of the centre; returns true if it was outside. */
static bool clamp(double centre, double most, double *value) ETHD_RT {
  double lo = centre - most, hi = centre + most;
  if (*value >= lo && *value <= hi) return false;
  *value = *value < lo ? lo : hi;
  return true;
}

static void count(ethd_guard_state *s, int32_t bits) ETHD_RT {
  for (; bits; bits &= bits - 1) s->counts[__builtin_ctz((unsigned)bits)]++;
}

/* Counts steep ticks and stops the ring after too many in a row. Steepness is judged on the torque that was asked for,
   so one step that the rate limiter spreads over many ticks is steep only once. */
static int32_t steep(const ethd_limits *limits, ethd_guard_state *s, double dt, const double torque[2]) ETHD_RT {
  double most = limits->torque_rate * dt * (1 + 1e-9);
  bool too_steep = fabs(torque[0] - s->asked[0]) > most || fabs(torque[1] - s->asked[1]) > most;
  s->steep = too_steep ? s->steep + 1 : 0;
  memcpy(s->asked, torque, sizeof s->asked);
  if (s->steep < ETHD_STEEP_MAX || !limits->latch) return 0;
  s->stopping |= ETHD_GUARD_STEEP; /* the ring is damped from the next tick on */
  return ETHD_GUARD_STEEP;
}

/* Bounds one joint's torque by heat and limit, then by the rate's window around the last torque. That window may lie
   outside of the limits, when one has just become stricter, so the limits have the last word. */
static int32_t bound(const ethd_limits *limits, const ethd_guard_state *s, int i, double rise, double *torque) ETHD_RT {
  const bool may_be_hot = limits->nominal_torque < (double)INFINITY;
  const double heat = may_be_hot ? ethd__guard_cool(limits, s->heat[i]) : (double)INFINITY;
  int32_t bits = 0;
  if (clamp(0, heat, torque)) bits |= ETHD_GUARD_HEAT;
  if (clamp(0, limits->torque, torque)) bits |= ETHD_GUARD_TORQUE;
  if (!clamp(s->last[i], rise, torque)) return bits;
  if (clamp(0, heat, torque)) bits |= ETHD_GUARD_HEAT;
  if (clamp(0, limits->torque, torque)) bits |= ETHD_GUARD_TORQUE;
  return bits | ETHD_GUARD_RATE;
}

int32_t ethd_guard_step(const ethd_limits *limits, ethd_guard_state *s, const ethd_pose *pose, ethd_vec v, double dt,
                        double torque[2]) {
  int32_t bits = breach(limits, pose->x, v);
  if (limits->latch) s->stopping |= bits;
  bool stopping = bits || s->stopping, rated = !stopping && limits->torque_rate < (double)INFINITY;
  if (stopping) {
    stop(s, pose, v, torque);
    bits |= s->stopping & ETHD_GUARD_FAULT;
  } else if (limits->margin > 0 && ethd__guard_wall(limits, pose, v, torque)) {
    bits |= ETHD_GUARD_MARGIN;
  }
  if (!((torque[0] - torque[0]) + (torque[1] - torque[1]) == 0)) { /* x - x is NaN for an x that isn't finite */
    bits |= ETHD_GUARD_FINITE;
    torque[0] = torque[1] = 0;
    s->last[0] = s->last[1] = 0; /* zero at this very tick, not at the rate's pace */
  }
  if (rated) bits |= steep(limits, s, dt, torque);
  for (int i = 0; i < 2; i++) {
    bits |= bound(limits, s, i, rated ? limits->torque_rate * dt : (double)INFINITY, &torque[i]);
    s->last[i] = torque[i];
  }
  s->cut = bits & ETHD_GUARD_TORQUE ? s->cut + dt : 0;
  if (bits) count(s, bits);
  return bits;
}
