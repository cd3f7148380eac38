/* The plant's motion against closed forms, energy, and itself at other steps. */
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

static void alone(const ethd_sim_def *def, double q1, double q2, world *out) {
  put(def, q1, q2, 0, out);
  out->body.gap = INFINITY; /* nothing to touch */
}

static void run(world *w, double duration, double cell) {
  int n = (int)floor(duration / cell + 0.5);
  for (int i = 0; i < n; i++) {
    if (i % 20 == 0) ethd__body_refer(&w->body, &w->state);
    ethd__body_advance(&w->body, &w->hand, w->t, cell, &w->state);
    w->t += cell;
  }
}

/* ---- one joint ---- */

/* m v' = -b v: v = v0 exp(-b t / m), x = m/b (v0 - v). */
TEST(test_viscous) {
  ethd_sim_def def = quiet();
  def.plant.viscous = 3;
  world w;
  alone(&def, PI / 2, 0, &w);
  w.state.v[0] = 0.4 / 0.25;
  run(&w, 0.1, CELL);
  double v = 0.4 * exp(-3 * 0.1 / 0.12);
  ck_assert_double_eq_tol(0.25 * w.state.v[0], v, 1e-12);
  ck_assert_double_eq_tol(0.25 * (w.state.q[0] - PI / 2), 0.12 / 3 * (0.4 - v), 1e-12);
  ck_assert(w.state.v[1] == 0 && w.state.q[1] == 0);
}

/* m v' = -f tanh(v / vs): sinh(v / vs) = sinh(v0 / vs) exp(-f t / (m vs)). */
TEST(test_friction) {
  ethd_sim_def def = quiet();
  def.plant.friction = 0.4;
  world w;
  for (int j = 0; j < 2; j++) {
    alone(&def, PI / 2, 0, &w);
    w.state.v[j] = -0.15 / 0.25;
    for (int i = 0; i < 150; i++) {
      run(&w, 1e-3, CELL);
      double s = sinh(0.15 / 3e-3) * exp(-0.4 * w.t / (def.plant.mass[j] * 3e-3));
      ck_assert_double_eq_tol(0.25 * w.state.v[j], -3e-3 * asinh(s), 3e-9);
    }
  }
}

/* A constant torque: th = tau t^2 / (2 I). */
TEST(test_torque) {
  ethd_sim_def def = quiet();
  world w;
  alone(&def, 1, 0.2, &w);
  w.body.torque[0] = 0.3;
  w.body.torque[1] = -0.7;
  run(&w, 0.05, CELL);
  ck_assert_double_eq_tol(w.state.q[0], 1 + 0.3 * 0.00125 / (0.12 * 0.0625), 1e-12);
  ck_assert_double_eq_tol(w.state.q[1], 0.2 - 0.7 * 0.00125 / (0.25 * 0.0625), 1e-12);
}

/* ---- finger ---- */

/* The ring as good as fixed, the hand's rest where pad and ring just touch: half a period with the hand
   alone, half with hand and pad, each a sine. */
TEST(test_two_springs) {
  ethd_sim_def def = quiet();
  world w;
  put(&def, PI / 2, 0, 0.0045, &w);
  w.body.inertia[0] = w.body.inertia[1] = 1e12;
  w.body.gap = w.hand.a.x - 0.25; /* to the last digit */
  double out = sqrt(280 / 0.07), in = sqrt((280 + 27000) / 0.07), v0 = -0.3;
  w.state.v[2] = v0;
  w.state.touch = ETHD__APART;
  for (int i = 1; i <= 2000; i++) {
    run(&w, 2 * CELL, 2 * CELL);
    double period = PI / out + PI / in, t = fmod(w.t, period);
    double x = t < PI / out ? v0 / out * sin(out * t) : -v0 / in * sin(in * (t - PI / out));
    ck_assert_double_eq_tol(w.state.q[2] - w.hand.a.x, x, 3e-9);
    ck_assert(w.state.q[3] == 0.25);
  }
}

/* The finger pressed on a ring as good as fixed by a hand of minimum jerk, both at rest at first. From its path h it is
   y away: m y'' = -k y - K (h + y - r) is solved by y = -K / (k + K) (h - r - h''/w^2 + h''''/w^4) and a sine. */
