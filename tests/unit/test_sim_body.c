/* The plant's motion against energy and itself at other steps, for both mechanisms, coupled or not,
   rigid or compliant. A whole tap against SciPy, with friction, damping, hand and pad: tests/simulator.py. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "sim/body.h"
#include "unit/draw.h"
#include "unit/suite.h"

#define PI 3.14159265358979323846
#define CELL 50e-6

/* No friction, no damping, no limit; the hand far from the ring. */
static ethd_sim_def quiet(void) {
  ethd_sim_def def = {.plant = {.mass = {0.12, 0.25},
                                .force_limit = 100,
                                .stiffness = INFINITY,
                                .finger_mass = 0.07,
                                .hand_stiffness = 280,
                                .pad_stiffness = 27000},
                      .arm = {ETHD_ARM_PARALLEL, 0.25, 0.25},
                      .ring_radius = 0.012,
                      .period = 1e-3,
                      .step = CELL,
                      .tolerance = 1e-10};
  return def;
}

typedef struct world {
  ethd__body body;
  ethd__sim_state state;
  ethd__piece hand; /* held at hand.a */
  double t;
} world;

/* Links at these joint angles, everything at rest, finger and hand at the ring's centre + (ahead, 0). */
static void put(const ethd_sim_def *def, double q1, double q2, double ahead, world *out) {
  const double q[2] = {q1, q2};
  ethd_vec x, v;
  memset(out, 0, sizeof *out);
  ethd__body_prepare(def, 0.0075, &out->body);
  ethd__body_place(&out->body, q, &out->state);
  ethd__body_refer(&out->body, &out->state);
  ethd__body_ring(&out->body, &out->state, &x, &v);
  out->hand = (ethd__piece){.begin = -INFINITY, .end = INFINITY, .a = {x.x + ahead, x.y}};
  out->state.q[2] = out->hand.a.x;
  out->state.q[3] = out->hand.a.y;
  out->state.touch = ethd__body_touch(&out->body, &out->state);
}

static void run(world *w, double duration, double cell) {
  int n = (int)floor(duration / cell + 0.5);
  for (int i = 0; i < n; i++) {
    if (i % 20 == 0) ethd__body_refer(&w->body, &w->state);
    ethd__body_advance(&w->body, &w->hand, w->t, cell, &w->state);
    w->t += cell;
  }
}

static double square(double x) { return x * x; }

/* Returns the kinetic energy plus that of pad, hand and transmission, J. */
static double energy(const world *w) {
  const ethd__body *b = &w->body;
  const double *q = w->state.q, *v = w->state.v;
  double p, force;
  ethd__body_pad(b, &w->state, &p, &force);
  double twice = b->inertia[0] * square(v[0]) + b->inertia[1] * square(v[1]) +
                 2 * b->coupling * cos(q[1] - q[0]) * v[0] * v[1] + b->finger_mass * (square(v[2]) + square(v[3])) +
                 b->hand_stiffness * (square(w->hand.a.x - q[2]) + square(w->hand.a.y - q[3])) +
                 b->pad_stiffness * square(fmax(0, p));
  for (int j = 0; j < 2 && b->compliant; j++) {
    double angle = q[j] - (j && b->serial ? q[0] : 0);
    twice += b->motor_inertia[j] * square(v[4 + j]) + b->stiffness[j] * square(q[4 + j] - angle);
  }
  return twice / 2;
}

/* ---- both links ---- */

/* Nothing is lost: coupled links, either mechanism, rigid or not, the finger knocking about in the ring. */
TEST_LOOP(test_energy, 0, 8) {
  ethd_sim_def def = quiet();
  def.arm.mechanism = (ethd_mechanism)(_i & 1);
  def.plant.coupling = _i & 2 ? 0.006 : 0;
  if (_i & 4) {
    def.plant.stiffness = 3500;
    def.plant.motor_mass = 0.015;
  }
  world w;
  put(&def, 1.3, _i & 1 ? -1.2 : 0.1, 0.002, &w);
  w.state.v[0] = 1.1;
  w.state.v[1] = -0.7;
  w.state.v[2] = 0.5;
  w.state.v[3] = -0.3;
  double before = energy(&w), most = 0;
  int touches = 0;
  for (int i = 0; i < 400; i++) {
    ethd__touch was = w.state.touch;
    run(&w, 20 * CELL, CELL / 2);
    double now = energy(&w);
    most = fmax(most, fabs(now - before) / before);
    touches += was != w.state.touch;
  }
  ck_assert_double_le(most, 1e-7);
  ck_assert_int_gt(touches, 5);
}

