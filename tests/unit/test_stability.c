/* The spectral radius of the sampled loop against the closed forms, and against the estimators
   themselves in a loop that is stepped through. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bounds/loops.h"
#include "bounds/motion.h"
#include "unit/suite.h"

#define M 0.3
#define T 0.001
#define LINK 0.25

static ethd__sampled_loop loop_of(ethd_velocity_method method, double stiffness, double damping) {
  ethd__sampled_loop l = {
      .mass = M, .period = T, .stiffness = stiffness, .damping = damping, .method = method, .link = LINK};
  const ethd_method *m = &ethd_velocity_methods[method];
  ethd_params_default(m->params, m->param_count, l.p);
  return l;
}

static void check_near(double value, double expected, double share, const char *what) {
  ck_assert_msg(fabs(value - expected) <= share * fabs(expected), "%s: %.10g, not %.10g", what, value, expected);
}

/* The boundary for the backward difference and n whole ticks of delay, in closed form, 0 < th <= pi / (2 (n + 1)). */
static void boundary(int n, double th, double *stiffness, double *damping) {
  double t = tan(th / 2), k = 4 * t * t * cos((n + 1) * th);
  *stiffness = k * M / (T * T);
  *damping = (2 * t * sin((n + 1) * th) - k / 2) * M / T;
}

/* The curve's own points: a gain over it is unstable, under it stable, within 0.5 %. */
TEST(test_boundary) {
  for (int n = 0; n <= 4; n++)
    for (int i = 1; i < 16; i++) {
      double k, b;
      boundary(n, M_PI / (2 * (n + 1)) * i / 16, &k, &b);
      ethd__sampled_loop l = loop_of(ETHD_VELOCITY_DIFFERENCE, k, b);
      l.delay = n;
      check_near(ethd__sampled_radius(&l), 1, 1e-6, "radius on the curve");
      check_near(ethd__sampled_stiffness_max(&l), k, 5e-3, "largest K");
      if (i >= 4) check_near(ethd__sampled_mass_min(&l), M, 5e-3, "smallest mass"); /* below it hardly matters */
    }
}

/* Largest K of the page: 0.686, 0.1445, 0.0624 m/T^2; largest B of a free ring: 2, 0.828, 0.536 m/T. */
TEST(test_published_numbers) {
  static const double largest_k[] = {0.686, 0.1445, 0.0624}, largest_b[] = {2, 0.828, 0.536};
  for (int n = 0; n < 3; n++) {
    double most = 0;
    for (int i = 1; i <= 1000; i++) {
      double k, b;
      boundary(n, M_PI / (2 * (n + 1)) * i / 1000, &k, &b);
      most = fmax(most, k);
    }
    check_near(most * T * T / M, largest_k[n], 2e-3, "largest K");
    const double free = 2 * M / T * tan(M_PI / (4 * (n + 1)));
    check_near(free, largest_b[n] * M / T, 1e-3, "largest B");
    ethd__sampled_loop l = loop_of(ETHD_VELOCITY_DIFFERENCE, 0, 1);
    l.delay = n;
    check_near(ethd__sampled_damping_max(&l), free, 1e-3, "largest B of the loop");
  }
  ethd__sampled_loop l = loop_of(ETHD_VELOCITY_LSQ, 0, 100); /* a 15 ms window: unstable under 0.4 kg */
  l.p[0] = 16;
  check_near(ethd__sampled_mass_min(&l), 0.4, 0.03, "smallest mass with a window of 15 ms");
}

/* Small gains: K = B / (T (n + 1/2)), whatever the estimator. */
TEST(test_small_gains) {
  for (int method = 0; method < ETHD_VELOCITY_COUNT; method++)
    for (int n = 0; n < 3; n++) {
      ethd__sampled_loop l = loop_of((ethd_velocity_method)method, 1, 0.02);
      l.delay = n;
      check_near(ethd__sampled_stiffness_max(&l), 0.02 / (T * (n + 0.5)), 0.02, ethd_velocity_methods[method].id);
    }
}

