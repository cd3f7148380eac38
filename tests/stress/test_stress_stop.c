/* The saturated stop: the motors give F_sat until B_d v falls below it at v1 = F_sat/B_d, then B_d v;
   Coulomb friction f_c helps all along. Per tick, with b = B_d T/m and g = f_c/B_d:

     v > v1:   v_k+1 = v_k - a T,  a = (F_sat + f_c)/m
     then:     v_k+1 + g = (1 - b)(v_k + g) */
#include <math.h>

#include "stress/mass.h"

typedef struct stop {
  const char *plant;
  double mass, force, friction, damping, v_th, period;
} stop;

static const stop stops[] = {
    {"plant n", 0.1173, 5.357, 0.398, 100, 0.020, 0.001},
    {"plant b", 0.1445, 5.369, 0.164, 100, 0.020, 0.001},
};

typedef struct stopped {
  double time, eps;   /* of braking, s, m */
  double depth, left; /* m, and the speed there, at its last tick on the way in */
} stopped;

/* The ring has coasted for a while and meets the wall `late` s before the tick that sees it. */
static stopped measure(const stop *s, double speed, double late, int delay, int measured) {
  const double coast = 5 * s->period;
  mass_rig r;
  mass_open(&r, s->mass, speed * (coast - late));
  ethd_setup_velocity(&r.on.setup, ETHD_VELOCITY_DIFFERENCE);
  r.on.setup.arm.link1 = MASS_STRAIGHT;
  mass_brakes(&r, s->damping, s->v_th);
  r.measured = measured;
  r.force_limit = s->force;
  r.delay = delay;
  mass_start(&r, speed);
  while (mass_step(&r)->state != ETHD_BRAKING) mass_move(&r);
  int64_t begin = r.tick;
  double depth = 0, left = speed;
  while (r.on.trace.state == ETHD_BRAKING) {
    if (r.tick - begin >= delay) r.push.x = s->friction; /* with the motors, out of the wall */
    mass_move(&r);
    if (mass_speed(&r) > 0) depth = mass_depth(&r) - r.gap, left = mass_speed(&r);
    mass_step(&r);
  }
  stopped o = {(double)(r.tick - begin) * s->period, r.on.trace.eps, depth, left};
  mass_close(&r);
  return o;
}

/* The same by the two recursions' closed forms. */
static stopped sampled(const stop *s, double speed, double late) {
  double T = s->period, v1 = s->force / s->damping, a = (s->force + s->friction) / s->mass;
  double b = s->damping * T / s->mass, g = s->friction / s->damping;
  double n1 = fmax(0, ceil((speed - v1) / (a * T))), v = speed - n1 * a * T;
  double n2 = fmax(0, ceil(log((s->v_th + g) / (v + g)) / log1p(-b)));
  double way = n1 * T * (speed + v) / 2;
  /* trapezia of the speeds: the force is held */
  way += T * (v + g) * (1 - pow(1 - b, n2)) / b * (1 - b / 2) - g * n2 * T;
  return (stopped){.time = (n1 + n2) * T, .eps = speed * late + way};
}

/* In continuous time: half a period until the contact is seen, the delay, and half a period of hold, which makes
   braking longer but not deeper. */
static stopped smooth(const stop *s, double speed, int delay) {
  double v1 = s->force / s->damping, a = (s->force + s->friction) / s->mass, tau = s->mass / s->damping;
  double seen = s->period / 2 + delay * s->period;
  return (stopped){.time = (speed - v1) / a + tau * log(v1 / s->v_th) + seen + s->period / 2,
                   .eps = (speed * speed - v1 * v1) / (2 * a) + tau * (v1 - s->v_th) + speed * seen};
}

/* No ring stops quicker than F_sat and f_c let it. */
static void check_least(const stop *s, double speed, double late, int delay, const stopped *o) {
  double a = (s->force + s->friction) / s->mass;
  double least = (speed * speed - o->left * o->left) / (2 * a) + speed * (late + delay * s->period);
  if (o->depth > 0) bound(least, o->depth + 1e-9, "%s, n = %d: v^2/(2a) + v (T/2 + t_d) <= depth", s->plant, delay);
}

/* Means over speeds about `speed` and instants of contact within a tick: what ticks make of a stop. */
static void compare(const stop *s, double speed, int delay) {
  stopped m = {0}, f = {0};
  for (int i = 0; i < 20; i++)
    for (int k = 0; k < 10; k++) {
      double v = speed * (0.95 + 0.1 * (i + 0.5) / 20), late = s->period * (k + 0.5) / 10;
      stopped one = measure(s, v, late, delay, 0), form = smooth(s, v, delay);
      check_least(s, v, late, delay, &one);
      m.time += one.time / 200, m.eps += one.eps / 200;
      f.time += form.time / 200, f.eps += form.eps / 200;
    }
  within(m.time, f.time, s->period, "%s, n = %d, %g m/s: Delta_s without ticks", s->plant, delay, speed);
  within(m.eps, f.eps, speed * s->period / 4, "%s, n = %d, %g m/s: eps without ticks", s->plant, delay, speed);
}

TEST(test_stop) {
  static const double speeds[] = {0.05, 0.1, 0.2, 0.4, 0.6, 0.8};
  for (size_t p = 0; p < 2; p++)
    for (size_t i = 0; i < 6; i++) {
      stopped m = measure(&stops[p], speeds[i], 3e-4, 0, 1), f = sampled(&stops[p], speeds[i], 3e-4);
      within(m.time, f.time, 1e-9, "time of braking, tick for tick");
      near(m.eps, f.eps, 1e-4, "eps, tick for tick");
    }
  for (size_t p = 0; p < 2; p++)
    for (int n = 0; n <= 1; n++) {
      if (stops[p].damping > 0.828 * stops[p].mass / stops[p].period && n) continue; /* unstable there */
      for (size_t i = 2; i < 4; i++) compare(&stops[p], speeds[i], n);
    }
}
