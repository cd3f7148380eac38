/* The built-in laws on their own, to the last digit: numbers in, numbers out. */
#include <math.h>
#include <string.h>

#include "ethd/control.h"
#include "unit/rig.h"

/* ---- tracking ---- */

TEST(test_pd) {
  const double p[] = {40, 1, 0};
  double state[64] = {0}, tau[2];
  ethd_tracking_in in = {.eps_q = {0.01, -0.02}, .eps_q_dot = {0.5, 0.25}, .period = 0.001};
  ck_assert_int_eq(ethd_tracking_pd.step(p, state, &in, tau), ETHD_OK);
  ck_assert_double_eq_tol(tau[0], 0.4 + 0.5, 1e-15);
  ck_assert_double_eq_tol(tau[1], -0.8 + 0.25, 1e-15);
}

/* Backward difference of eps_q: 0 at the first tick; a longer step divides by its own length. */
TEST(test_pd_difference) {
  const double p[] = {0, 2, 1};
  double state[64] = {0}, tau[2];
  ethd_tracking_in in = {.eps_q = {0.01, 0.03}, .eps_q_dot = {7, 7}, .period = 0.001};
  (void)!ethd_tracking_pd.step(p, state, &in, tau);
  ck_assert_double_eq(tau[0], 0);
  ck_assert_double_eq(tau[1], 0);
  in.eps_q[0] = 0.0125;
  in.eps_q[1] = 0.0290;
  (void)!ethd_tracking_pd.step(p, state, &in, tau);
  ck_assert_double_eq_tol(tau[0], 2 * 2.5, 1e-12);
  ck_assert_double_eq_tol(tau[1], 2 * -1.0, 1e-12);
  in.eps_q[0] = 0.0225;
  in.period = 0.004;
  (void)!ethd_tracking_pd.step(p, state, &in, tau);
  ck_assert_double_eq_tol(tau[0], 2 * 2.5, 1e-12);
}

/* ---- contact ---- */

typedef struct force_case {
  const ethd_contact_law *law;
  double p[2], gap, speed;
  int entering;
  double force;
} force_case;

static const force_case forces[] = {
    {&ethd_contact_kelvin_voigt, {2500, 45}, 0.001, 1, 1, 0},
    {&ethd_contact_kelvin_voigt, {2500, 45}, 0, 1, 1, 0},
    {&ethd_contact_kelvin_voigt, {2500, 45}, -0.002, 0.1, 1, -5 - 4.5},
    {&ethd_contact_kelvin_voigt, {2500, 45}, -0.002, -0.1, 0, -5},
    {&ethd_contact_kelvin_voigt, {2500, 45}, -0.002, 0, 1, -5},
    {&ethd_contact_spring, {2000}, -0.003, 0.5, 1, -6},
    {&ethd_contact_spring, {2000}, -0.003, -0.5, 0, -6},
    {&ethd_contact_spring, {2000}, 0.003, 0.5, 1, 0},
    {&ethd_contact_hunt_crossley, {1000, 2}, -0.004, 0.25, 1, -4 * 1.5},
    {&ethd_contact_hunt_crossley, {1000, 2}, -0.004, -0.25, 0, -4 * 0.5},
    {&ethd_contact_hunt_crossley, {1000, 2}, 0, 9, 1, 0},
};

TEST_LOOP(test_forces, 0, sizeof forces / sizeof *forces) {
  const force_case *c = &forces[_i];
  double state[64] = {0}, force = 99;
  ck_assert_int_eq(c->law->step(c->p, state, c->gap, c->speed, c->entering, &force), ETHD_OK);
  ck_assert_double_eq_tol(force, c->force, 1e-14);
}

/* ---- transition ---- */

/* d_beta = 4 mm and R_r - R_f = 4.5 mm: a finger at d_fe is at d_fr = d_fe - 4.5 mm. */
static ethd_contact contact_at(double d_re, double v, double d_fe) {
  ethd_contact c;
  memset(&c, 0, sizeof c);
  c.n.x = -1;
  c.d_re = d_re;
  c.v = v;
  c.d_fe = d_fe;
  c.d_fr = d_fe - 0.0045;
  c.d_beta = 0.004;
  c.period = 0.001;
  return c;
}

