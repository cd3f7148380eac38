/* The saturated stop: the motors give F_sat until B_d v falls below it at v1 = F_sat/B_d, then B_d v;
   Coulomb friction f_c helps all along. Per tick, with b = B_d T/m and g = f_c/B_d:

     v > v1:   v_k+1 = v_k - a T,  a = (F_sat + f_c)/m
     then:     v_k+1 + g = (1 - b)(v_k + g) */
#include <math.h>

#include "stress/rig.h"
#include "stress/stress.h"

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
  ethd__stress_rig rig;
  ethd__stress_rig_open(&rig, s->mass, speed * (coast - late));
  ethd_setup_velocity(&rig.setup, ETHD_VELOCITY_DIFFERENCE);
  rig.setup.arm.link1 = ETHD__STRESS_RIG_STRAIGHT;
  ethd__stress_rig_brakes(&rig, s->damping, s->v_th);
  rig.measured = measured;
  rig.force_limit = s->force;
  rig.delay = delay;
  ethd__stress_rig_start(&rig, speed);
  while (ethd__stress_rig_step(&rig)->state != ETHD_BRAKING) ethd__stress_rig_move(&rig);
  int64_t begin = rig.tick;
  double depth = 0, left = speed;
  while (rig.trace.state == ETHD_BRAKING) {
    if (rig.tick - begin >= delay) rig.push.x = s->friction; /* with the motors, out of the wall */
    ethd__stress_rig_move(&rig);
    if (ethd__stress_rig_speed(&rig) > 0)
      depth = ethd__stress_rig_depth(&rig) - rig.gap, left = ethd__stress_rig_speed(&rig);
    ethd__stress_rig_step(&rig);
  }
  stopped o = {(double)(rig.tick - begin) * s->period, rig.trace.eps, depth, left};
  ethd__stress_rig_close(&rig);
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
static void check_least(ethd__stress_log *log, const stop *s, double speed, double late, int delay, const stopped *o) {
  double a = (s->force + s->friction) / s->mass;
  double least = (speed * speed - o->left * o->left) / (2 * a) + speed * (late + delay * s->period);
  if (o->depth > 0)
    ethd__stress_bound(log, "m", least, o->depth + 1e-9, "%s, n = %d: v^2/(2a) + v (T/2 + t_d) <= depth", s->plant,
                       delay);
}

/* Means over speeds about `speed` and instants of contact within a tick: what ticks make of a stop. */
static void compare(ethd__stress_log *log, const stop *s, double speed, int delay) {
  stopped m = {0}, f = {0};
  for (int i = 0; i < 20; i++)
    for (int k = 0; k < 10; k++) {
      double v = speed * (0.95 + 0.1 * (i + 0.5) / 20), late = s->period * (k + 0.5) / 10;
      stopped one = measure(s, v, late, delay, 0), form = smooth(s, v, delay);
      check_least(log, s, v, late, delay, &one);
      m.time += one.time / 200, m.eps += one.eps / 200;
      f.time += form.time / 200, f.eps += form.eps / 200;
    }
  ethd__stress_within(log, "s", m.time, f.time, s->period, "%s, n = %d, %g m/s: Delta_s without ticks", s->plant, delay,
                      speed);
  ethd__stress_within(log, "m", m.eps, f.eps, speed * s->period / 4, "%s, n = %d, %g m/s: eps without ticks", s->plant,
                      delay, speed);
}

static void run(ethd__stress_log *log) {
  static const double speeds[] = {0.05, 0.1, 0.2, 0.4, 0.6, 0.8};
  for (size_t p = 0; p < 2; p++)
    for (size_t i = 0; i < 6; i++) {
      stopped m = measure(&stops[p], speeds[i], 3e-4, 0, 1), f = sampled(&stops[p], speeds[i], 3e-4);
      ethd__stress_within(log, "s", m.time, f.time, 1e-9, "time of braking, tick for tick");
      ethd__stress_near(log, "m", m.eps, f.eps, 1e-4, "eps, tick for tick");
    }
  for (size_t p = 0; p < 2; p++)
    for (int n = 0; n <= 1; n++) {
      if (stops[p].damping > 0.828 * stops[p].mass / stops[p].period && n) continue; /* unstable there */
      for (size_t i = 2; i < 4; i++) compare(log, &stops[p], speeds[i], n);
    }
}

const ethd__stress ethd__stress_stop = {"stop", "braking with saturated motors: time and distance", run};
