/* Limits that most setups don't have: the workspace's wall, reach, joints, heat; torques that are cut for long
   or rise too steeply. */
#include <math.h>
#include <string.h>

#include "unit/draw.h"
#include "unit/moody.h"

static ethd_sense at(const rig *r, double x, double v) {
  motion m = rig_at(x, v, 0);
  ethd_sense s = rig_sense(&r->setup.arm, &m);
  s.time_ns = r->sense.time_ns + 1000000;
  return s;
}

/* ---- margin ---- */

static const ethd_pose unit = {{0.3, 0.2}, {1, 0, 0, 1}, {1, 0, 0, 1}};

static const ethd_guard_device device = {
    .link = {1, 1}, .mass = 1, .inertia = {1, 1}, .period = 0.001, .stiffness = 500, .damping = 10};

static ethd_vec wall(ethd_limits *l, double x, double y, double vx, double vy, int32_t *bits) {
  ethd_guard_state s = {0};
  ethd_pose pose = unit;
  double tau[2] = {0, 0};
  pose.x = (ethd_vec){x, y};
  const ethd_guard_motion m = {.pose = &pose, .v = {vx, vy}, .qd = {vx, vy}, .dt = 0.001};
  *bits = ethd_guard_step(l, &device, &s, &m, tau);
  return (ethd_vec){tau[0], tau[1]};
}

/* 500 N/m and, on the way in, 10 Ns/m; it never pulls. */
TEST(test_margin) {
  ethd_limits l = ethd_limits_none();
  int32_t bits;
  l.workspace[0] = 0.2, l.workspace[1] = 0.4, l.workspace[2] = 0, l.workspace[3] = 0.3;
  l.margin = 0.01;
  const double cases[][6] = {{0.30, 0.20, 1, 1, 0, 0},        {0.2101, 0.20, -1, 0, 0, 0},
                             {0.206, 0.20, 0, 0, 2, 0},       {0.206, 0.20, -0.1, 0, 3, 0},
                             {0.206, 0.20, 0.1, 0, 2, 0},     {0.396, 0.20, 0.1, 0.1, -4, 0},
                             {0.30, 0.002, 0, -0.2, 0, 6},    {0.30, 0.30, 0, -0.2, 0, -5},
                             {0.205, 0.295, 0, 0, 2.5, -2.5}, {0.395, 0.005, 0, 0, -2.5, 2.5}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const double *c = cases[i];
    ethd_vec f = wall(&l, c[0], c[1], c[2], c[3], &bits);
    ck_assert_double_eq_tol(f.x, c[4], 1e-9);
    ck_assert_double_eq_tol(f.y, c[5], 1e-9);
    ck_assert_int_eq(bits, c[4] != 0 || c[5] != 0 ? ETHD_GUARD_MARGIN : 0);
  }
  l.margin = 0;
  wall(&l, 0.2, 0, 0, 0, &bits);
  ck_assert_int_eq(bits, 0);
}

/* A ring of reach: along the radius. */
TEST(test_margin_of_reach) {
  ethd_limits l = ethd_limits_none();
  int32_t bits;
  l.reach[0] = 0.1, l.reach[1] = 0.5;
  l.margin = 0.02;
  ethd_vec f = wall(&l, 0.3, 0.4, 0, 0, &bits); /* at the bound: 10 N inward */
  ck_assert_double_eq_tol(f.x, -6, 1e-9);
  ck_assert_double_eq_tol(f.y, -8, 1e-9);
  f = wall(&l, 0.066, 0.088, 0, 0, &bits); /* 10 mm inside the inner margin */
  ck_assert_double_eq_tol(f.x, 3, 1e-9);
  ck_assert_double_eq_tol(f.y, 4, 1e-9);
}

/* The hard bounds stop: the workspace's, the reach's, each end of each joint's range. Degraded first, where
   there is a margin. */