TEST(test_trivial_loops) {
  ethd__sampled_loop l = loop_of(ETHD_VELOCITY_DIFFERENCE, 0, 0);
  check_near(ethd__sampled_radius(&l), 1, 1e-6, "a free mass");
  l.stiffness = 1000;
  ck_assert(!ethd__sampled_stable(&l) && isinf(ethd__sampled_mass_min(&l)));
  check_near(ethd__sampled_damping_needed(&l), 0.5, 1e-12, "damping that the hold takes");
  l.damping = 45;
  check_near(ethd__sampled_passive_friction(&l), 45.5, 1e-12, "passivity");
}

/* ---- the estimators themselves ---- */

/* The growth of the motion over `ticks`, the estimator stepped as a controller steps it. */
static double growth(const ethd__sampled_loop *l, int ticks) {
  ethd_velocity velocity;
  ethd_velocity_state state;
  ethd_error error;
  ck_assert_int_eq(ethd_velocity_prepare(l->method, l->p, l->period, &velocity, &error), ETHD_OK);
  memset(&state, 0, sizeof state);
  double x = 0, v = 0, torque = 0, way[ETHD_LOOP_DELAY_MAX] = {0}, last = 0, before = 0, after = 0;
  for (int k = 0; k < 3000 + ticks; k++) {
    if (k == 2000) v = 1e-3; /* a Kalman filter's gains have settled */
    double speed = LINK * ethd_velocity_step(&velocity, &state, x / LINK, torque, l->period);
    double f = -l->stiffness * x - l->damping * speed, applied = l->delay ? way[k % l->delay] : f;
    if (l->delay) way[k % l->delay] = f;
    torque = f * LINK;
    double spans[2] = {l->late, l->period - l->late}, forces[2] = {last, applied};
    for (int i = 0; i < 2; i++) {
      x += spans[i] * v + spans[i] * spans[i] / (2 * l->mass) * forces[i];
      v += spans[i] / l->mass * forces[i];
    }
    last = applied;
    double size = fabs(v) + fabs(l->stiffness * x) * l->period / l->mass;
    if (k >= 2900 && k < 3000) before = fmax(before, size);
    if (k >= 2900 + ticks) after = fmax(after, size);
  }
  return after / before;
}

/* Just over the largest stable damping the motion grows, just under it it dies. foaw stands at its
   longest window only while samples lie on a line, so its loop is the least squares'. */
static void check_estimators(double late) {
  static const ethd_velocity_method methods[] = {ETHD_VELOCITY_LOWPASS, ETHD_VELOCITY_DIFFERENCE, ETHD_VELOCITY_LSQ,
                                                 ETHD_VELOCITY_KALMAN};
  for (size_t i = 0; i < sizeof methods / sizeof *methods; i++)
    for (int n = 0; n < 3; n++)
      for (double k = 0; k < 3000; k += 1000) {
        ethd__sampled_loop l = loop_of(methods[i], k, 10);
        const char *id = ethd_velocity_methods[methods[i]].id;
        if (methods[i] == ETHD_VELOCITY_KALMAN) l.p[2] = 0.8 * M * LINK * LINK; /* not quite the true inertia */
        l.delay = n;
        l.late = late;
        double largest = ethd__sampled_damping_max(&l);
        ck_assert_msg(largest > 0, "%s: no damping is stable", id);
        l.damping = 1.01 * largest;
        ck_assert_msg(growth(&l, 2000) > 1.5, "%s, %d ticks, K %g: %.6g dies", id, n, k, l.damping);
        l.damping = 0.99 * largest;
        ck_assert_msg(growth(&l, 2000) < 0.7, "%s, %d ticks, K %g: %.6g grows", id, n, k, l.damping);
      }
  ethd__sampled_loop foaw = loop_of(ETHD_VELOCITY_FOAW, 1000, 10), lsq = loop_of(ETHD_VELOCITY_LSQ, 1000, 10);
  lsq.p[0] = foaw.p[0];
  ck_assert(ethd__sampled_radius(&foaw) == ethd__sampled_radius(&lsq));
}

TEST(test_estimators) { check_estimators(0); }

TEST(test_late_forces) { check_estimators(0.3 * T); }

