#include "ethd/estimate.h"

#include <math.h>

#include "estimate/velocity_methods.h"
#include "ethd/maths.h"
#include "fp_mode.h"

_Static_assert((ETHD_VELOCITY_WINDOW_MAX & (ETHD_VELOCITY_WINDOW_MAX - 1)) == 0, "the ring's index is masked");

double ethd__velocity_gain(double cutoff, double dt) { return 1 - ethd_exp(-2 * M_PI * cutoff * dt); }

static void push(ethd_velocity_state *s, double q, double dt) {
  s->head = (s->head + 1) & (ETHD_VELOCITY_WINDOW_MAX - 1);
  s->q[s->head] = q;
  s->dt[s->head] = dt;
  if (s->count < ETHD_VELOCITY_WINDOW_MAX) s->count++;
}

static double difference(const ethd_velocity_state *s) {
  return (s->q[s->head] - s->q[ethd__velocity_back(s, 1)]) / s->dt[s->head];
}

static double lowpass(const ethd_velocity *v, const ethd_velocity_state *s) {
  double dt = s->dt[s->head];
  double a = dt == v->period ? v->gain : ethd__velocity_gain(v->p[LOWPASS_CUTOFF], dt);
  double raw = difference(s);
  return s->speed + a * (raw - s->speed);
}

static double next(const ethd_velocity *v, ethd_velocity_state *s, double torque) {
  if (v->method == ETHD_VELOCITY_KALMAN) return ethd__velocity_kalman(v, s, torque);
  if (s->count < 2) return s->speed;
  switch (v->method) { /* unreachable: another method; no default, so that the compiler reports a missing one */
  case ETHD_VELOCITY_LOWPASS: return lowpass(v, s);
  case ETHD_VELOCITY_LSQ: return ethd__velocity_lsq(v, s);
  case ETHD_VELOCITY_FOAW: return ethd__velocity_foaw(v, s);
  case ETHD_VELOCITY_DIFFERENCE:
  case ETHD_VELOCITY_KALMAN: /* above */
  case ETHD_VELOCITY_COUNT: break;
  }
  return difference(s);
}

ETHD__FP_APART double ethd__velocity_step(const ethd_velocity *v, ethd_velocity_state *s, double q, double torque,
                                          double dt) {
  push(s, q, dt);
  return s->speed = next(v, s, torque);
}

double ethd_velocity_step(const ethd_velocity *velocity, ethd_velocity_state *state, double q, double torque,
                          double dt) {
  ETHD__FP_RETURN(double, ethd__velocity_step(velocity, state, q, torque, dt));
}
