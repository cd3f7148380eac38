#include "ethd/guard.h"

/* A stop damps the ring with this much, Ns/m, until it is slower than STILL. */
#define STOP_DAMPING 20.0
#define STILL 0.020

static int outside(const double w[4], ethd_vec x) ETHD_RT {
  return !(x.x >= w[0] && x.x <= w[1] && x.y >= w[2] && x.y <= w[3]);
}

static int32_t breach(const ethd_limits *limits, ethd_vec x, ethd_vec v) ETHD_RT {
  int32_t bits = 0;
  if (!(ethd_vec_norm(v) <= limits->speed)) bits |= ETHD_GUARD_SPEED;
  if (outside(limits->workspace, x)) bits |= ETHD_GUARD_WORKSPACE;
  return bits;
}

/* Damping while the ring moves, nothing once it stands: the arm is counterweighted. */
static void stop(ethd_guard_state *s, const ethd_pose *pose, ethd_vec v, double torque[2]) ETHD_RT {
  if (s->stopping && ethd_vec_norm(v) < STILL) s->stopped = 1;
  ethd_vec tau = {0, 0};
  if (!s->stopped) tau = ethd_mat_mul_transposed(pose->j, ethd_vec_scale(-STOP_DAMPING, v));
  torque[0] = tau.x;
  torque[1] = tau.y;
}

/* `symmetric` clamp that says whether it had to; NaN is left for the caller, who has checked it. */
static int clamp(double centre, double most, double *value) ETHD_RT {
  double lo = centre - most, hi = centre + most;
  if (*value >= lo && *value <= hi) return 0;
  *value = *value < lo ? lo : hi;
  return 1;
}

static void count(ethd_guard_state *s, int32_t bits) ETHD_RT {
  for (int i = 0; i < ETHD_GUARD_COUNT; i++)
    if (bits & (1 << i)) s->counts[i]++;
}

int32_t ethd_guard_step(const ethd_limits *limits, ethd_guard_state *s, const ethd_pose *pose,
                        ethd_vec v, double dt, double torque[2]) {
  int32_t bits = breach(limits, pose->x, v);
  if (limits->latch) s->stopping |= bits;
  int stopping = bits || s->stopping;
  if (stopping) stop(s, pose, v, torque);
  if (!isfinite(torque[0]) || !isfinite(torque[1])) {
    bits |= ETHD_GUARD_FINITE;
    torque[0] = torque[1] = 0;
  }
  for (int i = 0; i < 2; i++) {
    if (clamp(0, limits->torque, &torque[i])) bits |= ETHD_GUARD_TORQUE;
    if (!stopping && clamp(s->last[i], limits->torque_rate * dt, &torque[i])) bits |= ETHD_GUARD_RATE;
    s->last[i] = torque[i];
  }
  if (bits) count(s, bits);
  return bits;
}
