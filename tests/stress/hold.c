/* The loop with which predictive brakes and holds the ring before the wall. Which rates, memories, delays and errors of
   the told mass are stable is compared with the loop's linear recursion, and how fast it settles with a closed form.

   On the curve's line the law asks for  a = rate (rate d - v) - rate v - w  of what its observer says. With the right
   mass and no delay the observer's poles (three at b) and the ring's part, and with q = rate T these are the roots of

     z^2 - (2 - 2q - q^2/2) z + 1 - 2q + q^2/2 = 0     real, and within the unit circle for q < 1;
     the law keeps q <= 1/2 */
#include <math.h>

#include "stress/rig.h"
#include "stress/stress.h"

#define PERIOD 0.001
#define MASS 0.1173
#define SPEED 0.1        /* m/s at which the ring comes */
#define SWING_TICKS 10   /* in which a swing has its largest step */
#define RESOLUTION 1e-12 /* m: of a joint angle on long links */

typedef struct hold_case {
  double q, b;  /* rate T, memory */
  double share; /* told mass / mass */
  int delay;    /* ticks */
} hold_case;

/* Through the whole step. The finger goes with the ring and never leans on it. */
static double measured_growth(const hold_case *c) {
  ethd__stress_rig rig;
  ethd__stress_rig_open(&rig, MASS, 0.01);
  ethd_setup_transition(&rig.setup, &ethd_transition_predictive);
  rig.setup.arm.link1 = ETHD__STRESS_RIG_STRAIGHT;
  rig.setup.dynamics.mass[0] = rig.setup.dynamics.mass[1] = c->share * MASS;
  rig.setup.limits.torque = 1e6;
  ethd__stress_set(&rig.setup, "transition.rate", c->q / PERIOD);
  ethd__stress_set(&rig.setup, "transition.memory", c->b);
  ethd__stress_set(&rig.setup, "transition.t_max", (double)INFINITY);
  rig.measured = true;
  rig.has_finger = true;
  rig.delay = c->delay;
  ethd__stress_rig_start(&rig, SPEED);
  rig.finger_v = (ethd_vec){-SPEED, 0};
  const int settle = (int)(10 / c->q + 20 / (1 - c->b)), span = (int)(5 / c->q + 10 / (1 - c->b));
  double first = 0, last = 0;
  int k = 0;
  for (int waited = 0; k < settle + span && waited < 2000; waited++) {
    ethd_pose pose;
    ethd_arm_pose(&rig.setup.arm, rig.q, &pose);
    rig.finger = pose.x;
    double before = ethd__stress_rig_depth(&rig);
    ethd__stress_rig_tick(&rig);
    double step = fabs(ethd__stress_rig_depth(&rig) - before);
    if (rig.trace.state != ETHD_BRAKING && k == 0) continue;
    if (rig.trace.state != ETHD_BRAKING || !(step < 0.01)) break; /* thrown out */
    k++;
    if (k > settle - SWING_TICKS && k <= settle) first = fmax(first, step);
    if (k > settle + span - SWING_TICKS) last = fmax(last, step);
  }
  ethd__stress_rig_close(&rig);
  if (k < settle + span) return (double)INFINITY;
  return last < RESOLUTION ? -(double)INFINITY : log(last / first) / span;
}

/* The same by the recursion alone: the ring's d and v, the observer's, and the accelerations that are still to come. */
static double linear_growth(const hold_case *c) {
  const double T = PERIOD, rate = c->q / T, g = 1 - c->b;
  double d = 1e-3, v = 0, D = 1e-3, V = 0, W = 0, told = 0, late[ETHD__STRESS_RIG_DELAY_MAX] = {0}, first = 0, last = 0;
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

static void settles(ethd__stress_log *results) {
  static const double qs[] = {0.05, 0.1, 0.2};
  for (int i = 0; i < 3; i++) {
    hold_case c = {qs[i], 0.3, 1, 0};
    ethd__stress_near(results, "1", linear_growth(&c), closed_growth(qs[i]), 1e-2, "recursion: growth a tick");
    if (i < 2) ethd__stress_near(results, "1", measured_growth(&c), closed_growth(qs[i]), 3e-2, "law: growth a tick");
  }
}

#define DOUBTFUL 0.05 /* growth a tick within which a cell isn't judged */

static void run(ethd__stress_log *results) {
  int cells = (int)ethd__stress_pick(results, 6, 12, 24);
  int64_t judged = 0, wrong = 0;
  FILE *data =
      ethd__stress_data(results, "hold.csv", "delay_ticks,memory,rate_t,told_mass,growth_per_tick,linear_growth");
  static const double memories[] = {0.3, 0.6, 0.9};
  settles(results);
  for (int n = 0; n <= 2; n++)
    for (int m = 0; m < 3; m++)
      for (int i = 0; i < cells; i++)
        for (int j = 0; j < cells; j++) {
          hold_case c = {0.05 + 0.45 * i / (cells - 1), memories[m], 0.5 + 1.5 * j / (cells - 1), n};
          double is = measured_growth(&c), linear = linear_growth(&c);
          if (data)
            fprintf(data, "%d,%g,%.17g,%.17g,%.17g,%.17g\n", n, c.b, c.q, c.share, fmax(fmin(is, 10), -10),
                    fmax(fmin(linear, 10), -10));
          if (fabs(linear) < DOUBTFUL) continue;
          judged++;
          wrong += (is < -DOUBTFUL / 2) != (linear < 0); /* thrown out of the linear range it swings on */
        }
  ethd__stress_within(results, "cells", (double)wrong, 0, 0, "cells on the recursion's wrong side");
  ethd__stress_note(results, "%lld cells of rate, memory, delay and told mass", (long long)judged);
  hold_case usual = {0.5, 0.9, 1, 0};
  ethd__stress_bound(results, "1", linear_growth(&usual), -0.05, "the default rate and memory: growth a tick");
  for (int n = 0; n < 2; n++) {
    hold_case off = {0.5, 0.9, 1.3, n};
    ethd__stress_bound(results, "1", linear_growth(&off), 0, "told 30 %% too much mass, %d ticks of delay: growth", n);
  }
  ethd__stress_close(data);
}

const ethd__stress ethd__stress_hold = {"hold", "the loop that holds the ring before the wall", run};