/* What is late by nearly a tick is a tick of delay; in between it is neither. */
TEST(test_late_is_between) {
  ethd__sampled_loop l = loop_of(ETHD_VELOCITY_LOWPASS, 2000, 40);
  double prompt = ethd__sampled_damping_max(&l);
  l.late = T / 2;
  double half = ethd__sampled_damping_max(&l);
  l.late = T * (1 - 1e-9);
  double nearly = ethd__sampled_damping_max(&l);
  l.late = 0;
  l.delay = 1;
  check_near(nearly, ethd__sampled_damping_max(&l), 1e-5, "a tick of delay");
  ck_assert(half < 0.95 * prompt && half > 1.05 * nearly);
  l.late = 0.25 * T;
  l.damping = ethd__sampled_damping_needed(&l);
  check_near(l.damping, 2000 * T * 1.75, 1e-12, "damping that hold and delay take");
  l.mass = 10;
  l.damping *= 1.01;
  ck_assert(ethd__sampled_stable(&l));
  l.damping *= 0.98;
  ck_assert(!ethd__sampled_stable(&l));
}

/* Just within what they say it is stable, just beyond it isn't. */
TEST(test_ends) {
  ethd__sampled_loop l = loop_of(ETHD_VELOCITY_LOWPASS, 2500, 45);
  double delay = ethd__sampled_delay_max(&l), cutoff = ethd__sampled_velocity_end(&l);
  ck_assert(delay > T && delay < 20 * T && cutoff > 1 && cutoff < l.p[0]);
  l.p[0] = 0.999 * cutoff;
  ck_assert(!ethd__sampled_stable(&l));
  l.p[0] = 1.001 * cutoff;
  ck_assert(ethd__sampled_stable(&l));
  l = loop_of(ETHD_VELOCITY_LOWPASS, 2500, 45);
  for (int i = -1; i <= 1; i += 2) {
    double d = delay * (1 + 1e-4 * i);
    l.delay = (int)(d / T);
    l.late = d - l.delay * T;
    ck_assert(ethd__sampled_stable(&l) == (i < 0));
  }
  l = loop_of(ETHD_VELOCITY_LSQ, 0, 100);
  l.mass = 0.1;
  l.p[0] = 2;
  double window = ethd__sampled_velocity_end(&l);
  l.p[0] = window;
  ck_assert(window >= 2 && ethd__sampled_stable(&l));
  l.p[0]++;
  ck_assert(!ethd__sampled_stable(&l));
  ck_assert(isnan(ethd__sampled_velocity_end(&l)));
  l = loop_of(ETHD_VELOCITY_DIFFERENCE, 1000, 0);
  ck_assert(ethd__sampled_delay_max(&l) < 0 && isnan(ethd__sampled_velocity_end(&l)));
}

/* ---- the motion of a tick ---- */

/* A mass with friction c under a force f: v = f/c + (v0 - f/c) e^(-c t/m). */
TEST(test_motion_with_friction) {
  for (double span = 1e-5; span < 2; span *= 10) {
    ethd__sampled_loop l = {.mass = 0.3, .viscous = 2.5};
    ethd__bounds_motion motion;
    double s[ETHD_MOTION_STATE] = {0.1, 0.7}, f = 1.5, end = f / l.viscous, fade = exp(-l.viscous * span / l.mass);
    ethd__bounds_motion_over(&l, span, &motion);
    ethd__bounds_motion_apply(&motion, f, s);
    check_near(s[ETHD_MOTION_V], end + (0.7 - end) * fade, 1e-12, "speed");
    check_near(s[ETHD_MOTION_X], 0.1 + end * span + (0.7 - end) * (1 - fade) * l.mass / l.viscous, 1e-12, "place");
  }
}

/* Two masses without friction: the centre of mass follows the force, the lead swings about where the force holds it,
   with the reduced mass mu. */
