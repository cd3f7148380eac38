/* The guard on its own: limits in their order, stops, counts. */
#include <math.h>
#include <string.h>

#include "unit/rig.h"

/* A ring at x with an arm whose J is the unit matrix times 1/4 m. */
static const ethd_pose pose = {{0.3, 0.2}, {0.25, 0, 0, 0.25}, {4, 0, 0, 4}};
static const ethd_vec still = {0, 0};

/* 0.1 kg at 0.25 m, without delay, at 1 kHz: the stop's damping is m / (e T) = 36.8 Ns/m. */
static const ethd_guard_device device = {.link = {0.25, 0.25},
                                         .mass = 0.1,
                                         .inertia = {0.1 / 16, 0.1 / 16},
                                         .period = 0.001,
                                         .stiffness = 500,
                                         .damping = 10};
static const double full = 0.1 / (0.001 * M_E);

static int32_t at(const ethd_pose *pose_, const ethd_limits *l, ethd_guard_state *s, ethd_vec v, double dt,
                  double out[2]) {
  ethd_guard_motion m = {.pose = pose_, .v = v, .dt = dt};
  ethd_pose_joints(pose_, v, m.qd);
  return ethd_guard_step(l, &device, s, &m, out);
}

static int32_t step(const ethd_limits *l, ethd_guard_state *s, ethd_vec v, double t1, double t2, double out[2]) {
  out[0] = t1;
  out[1] = t2;
  return at(&pose, l, s, v, 0.001, out);
}

static void is(const double tau[2], double t1, double t2) {
  ck_assert_double_eq_tol(tau[0], t1, 1e-15);
  ck_assert_double_eq_tol(tau[1], t2, 1e-15);
}

TEST(test_no_limits) {
  ethd_limits l = ethd_limits_none();
  ethd_guard_state s = {0};
  double tau[2];
  ck_assert_int_eq(step(&l, &s, (ethd_vec){1e9, -1e9}, 1e300, -1e300, tau), 0);
  ck_assert(tau[0] == 1e300 && tau[1] == -1e300);
  for (int i = 0; i < ETHD_GUARD_COUNT; i++) ck_assert_uint_eq(s.counts[i], 0);
}

TEST(test_torque) {
  ethd_limits l = ethd_limits_none();
  ethd_guard_state s = {0};
  double tau[2];
  l.torque = 1.5;
  ck_assert_int_eq(step(&l, &s, still, 1.5, -1.5, tau), 0); /* at the limit is within */
  ck_assert_int_eq(step(&l, &s, still, 1.6, -9, tau), ETHD_GUARD_TORQUE);
  is(tau, 1.5, -1.5);
  l.torque = 0;
  ck_assert_int_eq(step(&l, &s, still, 1e-300, 0, tau), ETHD_GUARD_TORQUE);
  is(tau, 0, 0);
  ck_assert_uint_eq(s.counts[1], 2); /* ticks, not joints */
}

/* 100 Nm/s: 0.1 Nm a tick, from the torque that was commanded, not the one that was asked for. */
TEST(test_rate) {
  ethd_limits l = ethd_limits_none();
  ethd_guard_state s = {0};
  double tau[2];
  l.torque_rate = 100;
  ck_assert_int_eq(step(&l, &s, still, 0.05, -0.05, tau), 0);
  for (int i = 1; i <= 5; i++) {
    ck_assert_int_eq(step(&l, &s, still, 9, -9, tau), ETHD_GUARD_RATE);
    is(tau, 0.05 + 0.1 * i, -0.05 - 0.1 * i);
  }
  ck_assert_int_eq(step(&l, &s, still, 0.5, -0.5, tau), 0);
  ck_assert_uint_eq(s.counts[2], 5);
}

/* A longer step may change more. */
TEST(test_rate_over_missed_ticks) {
  ethd_limits l = ethd_limits_none();
  ethd_guard_state s = {0};
  double tau[2] = {9, 0};
  l.torque_rate = 100;
  ck_assert_int_eq(at(&pose, &l, &s, still, 0.005, tau), ETHD_GUARD_RATE);
  is(tau, 0.5, 0);
}

/* Nearly as steep as the rate allows, for longer than anything steeper may last: nothing is cut, nothing stops. */
TEST(test_slope_of_the_rate) {
  ethd_limits l = ethd_limits_none();
  ethd_guard_state s = {0};
  double tau[2];
  l.torque_rate = 100;
  for (int i = 1; i <= 3 * ETHD_STEEP_MAX; i++) {
    ck_assert_int_eq(step(&l, &s, still, 0.099 * i, -0.09 * i, tau), 0);
    is(tau, 0.099 * i, -0.09 * i);
  }
  ck_assert_int_eq(s.stopping, 0);
}