TEST_LOOP(test_bounds, 0, 6) {
  const bool inward = _i == 3 || _i == 4; /* q1 falls and q2 rises on the way out */
  rig r;
  moody_open(&r, 1);
  if (_i == 0) r.setup.limits.workspace[1] = 0.26;
  if (_i == 1) r.setup.limits.reach[1] = hypot(0.26, 0.25);
  if (_i >= 2) r.setup.limits.joints[_i - 2] = at(&r, 0.010, 0).q[(_i - 2) / 2];
  if (_i < 2) r.setup.limits.margin = 0.004;
  rig_post(&r);
  for (int k = 0; k < 20; k++) {
    ethd_sense s = at(&r, inward ? 0.0199 - 0.0005 * k : 0.0005 * k + 0.0001, -0.1);
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  }
  ck_assert_uint_eq(rig_counted(&r, ETHD_FAULT_WORKSPACE), _i < 2);
  const double beyond = inward ? 0.0098 : 0.0102;
  ethd_sense s = at(&r, beyond, -0.1);
  rig_try(&r, &s);
  ck_assert(r.trace.fault == ETHD_FAULT_WORKSPACE && r.command.safe == 0);
  ck_assert_double_eq_tol(r.command.torque[0], 0.25 * MOODY_PROBE * 0.1, 0.03);
  s = at(&r, beyond, 0);
  rig_try(&r, &s);
  ck_assert(r.trace.fault == ETHD_FAULT_WORKSPACE && r.command.safe == 1);
  rig_close(&r);
}

/* ---- heat ---- */

/* h' = ((tau / nominal)^2 - h) / time by fine steps of the midpoint rule. */
static double reference(double heat, double load, double time, double dt) {
  enum { STEPS = 200 };
  for (int i = 0; i < STEPS; i++) {
    double h = dt / STEPS, middle = heat + h / 2 * (load * load - heat) / time;
    heat += h * (load * load - middle) / time;
  }
  return heat;
}

TEST(test_heat) {
  ethd_limits l = ethd_limits_none();
  ethd_guard_state s = {0};
  double heat[2] = {0, 0};
  l.nominal_torque = 0.0972;
  l.heat_time = 0.5;
  for (uint64_t i = 0; i < 2000; i++) {
    double dt = draw(3 * i, 1e-4, 5e-2), tau[2] = {draw(3 * i + 1, -0.1, 0.1), draw(3 * i + 2, -0.2, 0.2)};
    for (int k = 0; k < 2; k++) heat[k] = reference(heat[k], tau[k] / l.nominal_torque, l.heat_time, dt);
    memcpy(s.last, tau, sizeof tau);
    double hotter = ethd_guard_heat(&l, &s, dt);
    for (int k = 0; k < 2; k++) ck_assert_double_eq_tol(s.heat[k], heat[k], 1e-6);
    ck_assert_double_eq(hotter, fmax(s.heat[0], s.heat[1]));
  }
}

/* Twice the nominal torque for ever: full until h = 0.9 after 0.255 time constants, then less, to the nominal. */
TEST(test_fold_back) {
  ethd_limits l = ethd_limits_none();
  ethd_guard_state s = {0};
  double tau[2], last = INFINITY, full = 0;
  l.nominal_torque = 0.1;
  l.heat_time = 2;
  for (int i = 0; i < 20000; i++) {
    ck_assert_double_le(ethd_guard_heat(&l, &s, 0.001), 1 + 1e-12);
    tau[0] = 0.2, tau[1] = -0.2;
    const ethd_guard_motion m = {.pose = &unit, .dt = 0.001};
    int32_t bits = ethd_guard_step(&l, &device, &s, &m, tau);
    ck_assert(tau[0] <= last && tau[1] == -tau[0] && bits == (tau[0] < 0.2 ? ETHD_GUARD_HEAT : 0));
    last = tau[0];
    full += tau[0] == 0.2;
  }
  ck_assert_double_eq_tol(last, 0.1, 1e-3);
  /* the fold begins at 0.9 and cuts from 0.95 on: -2 ln(1 - 0.95 / 4) s */
  ck_assert_double_eq_tol(full * 0.001, -2 * log(1 - 0.95 / 4), 0.002);
}

/* Hotter than 105 %: by a torque that was held over lost ticks. It cools, and may be acknowledged. */
TEST(test_too_hot) {
  rig r;
  moody_open(&r, 1);
  r.setup.limits.nominal_torque = 0.1;
  r.setup.limits.heat_time = 1;
  rig_post(&r);
  motion m = rig_at(0.01, 0, 0.001); /* 0.16 Nm */
  ethd_sense s = rig_sense(&r.setup.arm, &m);
  for (int i = 0; i < 5; i++) ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  ck_assert_double_gt(fabs(r.command.torque[0]), 0.15);
  s.missed = 800;
  rig_try(&r, &s);
  moody_expect_safe(&r, ETHD_E_DEVICE, ETHD_FAULT_HEAT);
  ck_assert_double_eq(ethd_control_clean_time(r.control), 0);
  s.missed = 0;
  int cooling = 0;
  for (; ethd_control_clean_time(r.control) < 0.01 && cooling < 5000; cooling++) rig_try(&r, &s);
  ck_assert(cooling > 100 && cooling < 5000);
  ethd_control_acknowledge(r.control);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  rig_close(&r);
}