/* The same torques on the links move either mechanism's ring alike: serial tau1 = g1 + g2, tau2 = g2. */
TEST(test_mechanisms) {
  ethd_sim_def def = quiet();
  world w[2];
  def.plant.coupling = 0.004;
  put(&def, 1.4, 0.1, 0.003, &w[0]);
  def.arm.mechanism = ETHD_ARM_SERIAL;
  put(&def, 1.4, 0.1 - 1.4, 0.003, &w[1]);
  for (int i = 0; i < 100; i++) {
    double g[2] = {draw((uint64_t)(2 * i), -1, 1), draw((uint64_t)(2 * i + 1), -1, 1)};
    w[0].body.torque[0] = g[0];
    w[1].body.torque[0] = g[0] + g[1];
    w[0].body.torque[1] = w[1].body.torque[1] = g[1];
    ethd_vec x[2], v[2];
    for (int k = 0; k < 2; k++) {
      run(&w[k], 1e-3, CELL);
      ethd__body_ring(&w[k].body, &w[k].state, &x[k], &v[k]);
    }
    ck_assert_double_eq_tol(x[0].x, x[1].x, 1e-11);
    ck_assert_double_eq_tol(x[0].y, x[1].y, 1e-11);
    ck_assert_double_eq_tol(w[0].state.q[2], w[1].state.q[2], 1e-11);
  }
  ck_assert_double_gt(fabs(w[0].state.q[2] - w[0].hand.a.x), 1e-4); /* they touched */
}

/* ---- transmission ---- */

/* A stiff transmission is as good as none. */
TEST(test_stiff_transmission) {
  ethd_sim_def def = quiet();
  def.plant.viscous = 1;
  world w[2];
  put(&def, PI / 2, 0, 0.002, &w[0]);
  def.plant.motor_mass = 0.03;
  def.plant.stiffness = 2e6;
  def.plant.damping = 300;
  put(&def, PI / 2, 0, 0.002, &w[1]);
  for (int k = 0; k < 2; k++) {
    w[k].body.torque[0] = -0.3;
    w[k].body.torque[1] = 0.2;
    run(&w[k], 0.05, CELL / 5);
  }
  for (int i = 0; i < 4; i++) ck_assert_double_eq_tol(w[0].state.q[i], w[1].state.q[i], 2e-5);
  ck_assert_double_gt(PI / 2 - w[0].state.q[0], 0.01);
}

/* ---- order ---- */

/* Where everything is after `duration` of knocking about under changing torque. */
static world knock(const ethd_sim_def *def, uint64_t n, double cell, int *touches) {
  world w;
  put(def, PI / 2 + draw(9 * n, -0.1, 0.1), draw(9 * n + 1, -0.1, 0.1), draw(9 * n + 2, 0, 0.004), &w);
  w.state.v[2] = draw(9 * n + 3, -0.6, 0.6);
  w.state.v[3] = draw(9 * n + 4, -0.6, 0.6);
  w.body.torque[0] = draw(9 * n + 5, -0.4, 0.4);
  w.body.torque[1] = draw(9 * n + 6, -0.4, 0.4);
  for (int i = 0; i < 50; i++) {
    ethd__touch was = w.state.touch;
    run(&w, 1e-3, cell);
    *touches += was != w.state.touch;
  }
  return w;
}

/* Halving the longest step cuts the error 14 times at least, or there is none left: through contacts,
   friction that turns, both mechanisms, rigid and compliant; rms over runs. */
TEST_LOOP(test_order, 0, 4) {
  enum { RUNS = 24, STEPS = 4 };
  ethd_sim_def def = quiet();
  def.arm.mechanism = (ethd_mechanism)(_i & 1);
  def.tolerance = INFINITY; /* fixed steps */
  def.plant.friction = 0.2;
  def.plant.viscous = 0.5;
  def.plant.hand_damping = 3;
  def.plant.pad_damping = 1;
  def.plant.coupling = 0.003;
  if (_i & 2) {
    def.plant.stiffness = 3500;
    def.plant.damping = 5;
    def.plant.motor_mass = 0.02;
  }
  double square[STEPS] = {0};
  int touches = 0;
  for (uint64_t n = 0; n < RUNS; n++) {
    world best = knock(&def, n, 3.125e-6, &touches);
    for (int k = 0; k < STEPS; k++) {
      world w = knock(&def, n, 100e-6 / (1 << k), &touches);
      for (int i = 0; i < 2; i++) {
        square[k] += pow(0.25 * (w.state.q[i] - best.state.q[i]), 2);
        square[k] += pow(w.state.q[2 + i] - best.state.q[2 + i], 2);
      }
    }
  }
  for (int k = 1; k < STEPS; k++) {
    double error = sqrt(square[k] / RUNS), before = sqrt(square[k - 1] / RUNS);
    if (error > 1e-11) ck_assert_msg(before >= 14 * error, "%d: %g, then %g", k, before, error);
    if (k == 1) ck_assert_double_le(error, 1e-8); /* 50 us */
  }
  ck_assert_int_gt(touches, RUNS);
}