TEST(test_hand_of_minimum_jerk) {
  enum { MS = 80 };
  const double length = 0.02, whole = 1e-3 * MS, stiffness = 280 + 27000, square = stiffness / 0.07;
  const ethd_path path = {.from = {0.258, 0.25},
                          .to_x = 0.258 + length,
                          .speed = 1.875 * length / whole,
                          .profile = ETHD_PROFILE_MINIMUM_JERK};
  ethd_sim_def def = quiet();
  world w;
  put(&def, PI / 2, 0, 0.0045, &w);
  w.body.inertia[0] = w.body.inertia[1] = 1e12;
  ethd__path_piece(&path, 0, &w.hand);
  double edge = 0.25 + w.body.gap, rest = (280 * path.from.x + 27000 * edge) / stiffness;
  w.state.q[2] = rest;
  w.state.touch = ETHD__PRESSING;
  for (int i = 1; i < MS; i++) {
    run(&w, 1e-3, 1e-3);
    double s = w.t / whole, h = path.from.x + length * s * s * s * (10 + s * (6 * s - 15));
    double second = length / (whole * whole) * s * (60 + s * (120 * s - 180));
    double third = 60 * length / (whole * whole * whole), fourth = (720 * s - 360) * length / pow(whole, 4);
    double fifth = 720 * length / pow(whole, 5), first = -third / square + fifth / (square * square);
    double y = h - edge - second / square + fourth / (square * square), root = sqrt(square);
    y += 360 * length / pow(whole, 4) / (square * square) * cos(root * w.t) - first / root * sin(root * w.t);
    double x = h - 27000 / stiffness * y;
    ck_assert_double_eq_tol(w.state.q[2], x, 1e-14);
    ck_assert(w.state.q[3] == 0.25 && w.state.touch == ETHD__PRESSING);
  }
}

/* A blow on the finger dies away in the hand: m x'' + b x' + k x = 0. */
TEST(test_hand) {
  ethd_sim_def def = quiet();
  def.plant.hand_damping = 4.27;
  world w;
  put(&def, PI / 2, 0, 0, &w);
  w.state.v[3] = 0.2;
  run(&w, 0.05, CELL);
  double d = 4.27 / (2 * 0.07), f = sqrt(280 / 0.07 - d * d);
  ck_assert_double_eq_tol(w.state.q[3] - 0.25, 0.2 / f * exp(-d * 0.05) * sin(f * 0.05), 1e-11);
}

/* Pressed together and let go: the force follows K p (1 + c p_dot), never pulls, and stops at p = 0. */
TEST(test_pad) {
  ethd_sim_def def = quiet();
  def.plant.pad_damping = 1.5;
  world w;
  put(&def, PI / 2, 0, 0.0050, &w);
  double p, force;
  int touched = 0, left = 0;
  for (int i = 0; i < 400; i++) {
    ethd_vec x, v;
    ethd__body_ring(&w.body, &w.state, &x, &v);
    ethd_vec r = {w.state.q[2] - x.x, w.state.q[3] - x.y}, s = {w.state.v[2] - v.x, w.state.v[3] - v.y};
    double distance = hypot(r.x, r.y), depth = distance - 0.0045, rate = (r.x * s.x + r.y * s.y) / distance;
    ethd__body_pad(&w.body, &w.state, &p, &force);
    ck_assert_double_eq_tol(p, depth, 1e-15);
    ck_assert_double_eq_tol(force, depth > 1e-15 ? fmax(0, 27000 * depth * (1 + 1.5 * rate)) : 0, 1e-9);
    touched += force > 0;
    left += depth > 0 && rate < -1 / 1.5;
    run(&w, CELL, CELL);
    if (i == 200) { /* torn out */
      w.state.q[2] = x.x + 0.0048;
      w.state.q[3] = x.y;
      w.state.v[2] = v.x - 1.2;
      w.state.touch = ethd__body_touch(&w.body, &w.state);
    }
  }
  ck_assert_int_gt(touched, 50);
  ck_assert_int_gt(left, 1);
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
  double before = ethd__body_energy(&w.body, &w.state, w.hand.a), most = 0, p, force;
  int touches = 0;
  for (int i = 0; i < 400; i++) {
    ethd__touch was = w.state.touch;
    run(&w, 20 * CELL, CELL / 2);
    double now = ethd__body_energy(&w.body, &w.state, w.hand.a);
    ethd__body_pad(&w.body, &w.state, &p, &force);
    most = fmax(most, fabs(now - before) / before);
    touches += was != w.state.touch;
  }
  ck_assert_double_le(most, 1e-7);
  ck_assert_int_gt(touches, 5);
}

/* A free arm keeps its energy, for a second, to 1e-10 J: coupled links that turn once round. (The arms of
   drivers/arm have no mass; they follow speeds.) */
