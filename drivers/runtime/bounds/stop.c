#include "bounds/stop.h"

#include <math.h>

double ethd__stop_deceleration(const ethd__bounds_stop *s) { return (s->force + s->friction) / s->mass; }

double ethd__stop_lag(const ethd__bounds_stop *s, double speed) {
  return (s->friction + s->viscous * speed) / s->stiffness + speed * s->behind;
}

double ethd__stop_margin(const ethd__bounds_stop *s, double speed) {
  return s->gap - ethd__stop_lag(s, speed) - speed * speed / (2 * ethd__stop_deceleration(s));
}

/* Solves v^2/(2a) + c v = g, where g is the remaining gap at speed 0 and c its decrease for each m/s. */
double ethd__stop_speed(const ethd__bounds_stop *s) {
  double a = ethd__stop_deceleration(s), g = s->gap - s->friction / s->stiffness;
  double c = s->viscous / s->stiffness + s->behind;
  return g > 0 ? 2 * g / (c + sqrt(c * c + 2 * g / a)) : 0;
}

/* Above v1 = F_sat/B_d the motors saturate and a is constant; below it the speed decays with tau = m/B_d. */
double ethd__braking_time(const ethd__bounds_stop *s, const ethd__bounds_braking *b, double speed) {
  double v1 = fmin(speed, s->force / b->damping), tau = s->mass / b->damping;
  double viscous = v1 > b->v_th ? tau * log(v1 / b->v_th) : 0;
  return (speed - v1) / ethd__stop_deceleration(s) + viscous + b->period + b->delay;
}

double ethd__braking_depth(const ethd__bounds_stop *s, const ethd__bounds_braking *b, double speed) {
  double v1 = fmin(speed, s->force / b->damping), tau = s->mass / b->damping;
  double full = (speed * speed - v1 * v1) / (2 * ethd__stop_deceleration(s));
  return full + tau * fmax(0, v1 - b->v_th) + speed * (b->period / 2 + b->delay);
}
