/* The loop with which predictive brakes and holds the ring before the wall. Which rates, memories, delays and errors of
   the told mass are stable is compared with the loop's linear recursion, and how fast it settles with a closed form.

   On the curve's line the law asks for  a = rate (rate d - v) - rate v - w  of what its observer says. With the right
   mass and no delay the observer's poles (three at b) and the ring's part, and with q = rate T these are the roots of

     z^2 - (2 - 2q - q^2/2) z + 1 - 2q + q^2/2 = 0     real, and within the unit circle for q < 1;
     the law keeps q <= 1/2 */
#include <math.h>

#include "stress/mass.h"

#define PERIOD 0.001
#define MASS 0.1173
#define SPEED 0.1        /* m/s at which the ring comes */
#define SWING_TICKS 10   /* window of a swing's largest step */
#define RESOLUTION 1e-12 /* m: of a joint angle on long links */

typedef struct hold_case {
  double q, b;  /* rate T, memory */
  double share; /* told mass / mass */
  int delay;    /* ticks */
} hold_case;

/* Through the whole step. The finger goes with the ring and never leans on it. */
static double measured_growth(const hold_case *c) {
  mass_rig r;
  mass_open(&r, MASS, 0.01);
  ethd_setup_transition(&r.on.setup, &ethd_transition_predictive);
  r.on.setup.arm.link1 = MASS_STRAIGHT;
  r.on.setup.dynamics.mass[0] = r.on.setup.dynamics.mass[1] = c->share * MASS;
  r.on.setup.limits.torque = 1e6;
  rig_set(&r.on.setup, "transition.rate", c->q / PERIOD);
  rig_set(&r.on.setup, "transition.memory", c->b);
  rig_set(&r.on.setup, "transition.t_max", (double)INFINITY);
  r.measured = true;
  r.has_finger = true;
  r.delay = c->delay;
  mass_start(&r, SPEED);
  r.finger_v = (ethd_vec){-SPEED, 0};
  const int settle = (int)(10 / c->q + 20 / (1 - c->b)), span = (int)(5 / c->q + 10 / (1 - c->b));
  double first = 0, last = 0;
  int k = 0;
  for (int waited = 0; k < settle + span && waited < 2000; waited++) {
    ethd_pose pose;
    ethd_arm_pose(&r.on.setup.arm, r.q, &pose);
    r.finger = pose.x;
    double before = mass_depth(&r);
    mass_tick(&r);
    double step = fabs(mass_depth(&r) - before);
    if (r.on.trace.state != ETHD_BRAKING && k == 0) continue;
    if (r.on.trace.state != ETHD_BRAKING || !(step < 0.01)) break; /* thrown out */
    k++;
    if (k > settle - SWING_TICKS && k <= settle) first = fmax(first, step);
    if (k > settle + span - SWING_TICKS) last = fmax(last, step);
  }
  mass_close(&r);
  if (k < settle + span) return (double)INFINITY;
  return last < RESOLUTION ? -(double)INFINITY : log(last / first) / span;
}

/* The same by the recursion alone: the ring's d and v, the observer's, and the accelerations that are still to come. */
static double linear_growth(const hold_case *c) {
  const double T = PERIOD, rate = c->q / T, g = 1 - c->b;
  double d = 1e-3, v = 0, D = 1e-3, V = 0, W = 0, told = 0, late[MASS_DELAY_MAX] = {0}, first = 0, last = 0;
  enum { SETTLE = 200, SPAN = 400 };
  for (int k = 0; k < SETTLE + SPAN; k++) {
    double model = told + W;
    D -= V * T + model * T * T / 2;
    V += model * T;
    double e = d - D;
    D += (1 - c->b * c->b * c->b) * e;
    V -= 1.5 * (1 - c->b * c->b) * g * e / T;
    W -= g * g * g * e / (T * T);
    told = rate * (rate * D - 2 * V) - W;
    double now = told * c->share;
    if (c->delay) {
      now = late[k % c->delay];
      late[k % c->delay] = told * c->share;
    }
    d -= v * T + now * T * T / 2;
    v += now * T;
    double size = hypot(d, v * T);
    if (!(size < 1e100)) return (double)INFINITY;
    if (k >= SETTLE - 50 && k < SETTLE) first = fmax(first, size);
    if (k >= SETTLE + SPAN - 50) last = fmax(last, size);
    if (last == 0 && k == SETTLE + SPAN - 1) return -(double)INFINITY;
  }
  return log(last / first) / SPAN;
}

/* The slower root. */
static double closed_growth(double q) { return log((2 - 2 * q - q * q / 2 + q * sqrt(q * q / 4 + 2 * q)) / 2); }

static void settles(void) {
  static const double qs[] = {0.05, 0.1, 0.2};
  for (int i = 0; i < 3; i++) {
    hold_case c = {qs[i], 0.3, 1, 0};
    near(linear_growth(&c), closed_growth(qs[i]), 1e-2, "recursion: growth a tick");
    if (i < 2) near(measured_growth(&c), closed_growth(qs[i]), 3e-2, "law: growth a tick");
  }
}

#define DOUBTFUL 0.05 /* growth a tick within which a cell isn't judged */

TEST(test_hold) {
  int cells = (int)pick(6, 24);
  int64_t judged = 0, wrong = 0;
  static const double memories[] = {0.3, 0.6, 0.9};
  settles();
  for (int n = 0; n <= 2; n++)
    for (int m = 0; m < 3; m++)
      for (int i = 0; i < cells; i++)
        for (int j = 0; j < cells; j++) {
          hold_case c = {0.05 + 0.45 * i / (cells - 1), memories[m], 0.5 + 1.5 * j / (cells - 1), n};
          double is = measured_growth(&c), linear = linear_growth(&c);
          if (fabs(linear) < DOUBTFUL) continue;
          judged++;
          wrong += (is < -DOUBTFUL / 2) != (linear < 0); /* thrown out of the linear range it swings on */
        }
  ck_assert_int_ge(judged, 150);
  within((double)wrong, 0, 0, "cells on the recursion's wrong side");
  hold_case usual = {0.5, 0.9, 1, 0};
  bound(linear_growth(&usual), -0.05, "the default rate and memory: growth a tick");
  for (int n = 0; n < 2; n++) {
    hold_case off = {0.5, 0.9, 1.3, n};
    bound(linear_growth(&off), 0, "told 30 %% too much mass, %d ticks of delay: growth", n);
  }
}