static void check_two_masses(double spring, double damper, double span) {
  ethd__sampled_loop l = {.mass = 0.095, .motor_mass = 0.013, .spring = spring, .damper = damper};
  ethd__bounds_motion motion;
  double other = l.mass - l.motor_mass, mu = l.motor_mass * other / l.mass, f = 2;
  double rest = -f * other / (l.mass * spring), a = damper / (2 * mu), w = sqrt(spring / mu - a * a);
  double s[ETHD_MOTION_STATE] = {0, 0.4, 1e-3, -0.2}, r = s[2] - rest, v = s[3], h = span;
  double centre = s[0] + other / l.mass * s[2], centre_v = s[1] + other / l.mass * s[3];
  ethd__bounds_motion_over(&l, span, &motion);
  ethd__bounds_motion_apply(&motion, f, s);
  double lead = rest + exp(-a * h) * (r * cos(w * h) + (v + a * r) / w * sin(w * h));
  ck_assert_double_eq_tol(s[ETHD_MOTION_LEAD], lead, 1e-12);
  ck_assert_double_eq_tol(s[0] + other / l.mass * s[2], centre + centre_v * h + f * h * h / (2 * l.mass), 1e-12);
  ck_assert_double_eq_tol(s[1] + other / l.mass * s[3], centre_v + f * h / l.mass, 1e-12);
}

TEST(test_motion_of_two_masses) {
  for (double span = 1e-4; span < 0.02; span *= 2) {
    check_two_masses(3489.6, 5.132, span);
    check_two_masses(2e5, 0.5, span);
    check_two_masses(50, 0, span);
  }
}

/* ---- friction ---- */

/* A spring without a damper lacks what hold and delay take. */
TEST(test_viscous_needed) {
  for (int n = 0; n < 4; n++) {
    ethd__sampled_loop l = loop_of(ETHD_VELOCITY_DIFFERENCE, 500, 0);
    l.delay = n;
    check_near(ethd__sampled_viscous_needed(&l), ethd__sampled_damping_needed(&l), 5e-3, "friction needed");
  }
  ethd__sampled_loop stable = loop_of(ETHD_VELOCITY_DIFFERENCE, 1000, 45);
  ck_assert(ethd__sampled_viscous_needed(&stable) == 0);
  ck_assert(isinf(ethd__sampled_held(1, 0.2, 1.5)));
  check_near(ethd__sampled_held(11, 0.2, 1), 4 * 0.2 / (M_PI * 10), 1e-12, "swing that is held");
}

/* A count's kick by hand: F = (K + B/T) delta at once, m dv = F T. */
TEST(test_kick) {
  ethd__sampled_loop l = loop_of(ETHD_VELOCITY_DIFFERENCE, 2500, 45);
  check_near(ethd__sampled_kick(&l, 40e-6), (2500 + 45 / T) * 40e-6 * T / M, 1e-12, "kick");
  l.motor_mass = 0.01;
  l.spring = 1e4;
  check_near(ethd__sampled_kick(&l, 40e-6), (2500 + 45 / T) * 40e-6 * T / 0.01, 1e-12, "kick of the motor's side");
}

/* ---- margins: what a search keeps and what the rows say ---- */

static void check_margins(const ethd__sampled_loop *l, int *kept) {
  const ethd__bounds_margin margin = {1.5, 0.4e-3};
  ethd__bounds_row rows[ETHD_LOOP_NUMBERS];
  bool keeps = ethd__bounds_keeps(l, &margin), rows_keep = ethd__sampled_stable(l);
  int n = ethd__bounds_rows(l, rows);
  for (int i = 0; i < n; i++) {
    if (rows[i].number == ETHD_LOOP_STIFFNESS || rows[i].number == ETHD_LOOP_DAMPING)
      rows_keep &= rows[i].margin >= margin.gain;
    if (rows[i].number == ETHD_LOOP_DELAY) rows_keep &= rows[i].end - rows[i].value >= margin.delay;
  }
  ck_assert_msg(!keeps || rows_keep, "K %g, B %g is kept, and its rows are thinner", l->stiffness, l->damping);
  if (keeps == rows_keep) ++*kept;
}

/* They may differ where both gains at once are asked for, which no row says. */
TEST(test_margins_agree) {
  int agreed = 0, all = 0;
  for (int soft = 0; soft < 2; soft++)
    for (double k = 100; k < 2e4; k *= 2)
      for (double b = 1; b < 200; b *= 1.7, all++) {
        ethd__sampled_loop l = loop_of(ETHD_VELOCITY_LOWPASS, k, b);
        l.mass = 0.095;
        if (soft) l.motor_mass = 0.0132, l.spring = 3490, l.damper = 5.13;
        ethd__sampled_set_delay(&l, 0.12e-3);
        check_margins(&l, &agreed);
      }
  ck_assert_int_ge(agreed, 9 * all / 10);
}