TEST_LOOP(test_free_arm, 0, 2) {
  ethd_sim_def def = quiet();
  def.arm.mechanism = (ethd_mechanism)(_i & 1);
  def.plant.coupling = 0.006;
  world w;
  alone(&def, 1.3, -0.6, &w);
  w.state.v[0] = 6;
  w.state.v[1] = -4;
  const double before = ethd__body_energy(&w.body, &w.state, w.hand.a), begin = w.state.q[0];
  double most = 0;
  for (int i = 0; i < 100; i++) {
    run(&w, 0.01, 1e-3);
    most = fmax(most, fabs(ethd__body_energy(&w.body, &w.state, w.hand.a) - before));
  }
  printf("%.3f J, within %.1e J, turned %.1f\n", before, most, w.state.q[0] - begin);
  ck_assert_double_ge(before, 0.1);
  ck_assert_double_le(most, 1e-10);
}

/* Work of a torque is the energy it leaves: tau dq of the joints. */
TEST_LOOP(test_work, 0, 2) {
  ethd_sim_def def = quiet();
  def.arm.mechanism = (ethd_mechanism)(_i & 1);
  def.plant.coupling = 0.006;
  world w;
  alone(&def, 1.3, -0.6, &w);
  double q[2], begin[2];
  ethd__body_joints(&w.body, w.state.q, begin);
  w.body.torque[0] = 0.11;
  w.body.torque[1] = -0.07;
  run(&w, 0.03, CELL);
  ethd__body_joints(&w.body, w.state.q, q);
  double work = 0.11 * (q[0] - begin[0]) - 0.07 * (q[1] - begin[1]);
  ck_assert_double_gt(work, 1e-4);
  ck_assert_double_eq_tol(ethd__body_energy(&w.body, &w.state, w.hand.a), work, 1e-11);
}

/* Lagrange's equations from the energy alone, by differences: d/dt dT/dth' - dT/dth = generalised torque. */
TEST(test_equations) {
  ethd_sim_def def = quiet();
  def.plant.coupling = 0.006;
  world w;
  put(&def, 1.3, 0.2, 0, &w);
  w.body.torque[0] = 0.2;
  w.body.torque[1] = 0.1;
  double v[2] = {2.3, -1.7}, h = 1e-4, a[ETHD__DOF_MAX], momentum_rate[2], slope[2];
  w.state.v[0] = v[0];
  w.state.v[1] = v[1];
  ethd__sim_motion hand = {.x = w.hand.a};
  ethd__body_accelerate(&w.body, ETHD__APART, &hand, w.state.q, w.state.v, a);
  for (int j = 0; j < 2; j++) {
    double p[2], e[2];
    for (int side = 0; side < 2; side++) {
      double s = side ? h : -h;
      ethd__sim_state state = w.state;
      state.q[j] += s;
      e[side] = ethd__body_energy(&w.body, &state, w.hand.a);
      /* momentum a moment before and after, along the motion */
      double kick[2];
      for (int k = 0; k < 2; k++) {
        state = w.state;
        for (int i = 0; i < 2; i++) {
          state.q[i] += s * v[i];
          state.v[i] += s * a[i];
        }
        state.v[j] += k ? h : -h;
        state.q[2] = w.hand.a.x; /* the finger has no part in it */
        kick[k] = ethd__body_energy(&w.body, &state, w.hand.a);
      }
      p[side] = (kick[1] - kick[0]) / (2 * h);
    }
    momentum_rate[j] = (p[1] - p[0]) / (2 * h);
    slope[j] = (e[1] - e[0]) / (2 * h);
    ck_assert_double_eq_tol(momentum_rate[j] - slope[j], w.body.torque[j], 1e-5);
  }
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

/* Between free ends, motor against link: f = sqrt(k / mu) / 2 pi, 88.15 Hz with plant p's numbers. */
TEST(test_transmission) {
  ethd_sim_def def = quiet();
  def.plant.mass[0] = def.plant.mass[1] = 0.09475;
  def.plant.motor_mass = 0.01322;
  def.plant.stiffness = 3489.6;
  world w;
  double mu = 0.01322 * (0.09475 - 0.01322) / 0.09475, omega = sqrt(3489.6 / mu);
  ck_assert_double_eq_tol(omega / (2 * PI), 88.1, 0.1);
  for (int j = 0; j < 2; j++) {
    put(&def, PI / 2, 0, 0, &w);
    double begin = w.state.q[j];
    w.state.v[4 + j] = 0.1 / 0.01322;
    w.state.v[j] = -0.1 / (0.09475 - 0.01322);
    for (int i = 0; i < 100; i++) {
      run(&w, 1e-3, CELL / 5);
      double twist = 0.1 / mu / omega * sin(omega * w.t);
      ck_assert_double_eq_tol(w.state.q[4 + j] - w.state.q[j], twist, 1e-7);
      double centre = 0.01322 * w.state.q[4 + j] + (0.09475 - 0.01322) * w.state.q[j];
      ck_assert_double_eq_tol(centre / 0.09475, begin, 1e-12);
    }
  }
}

/* A stiff one is as good as none. */
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
