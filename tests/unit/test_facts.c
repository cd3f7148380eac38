/* What a law that looks ahead is told of the device at each tick: the force that the limits leave it, and the finger's
   acceleration. */
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "unit/rig.h"

static ethd_facts seen;

static ethd_status look(const double *q, void *state, const ethd_contact *c, ethd_ruling *out) ETHD_RT {
  (void)q, (void)state, (void)out;
  seen = *c->facts;
  return ETHD_OK;
}

static double far_range(const double *q, double speed) ETHD_RT { return (void)q, (void)speed, 0.1; }

static const ethd_transition_law spying = {
    .law = {sizeof(ethd_transition_law), ETHD_ABI, ETHD_TRANSITION, 0, "spy", "looks", NULL, 0, NULL, NULL},
    .step = look,
    .range = far_range,
};

/* A parallel arm whose joint 1 alone moves the ring in x, 0.25 m a radian, before a wall along y; no friction. */
static void open_spied(rig *r) {
  rig_open(r, RIG_WALL);
  r->setup.arm = (ethd_arm){ETHD_ARM_PARALLEL, 0.25, 0.25};
  r->setup.limits.torque = 1.25;
  ethd_setup_transition(&r->setup, &spying);
}

#define LEVER 0.25 /* m */

static motion finger_at(double x) { return (motion){{0.25, 0.25}, {0, 0}, {x, 0.25}, {0, 0}}; }

/* A serial and a parallel arm with the same links feel the same mass along any n. */
TEST_LOOP(test_mass, 0, 2) {
  double mass[2];
  for (int serial = 0; serial < 2; serial++) {
    rig r;
    rig_open(&r, _i ? "halfplane -0.6 -0.8 -0.33\n" : RIG_WALL);
    r.setup.arm.mechanism = serial ? ETHD_ARM_SERIAL : ETHD_ARM_PARALLEL;
    ethd_setup_transition(&r.setup, &spying);
    r.setup.dynamics = (ethd_dynamics){{0.2, 0.3}, 0.4, 1.5, 2e-4};
    r.setup.limits.torque = 1.25;
    rig_start(&r);
    motion m = {{0.25, 0.25}, {0, 0}, {0.25, 0.25}, {0, 0}};
    rig_step(&r, &m);
    mass[serial] = seen.mass;
    ck_assert(seen.delay == 2e-4 && seen.ring_radius == 0.012 && seen.finger_age == 0);
    ck_assert(isnan(seen.finger_a));
    if (!_i && !serial) { /* joint 1 alone moves x, by 0.25 m/rad */
      ck_assert_double_eq_tol(seen.force, 5, 1e-9);
      ck_assert_double_eq_tol(seen.friction, 0.4, 1e-9);
      ck_assert_double_eq_tol(seen.viscous, 1.5, 1e-9);
    }
    rig_close(&r);
  }
  /* 1/m = n_x^2/m_x + n_y^2/m_y, as link angles of 90 and 0 deg part x and y */
  double expected = _i ? 1 / (0.36 / 0.2 + 0.64 / 0.3) : 0.2;
  ck_assert_double_eq_tol(mass[0], expected, 1e-9);
  ck_assert_double_eq_tol(mass[1], expected, 1e-9);
}

/* From no torque, one tick's worth of the rate; then what stands is added where it already pushes out of the wall, and
   has to be undone where it pushes in. */
TEST(test_rate) {
  for (int side = 0; side < 2; side++) {
    rig r;
    open_spied(&r);
    r.setup.limits.torque_rate = 100; /* 0.1 Nm a tick */
    rig_start(&r);
    motion m = finger_at(side ? 0.2502 : 0.2498);
    rig_step(&r, &m);
    ck_assert_double_eq_tol(seen.force, 0.1 / LEVER, 1e-9);
    double stands = fabs(r.command.torque[0]);
    ck_assert(stands > 0.01 && stands < 0.099);
    rig_step(&r, &m);
    ck_assert_double_eq_tol(seen.force, (0.1 + (side ? stands : -stands)) / LEVER, 1e-9);
    m = finger_at(side ? 0.26 : 0.24);
    for (int i = 0; i < 40; i++) { /* as far as the rate and the limit let it */
      rig_step(&r, &m);
      ck_assert_double_ge(seen.force, 0);
    }
    ck_assert_double_eq_tol(seen.force, (side ? 1.25 : 0) / LEVER, 1e-9);
    rig_close(&r);
  }
}

