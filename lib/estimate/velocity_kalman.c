/* Kalman filter of position and speed.

     x = (q, w),  x+ = (q + w dt + u dt^2 / 2, w + u dt),  u = torque / inertia,
     Q = acceleration^2 (dt^2 / 2, dt)(dt^2 / 2, dt)^T,  z = q + noise                               */
#include "estimate/velocity_methods.h"

#define SPEED_VARIANCE 1.0 /* rad^2/s^2: how well the speed is known at the start, sd 1 rad/s */

static void start(const ethd_velocity *v, ethd_velocity_state *s) {
  double noise = v->p[VELOCITY_NOISE];
  s->position = s->q[s->head];
  s->cov[0] = noise * noise;
  s->cov[1] = 0;
  s->cov[2] = SPEED_VARIANCE;
}

static void predict(const ethd_velocity *v, ethd_velocity_state *s, double torque) {
  double dt = s->dt[s->head], *c = s->cov;
  double u = torque / v->p[VELOCITY_INERTIA];
  double g0 = v->p[VELOCITY_ACCELERATION] * dt * dt / 2, g1 = v->p[VELOCITY_ACCELERATION] * dt;
  s->position += (s->speed + u * dt / 2) * dt;
  s->speed += u * dt;
  c[0] += (2 * c[1] + c[2] * dt) * dt + g0 * g0;
  c[1] += c[2] * dt + g0 * g1;
  c[2] += g1 * g1;
}

static void correct(const ethd_velocity *v, ethd_velocity_state *s) {
  double noise = v->p[VELOCITY_NOISE], *c = s->cov;
  double r = noise * noise, variance = c[0] + r;
  double innovation = s->q[s->head] - s->position;
  s->position += c[0] / variance * innovation;
  s->speed += c[1] / variance * innovation;
  c[2] -= c[1] / variance * c[1];
  c[1] *= r / variance;
  c[0] *= r / variance;
}

double ethd__velocity_kalman(const ethd_velocity *v, ethd_velocity_state *s, double torque) {
  if (s->count < 2) {
    start(v, s);
    return s->speed;
  }
  predict(v, s, torque);
  correct(v, s);
  return s->speed;
}