/* One enormous torque leaves a heat that is a number: the motor stays without torque until it has cooled. */
TEST(test_enormous_torque) {
  ethd_limits l = ethd_limits_none();
  ethd_guard_state s = {.last = {1e200, 0}};
  l.nominal_torque = 0.1;
  l.heat_time = 3;
  ck_assert_double_gt(ethd_guard_heat(&l, &s, 0.001), 300);
  memset(s.last, 0, sizeof s.last);
  double hotter = 0, t = 0;
  for (; t < 60 && (hotter = ethd_guard_heat(&l, &s, 0.001)) > 1; t += 0.001) ck_assert(isfinite(hotter));
  ck_assert_double_eq_tol(t, 3 * log(1e6 * 0.001 / 3), 0.1);
}

/* An enabling forgets all but the heat. */
TEST(test_restart) {
  rig r;
  moody_open(&r, 1);
  r.setup.limits.nominal_torque = 0.1;
  r.setup.limits.heat_time = 1;
  rig_post(&r);
  motion m = rig_at(0.01, 0, 0.001); /* 0.16 Nm: over the nominal torque, folded back in the end */
  ethd_sense s = rig_sense(&r.setup.arm, &m);
  for (int i = 0; i < 3000; i++) ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  double folded = fabs(r.command.torque[0]);
  ck_assert_double_lt(folded, 0.11);
  for (int forgets = 0; forgets < 2; forgets++) {
    (forgets ? ethd_control_reset : ethd_control_restart)(r.control);
    for (int i = 0; i < 3; i++) rig_try(&r, &s);
    ck_assert_int_eq(r.trace.tick, 2);
    ck_assert(forgets ? fabs(r.command.torque[0]) > 0.15 : fabs(r.command.torque[0]) < 0.12);
  }
  rig_close(&r);
}

/* ---- torques ---- */

/* Reported once, when it has lasted for 0.1 s. */
TEST(test_cut) {
  rig r;
  moody_open(&r, 1);
  r.setup.limits.torque = 0.01;
  rig_post(&r);
  for (int i = 0; i < 300; i++) {
    ethd_sense s = moody_sense(&r);
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    ethd_event e = rig_poll(&r);
    ck_assert_int_eq(e.kind, i == 0 ? ETHD_EVENT_TAKEN : i == 100 ? ETHD_EVENT_FAULT : 0);
    if (i == 100) ck_assert(e.code == ETHD_FAULT_TORQUE && e.value == 1);
  }
  ck_assert_uint_eq(rig_counted(&r, ETHD_FAULT_TORQUE), 1);
  rig_close(&r);
}

/* A step that the limiter follows for long is no fault; a law that goes up and down is, after 20 ticks. */
TEST(test_steep) {
  rig r;
  moody_open(&r, 1);
  r.setup.limits.torque_rate = 1;
  rig_post(&r);
  for (int i = 0; i < 200; i++) {
    ethd_sense s = moody_sense(&r);
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  }
  ck_assert_uint_gt(rig_counted(&r, ETHD_FAULT_TORQUE_RATE), 0);
  mood.tracking = MOODY_BAD;
  int ticks = 0;
  for (; r.trace.fault == 0 && ticks < 100; ticks++) {
    ethd_sense s = at(&r, 0.01, 0.1);
    mood.value = ticks % 2 ? 0.1 : -0.1;
    rig_try(&r, &s);
  }
  ck_assert(ticks == 20 && r.trace.fault == ETHD_FAULT_TORQUE_RATE);
  ethd_sense s = at(&r, 0.01, 0.1);
  rig_try(&r, &s);
  ck_assert_double_eq_tol(r.command.torque[0], -0.25 * MOODY_PROBE * 0.1, 0.03);
  mood.tracking = 0; /* the first acknowledgement counts */
  s = at(&r, 0.01, 0);
  rig_try(&r, &s);
  ethd_control_acknowledge(r.control);
  s = at(&r, 0.01, 0);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  rig_close(&r);
}

/* Where faults don't latch each tick is judged alone. */
TEST(test_steep_without_latch) {
  rig r;
  moody_open(&r, 0);
  r.setup.limits.torque_rate = 1;
  rig_post(&r);
  mood.tracking = MOODY_BAD;
  for (int i = 0; i < 100; i++) {
    ethd_sense s = at(&r, 0.01, 0.1);
    mood.value = i % 2 ? 0.1 : -0.1;
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  }
  rig_close(&r);
}