/* Torque before rate: both bits when both had to act; the rate's result stays within the torque limit. */
TEST(test_torque_then_rate) {
  ethd_limits l = ethd_limits_none();
  ethd_guard_state s = {0};
  double tau[2];
  l.torque = 0.25;
  l.torque_rate = 100;
  ck_assert_int_eq(step(&l, &s, still, 5, 0.02, tau), ETHD_GUARD_TORQUE | ETHD_GUARD_RATE);
  is(tau, 0.1, 0.02);
  (void)step(&l, &s, still, 5, 0.02, tau);
  ck_assert_int_eq(step(&l, &s, still, 5, 0.02, tau), ETHD_GUARD_TORQUE);
  is(tau, 0.25, 0.02);
}

/* A limit that becomes narrower than the last torque is kept from its first tick on, whatever the rate allows:
   at 1 Nm with 10 mNm a tick, a limit of 0.1 Nm. */
TEST(test_narrower_torque_at_once) {
  ethd_limits l = ethd_limits_none();
  double tau[2];
  l.torque_rate = 10;
  for (int hot = 0; hot < 2; hot++) {
    ethd_guard_state s = {.last = {1, -1}, .asked = {1, -1}};
    l.torque = hot ? INFINITY : 0.1;
    l.nominal_torque = hot ? 0.1 : INFINITY;
    s.heat[0] = s.heat[1] = 1; /* a motor may have its nominal torque */
    int32_t bits = step(&l, &s, still, 1, -1, tau);
    ck_assert_int_eq(bits & (ETHD_GUARD_TORQUE | ETHD_GUARD_HEAT), hot ? ETHD_GUARD_HEAT : ETHD_GUARD_TORQUE);
    is(tau, 0.1, -0.1);
    (void)step(&l, &s, still, 0.5, 0.5, tau);
    is(tau, 0.1, -0.09);
  }
}

/* Also where a rate is set, and the next torque rises from that zero. */
TEST(test_finite_with_a_rate) {
  ethd_limits l = ethd_limits_none();
  ethd_guard_state s = {.last = {0.5, 0.5}, .asked = {0.5, 0.5}};
  double tau[2];
  l.torque_rate = 100;
  ck_assert_int_eq(step(&l, &s, still, NAN, 0.5, tau), ETHD_GUARD_FINITE);
  is(tau, 0, 0);
  (void)step(&l, &s, still, 0.5, 0.5, tau);
  is(tau, 0.1, 0.1);
}

TEST(test_finite) {
  const double bad[] = {NAN, INFINITY, -INFINITY};
  ethd_limits l = ethd_limits_none();
  l.torque = 1;
  for (int i = 0; i < 6; i++) {
    ethd_guard_state s = {.last = {0.5, 0.5}};
    double tau[2];
    int32_t bits = step(&l, &s, still, i % 2 ? bad[i / 2] : 0.3, i % 2 ? 0.3 : bad[i / 2], tau);
    ck_assert_int_eq(bits, ETHD_GUARD_FINITE); /* zero torque is no clamping */
    is(tau, 0, 0);
    ck_assert_uint_eq(s.counts[0], 1);
  }
}

/* At first a tenth of the momentum, m v / 10 within a tick. When that is seen to be gone, the whole damping, until slower
   than 20 mm/s; then nothing, until cleared. */
TEST(test_stop) {
  ethd_limits l = ethd_limits_none();
  ethd_guard_state s = {0};
  double tau[2];
  l.speed = 0.5;
  ck_assert_int_eq(step(&l, &s, (ethd_vec){0.3, 0.4}, 1, 1, tau), 0);
  is(tau, 1, 1);
  ck_assert_int_eq(step(&l, &s, (ethd_vec){0.3, 0.41}, 1, 1, tau), ETHD_GUARD_SPEED);
  is(tau, 0.25 * -10 * 0.3, 0.25 * -10 * 0.41);
  ck_assert_int_eq(step(&l, &s, (ethd_vec){-0.1, 0.02}, 1, 1, tau), 0); /* within, and still stopping */
  is(tau, 0.25 * full * 0.1, 0.25 * -full * 0.02);
  ck_assert_int_eq(s.stopped, 0);
  (void)step(&l, &s, (ethd_vec){0.012, 0.0159}, 1, 1, tau);
  is(tau, 0, 0);
  ck_assert_int_eq(s.stopped, 1);
  ck_assert_int_eq(step(&l, &s, (ethd_vec){2, 0}, 1, 1, tau), ETHD_GUARD_SPEED);
  is(tau, 0, 0);
  ck_assert_uint_eq(s.counts[3], 2);
}

/* A torque that is held for several periods, as on a slow bus, is as much the smaller. */
TEST(test_stop_that_is_held) {
  ethd_limits l = ethd_limits_none();
  ethd_guard_state s = {0};
  double tau[2] = {0, 0};
  l.speed = 0.1;
  ck_assert_int_eq(at(&pose, &l, &s, (ethd_vec){0.3, 0}, 0.005, tau), ETHD_GUARD_SPEED);
  is(tau, 0.25 * -2 * 0.3, 0);
}