static ethd_ruling rule(const ethd_transition_law *law, const double *p, void *state, const ethd_contact *c) {
  ethd_ruling r;
  memset(&r, 0, sizeof r);
  r.beta = 1;
  r.argument = c->d_fe;
  if (law->step(p, state, c, &r) != ETHD_OK) ck_abort_msg("step fails");
  return r;
}

TEST(test_abrupt) {
  double state[64] = {0};
  ethd_contact c = contact_at(0, 0.3, -0.001);
  ethd_ruling r = rule(&ethd_transition_abrupt, NULL, state, &c);
  ck_assert(r.beta == 1 && r.share == 0 && r.state == ETHD_TRANSPARENT && r.argument == -0.001);
  c.d_re = -1e-15;
  r = rule(&ethd_transition_abrupt, NULL, state, &c);
  ck_assert(r.beta == 0 && r.share == 1 && r.state == ETHD_VO && r.offset == 0 && r.damping == 0);
}

/* eq. 4: beta_min at and behind the wall, 1 above d_beta, a line between. */
TEST(test_smooth) {
  const double p[] = {0.1}, d[] = {-0.001, 0, 0.001, 0.002, 0.004, 0.0040001, 1};
  const double beta[] = {0.1, 0.1, 0.325, 0.55, 1, 1, 1};
  double state[64] = {0};
  for (int i = 0; i < 7; i++) {
    ethd_contact c = contact_at(i % 2 ? -0.0001 : 0.0001, 0, d[i]);
    ethd_ruling r = rule(&ethd_transition_smooth, p, state, &c);
    ck_assert_double_eq_tol(r.beta, beta[i], 1e-15);
    ck_assert(r.share == 1 && r.offset == 0 && r.damping == 0 && r.argument == d[i]);
    ck_assert_int_eq(r.state, i % 2 ? ETHD_VO : ETHD_TRANSPARENT);
  }
}

/* One tick of VO-B, and what is to come of it. */
typedef struct arrow {
  double d_re, v;
  int state;
  double eps;
} arrow;

#define LAST {NAN, 0, 0, 0}
static const double product[] = {100, 0.020, 0.1, 0.006, 0.050};
static const double paper[] = {100, 0.020, 0.1, INFINITY, INFINITY};

static void walk(const double *p, const arrow *a) {
  double state[64] = {0};
  for (int tick = 0; !isnan(a->d_re); a++, tick++) {
    ethd_contact c = contact_at(a->d_re, a->v, 0.0055);
    ethd_ruling r = rule(&ethd_transition_offset, p, state, &c);
    if (r.state != a->state || r.offset != a->eps)
      ck_abort_msg("tick %d: state %d, not %d; eps %g, not %g", tick, (int)r.state, a->state, r.offset, a->eps);
    ck_assert(r.damping == (a->state == ETHD_BRAKING ? 100 : 0));
    ck_assert(r.share == (a->state == ETHD_VO ? 1 : 0));
    /* beta's argument is d_fe with R_r, 1 mm here, and eps more in vo: a slope of 0.9 over 4 mm */
    ck_assert_double_eq_tol(r.argument, 0.001 + a->eps, 1e-17);
    double beta = 0.1 + 0.9 * (0.001 + a->eps) / 0.004;
    ck_assert_double_eq_tol(r.beta, beta > 1 ? 1 : beta < 0.1 ? 0.1 : beta, 1e-14);
  }
}