/* A motor that is hot has its nominal torque left. */
TEST(test_heat) {
  rig r;
  open_spied(&r);
  r.setup.limits.nominal_torque = 0.4;
  r.setup.limits.heat_time = 0.5;
  rig_start(&r);
  motion m = finger_at(0.24);
  rig_step(&r, &m);
  ck_assert_double_eq_tol(seen.force, 1.25 / LEVER, 1e-9); /* cold */
  for (int i = 0; i < 5000; i++) rig_step(&r, &m);
  ck_assert_double_eq_tol(seen.force, 0.4 / LEVER, 0.02);
  rig_close(&r);
}

/* Unequal joints: mass along n is that of the link that moves, for both directions. */
TEST(test_mass_of_each_link) {
  const char *const walls[] = {RIG_WALL, "halfplane 0 -1 -0.238\n"};
  const double mass[] = {0.2, 0.7};
  for (int i = 0; i < 2; i++) {
    rig r;
    rig_open(&r, walls[i]);
    r.setup.arm = (ethd_arm){ETHD_ARM_PARALLEL, 0.25, 0.25};
    r.setup.dynamics = (ethd_dynamics){{mass[0], mass[1]}, 0, 0, 0};
    ethd_setup_transition(&r.setup, &spying);
    rig_start(&r);
    motion m = finger_at(0.25);
    rig_step(&r, &m);
    ck_assert_double_eq_tol(seen.mass, mass[i], 1e-9);
    rig_close(&r);
  }
}

/* Links of other lengths: a mass at the end of each adds 1/m of its share of the way, sin^2 q along x. */
TEST(test_mass_of_unequal_links) {
  const ethd_arm arms[] = {{ETHD_ARM_PARALLEL, 0.3, 0.2}, {ETHD_ARM_PARALLEL, 0.21, 0.34}};
  for (int i = 0; i < 2; i++) {
    rig r;
    open_spied(&r);
    r.setup.arm = arms[i];
    r.setup.dynamics = (ethd_dynamics){{0.2, 0.7}, 0, 0, 0};
    rig_start(&r);
    motion m = finger_at(0.25);
    rig_step(&r, &m);
    double s1 = sin(r.trace.sense.q[0]), s2 = sin(r.trace.sense.q[1]);
    ck_assert_double_eq_tol(1 / seen.mass, s1 * s1 / 0.2 + s2 * s2 / 0.7, 1e-9);
    rig_close(&r);
  }
}

/* The finger's acceleration is the filter's where it filters, along n, and only with a model that has one. */
TEST(test_acceleration) {
  const struct {
    ethd_filter_method method;
    bool measured, known;
  } cases[] = {{ETHD_FILTER_CA, false, true}, {ETHD_FILTER_CA, true, false}, {ETHD_FILTER_CV, false, false}};
  for (int c = 0; c < 3; c++) {
    rig r;
    open_spied(&r);
    ethd_setup_filter(&r.setup, cases[c].method);
    rig_start(&r);
    motion m = finger_at(0.25);
    ethd_sense s = rig_sense(&r.setup.arm, &m);
    for (int i = 0; i < 25; i++) {
      s.have = ETHD_HAVE_DQ | ETHD_HAVE_CENTRE;
      s.centre[0] = -0.5 * 10 * 1e-6 * i * i; /* 10 m/s2 to -x, along n */
      s.centre[1] = 0;
      s.time_ns = s.sample_ns = 1000000 * (int64_t)(i + 1);
      ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    }
    if (cases[c].measured) rig_step(&r, &m);
    if (cases[c].known) ck_assert_double_eq_tol(seen.finger_a, 10, 5);
    if (!cases[c].known) ck_assert(isnan(seen.finger_a));
    rig_close(&r);
  }
}