/* Not a number is too fast, which nothing can brake, and out of any workspace that has a bound. */
TEST(test_nan_fails) {
  ethd_limits l = ethd_limits_none();
  ethd_guard_state s = {0};
  ethd_pose nowhere = pose;
  double tau[2];
  ck_assert_int_eq(step(&l, &s, (ethd_vec){NAN, 0}, 1, 1, tau), ETHD_GUARD_SPEED);
  is(tau, 0, 0);
  nowhere.x.y = NAN;
  tau[0] = tau[1] = 1;
  memset(&s, 0, sizeof s);
  ck_assert_int_eq(at(&nowhere, &l, &s, still, 0.001, tau), ETHD_GUARD_WORKSPACE);
}

TEST(test_workspace) {
  const double bounds[4] = {0.31, 0.29, 0.21, 0.19}; /* each leaves (0.3, 0.2) outside */
  for (int i = 0; i < 4; i++) {
    ethd_limits l = ethd_limits_none();
    ethd_guard_state s = {0};
    double tau[2];
    l.workspace[i] = i % 2 ? (i == 1 ? 0.3 : 0.2) : (i == 0 ? 0.3 : 0.2);
    ck_assert_int_eq(step(&l, &s, still, 1, 1, tau), 0); /* on the bound is within */
    l.workspace[i] = bounds[i];
    ck_assert_int_eq(step(&l, &s, still, 1, 1, tau), ETHD_GUARD_WORKSPACE);
    is(tau, 0, 0);
    ck_assert_int_eq(s.stopping, ETHD_GUARD_WORKSPACE);
    ck_assert_uint_eq(s.counts[4], 1);
  }
}

/* The stop obeys the torque limit, and no rate. */
TEST(test_stop_and_the_other_limits) {
  ethd_limits l = ethd_limits_none();
  ethd_guard_state s = {.last = {0.4, 0}};
  double tau[2];
  l.speed = 0.5;
  l.torque = 2;
  l.torque_rate = 1;
  ck_assert_int_eq(step(&l, &s, (ethd_vec){1, 0}, 0.4, 0, tau), ETHD_GUARD_SPEED | ETHD_GUARD_TORQUE);
  is(tau, -2, 0);
}

/* Without latch only the tick of the breach is stopped. */
TEST(test_without_latch) {
  ethd_limits l = ethd_limits_none();
  ethd_guard_state s = {0};
  double tau[2];
  l.speed = 0.5;
  l.latch = 0;
  ck_assert_int_eq(step(&l, &s, (ethd_vec){1, 0}, 1, 1, tau), ETHD_GUARD_SPEED);
  is(tau, -2.5, 0);
  ck_assert_int_eq(step(&l, &s, (ethd_vec){0.4, 0}, 1, 1, tau), 0);
  is(tau, 1, 1);
  ck_assert(s.stopping == 0 && s.stopped == 0);
}

/* Programs print them: each has a name, a unit and a description of one line. */
TEST(test_rows_say_what_they_are) {
  const char *const units[] = {"Nm", "Nm/s", "m/s", "m", "s", "rad", "J", NULL};
  for (int i = 0; i < ETHD_LIMITS; i++) {
    const ethd_limit *row = &ethd_limit_rows[i];
    const char *const *unit = units;
    while (*unit && strcmp(*unit, row->unit) != 0) unit++;
    ck_assert(row->name[0] && row->brief[0] && *unit);
  }
}

TEST(test_narrower) {
  ethd_limits a = ethd_limits_none(), b = ethd_limits_none();
  a.torque = 1, b.torque = 2;
  b.torque_rate = 3;
  a.speed = 4;
  b.speed = 0.4;
  a.workspace[0] = 0.1, b.workspace[0] = 0.2;
  a.workspace[1] = 0.5, b.workspace[1] = 0.7;
  b.workspace[2] = -1;
  a.workspace[3] = 5, b.workspace[3] = 4;
  b.step_time = 1e-4;
  a.clean_time = 1, b.clean_time = 2; /* the longer one is narrower */
  a.finger_age = 0.01, b.finger_age = 0.02;
  a.latch = 0, b.latch = 1;
  for (int i = 0; i < 2; i++) {
    ethd_limits n = i ? ethd_limits_narrower(&a, &b) : ethd_limits_narrower(&b, &a);
    ck_assert(n.torque == 1 && n.torque_rate == 3 && n.speed == 0.4 && n.step_time == 1e-4 && n.latch == 1);
    ck_assert(n.clean_time == 2 && n.finger_age == 0.01);
    ck_assert(n.workspace[0] == 0.2 && n.workspace[1] == 0.5 && n.workspace[2] == -1 && n.workspace[3] == 4);
  }
  b.latch = 0;
  ck_assert_int_eq(ethd_limits_narrower(&a, &b).latch, 0);
}