static const arrow arrows[][9] = {
    /* in, stop, rest, out: one arrow a tick, although the ring stands still when it enters */
    {{0, 0.4, 0, 0},
     {-1e-9, 0, 1, 0},
     {-0.002, 0.4, 1, 0},
     {-0.0024, 0.0199, 2, 0.0024},
     {-0.0034, 0.5, 2, 0.0024},
     {0.004, -1, 2, 0.0024},
     {0.00401, -1, 0, 0},
     LAST},
    /* v_th is strict, either way */
    {{-0.001, 0.4, 1, 0}, {-0.001, 0.020, 1, 0}, {-0.001, -0.020, 1, 0}, {-0.001, -0.0199, 2, 0.001}, LAST},
    /* pulled back fast: out at once above d_beta, not at it */
    {{-0.001, 0.4, 1, 0}, {0.004, -0.5, 1, 0}, {0.0041, -0.5, 0, 0}, {0.0041, 0, 0, 0}, LAST},
    /* v_th goes first, even far outside: eps < 0 */
    {{-0.001, 0.4, 1, 0}, {0.0051, 0.001, 2, -0.0051}, {0.0051, 0.001, 0, 0}, LAST},
    /* no second braking in vo; after transparent there is one */
    {{-0.001, 0.4, 1, 0},
     {-0.001, 0, 2, 0.001},
     {0.0039, -1, 2, 0.001},
     {-0.009, 1, 2, 0.001},
     {0.0041, -1, 0, 0},
     {-0.001, 1, 1, 0},
     LAST},
    /* a state machine of one arrow per tick: out and in again takes two */
    {{-0.001, 0.4, 1, 0}, {-0.001, 0, 2, 0.001}, {0.0041, -9, 0, 0}, {-0.0001, 9, 1, 0}, {-0.0001, 0, 2, 0.0001}, LAST},
};

TEST_LOOP(test_arrows, 0, sizeof arrows / sizeof *arrows) {
  walk(product, arrows[_i]);
  walk(paper, arrows[_i]);
}

TEST(test_cap_of_depth) {
  const arrow with[] = {{-0.001, 0.4, 1, 0}, {-0.0059, 0.4, 1, 0}, {-0.006, 0.4, 2, 0.006}, LAST};
  const arrow without[] = {{-0.001, 0.4, 1, 0}, {-0.0059, 0.4, 1, 0}, {-0.006, 0.4, 1, 0}, {-0.5, 0.4, 1, 0}, LAST};
  walk(product, with);
  walk(paper, without);
}

/* 50 ticks of 1 ms after the first of braking; out of it above d_beta all the same. */
TEST(test_cap_of_time) {
  for (int out = 0; out < 2; out++) {
    double capped[64] = {0}, paper_like[64] = {0};
    for (int tick = 0; tick <= 200; tick++) {
      ethd_contact c = contact_at(out && tick == 50 ? 0.0041 : -0.001, 0.1, 0.01);
      int state = rule(&ethd_transition_offset, product, capped, &c).state;
      ck_assert_int_eq(state, tick < 50    ? ETHD_BRAKING
                              : !out       ? ETHD_VO
                              : tick == 50 ? ETHD_TRANSPARENT
                              : tick < 101 ? ETHD_BRAKING
                                           : ETHD_VO);
      if (!out) ck_assert_int_eq(rule(&ethd_transition_offset, paper, paper_like, &c).state, ETHD_BRAKING);
    }
  }
}

/* Time counts, not ticks: a step of 10 periods brings the cap nearer by ten. */
TEST(test_cap_of_time_with_missed_ticks) {
  double state[64] = {0};
  ethd_contact c = contact_at(-0.001, 0.1, 0.01);
  (void)rule(&ethd_transition_offset, product, state, &c);
  c.period = 0.010;
  for (int i = 0; i < 4; i++) ck_assert_int_eq(rule(&ethd_transition_offset, product, state, &c).state, ETHD_BRAKING);
  ck_assert_int_eq(rule(&ethd_transition_offset, product, state, &c).state, ETHD_VO);
}

/* Any period, any cap that is a whole number of periods. */
TEST(test_cap_of_time_is_exact) {
  for (int n = 1; n <= 400; n += 7)
    for (int k = 1; k <= 20; k++) {
      double state[64] = {0}, p[] = {100, 0.020, 0.1, INFINITY, n * (k * 1e-4)};
      ethd_contact c = contact_at(-0.001, 0.1, 0.01);
      c.period = k * 1e-4;
      int ticks = 0;
      while (rule(&ethd_transition_offset, p, state, &c).state == ETHD_BRAKING) ticks++;
      ck_assert_int_eq(ticks, n);
    }
}
