/* What a device says of its last command and of its samples' ages, against controllers that needn't be told. */
#include <math.h>

#include "ethd/space.h"
#include "unit/mover.h"
#include "unit/rig.h"

#define RATE 20.0 /* Nm/s */

/* The limit of the rate starts from what the device says, as far as that is from the last command. */
TEST(test_commanded_in_the_plane) {
  static const double told[][2] = {{0, 0}, {0.5, -0.25}, {-1, 1}};
  rig r;
  rig_open(&r, RIG_WALL);
  r.setup.limits.torque_rate = RATE;
  rig_start(&r);
  for (int k = 0; k < 60; k++) {
    const motion m = rig_at(-0.003, 0, 0.004);
    ethd_sense s = rig_sense(&r.setup.arm, &m);
    s.time_ns = 1000000 * k;
    if (k % 2) {
      s.have |= ETHD_HAVE_COMMANDED;
      memcpy(s.commanded, told[k / 2 % 3], sizeof s.commanded);
    }
    const ethd_trace before = r.trace;
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    for (int i = 0; i < 2; i++) {
      const double from = k % 2 ? s.commanded[i] : k ? before.tau[i] : 0;
      const double wanted = fmin(fmax(r.trace.tau_raw[i], from - RATE * 1e-3), from + RATE * 1e-3);
      ck_assert_double_eq_tol(r.trace.tau[i], wanted, 1e-15);
    }
  }
  rig_close(&r);
}

/* What acts is what the device says: an observer of the ring, which predicts by it, sees no disturbance. */
TEST(test_commanded_in_the_facts) {
  rig r;
  rig_open(&r, NULL);
  r.setup.limits.nominal_torque = 0.1;
  r.setup.limits.heat_time = 0.01;
  rig_start(&r);
  const motion m = {.x = {0.25, 0.25}, .xf = {0.25, 0.25}};
  for (int k = 0; k < 40; k++) { /* the controller asks for nothing; what the drive gives all the same heats it */
    ethd_sense s = rig_sense(&r.setup.arm, &m);
    s.time_ns = 1000000 * k;
    s.have |= ETHD_HAVE_COMMANDED;
    s.commanded[1] = 0.08;
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  }
  double heat[2];
  ethd_control_heat(r.control, heat);
  ck_assert_double_eq(heat[0], 0);
  ck_assert_double_eq_tol(heat[1], 0.64 * (1 - exp(-40 * 1e-3 / 0.01)), 1e-12);
  rig_close(&r);
}

/* Joints that turn evenly, each sampled at another time, stand where both are at the sense's instant. */
TEST_LOOP(test_ages, 0, 2) {
  const bool has_speed = _i;
  rig r, twin;
  rig_open(&r, NULL);
  ethd_setup_velocity(&r.setup, ETHD_VELOCITY_DIFFERENCE);
  twin = r;
  rig_start(&r);
  rig_start(&twin);
  for (int k = 0; k < 50; k++) {
    const double t = 1e-3 * k, age[2] = {1e-4 * (k * 7 % 9), 1e-4 * (k * 5 % 8)};
    ethd_sense s = {.time_ns = 1000000 * k, .have = has_speed ? ETHD_HAVE_DQ : 0, .dq = {0.7, -0.4}};
    s.q[0] = 1.5 + 0.7 * t;
    s.q[1] = 0.1 - 0.4 * t;
    ck_assert_int_eq(rig_try(&twin, &s), ETHD_OK);
    s.have |= ETHD_HAVE_AGE;
    for (int i = 0; i < 2; i++) s.age[i] = age[i], s.q[i] -= s.dq[i] * age[i];
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    if (k < 2) continue; /* a difference needs two samples */
    for (int i = 0; i < 2; i++) {
      ck_assert_double_eq_tol(r.trace.qd[i], s.dq[i], 1e-10);
      ck_assert_double_eq_tol(r.trace.x[i], twin.trace.x[i], 1e-12);
      ck_assert_double_eq_tol(r.trace.v[i], twin.trace.v[i], 1e-10);
    }
  }
  rig_close(&r);
  rig_close(&twin);
}

/* A joint whose sample comes again stands still, as far as anybody knows. */
TEST(test_age_of_a_sample_that_comes_again) {
  rig r;
  rig_open(&r, NULL);
  ethd_setup_velocity(&r.setup, ETHD_VELOCITY_DIFFERENCE);
  rig_start(&r);
  for (int k = 0; k < 9; k++) {
    ethd_sense s = {.time_ns = 1000000 * k, .have = ETHD_HAVE_AGE, .q = {1.5 + 1e-3 * (k & ~1), 0.1}};
    s.age[0] = 1e-3 * (k & 1);
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    if (k > 1) ck_assert_double_eq_tol(r.trace.qd[0], k & 1 ? 0 : 1, 1e-9);
  }
  rig_close(&r);
}

TEST(test_impossible_reports) {
  static const double bad[] = {NAN, INFINITY, -INFINITY, 1e7};
  for (int k = 0; k < 20; k++) {
    rig r;
    rig_begin(&r, NULL, NULL);
    ethd_sense s = {.have = k % 5 == 4 || k < 8 ? ETHD_HAVE_AGE : ETHD_HAVE_COMMANDED, .q = {1.5, 0.1}};
    double *number = s.have & ETHD_HAVE_AGE ? &s.age[k & 1] : &s.commanded[k & 1];
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    *number = k % 5 == 4 ? -1e-9 : bad[k % 4];
    ck_assert_int_eq(rig_try(&r, &s), ETHD_E_NOT_FINITE);
    ck_assert(r.command.safe && r.command.torque[0] == 0 && r.command.torque[1] == 0);
    const ethd_event e = rig_poll(&r);
    ck_assert(e.code == ETHD_FAULT_INPUT && e.value == (double)s.have);
    rig_close(&r);
  }
}

/* In space the acceleration starts from what the device says. */
TEST(test_commanded_in_space) {
  ethd_space_setup setup = ethd_space_setup_default();
  setup.acceleration = 5;
  ethd_space *space = made(&setup);
  ethd_vec3 last = {0, 0, 0};
  for (int k = 0; k < 200; k++) {
    ethd_space_sense s = {.time_ns = 1000000 * k, .have = ETHD_SPACE_HAVE_FINGER, .finger = {10, 0, 0}};
    ethd_space_command command;
    if (k % 3 == 2) { /* the device gave half of it */
      last = ethd_vec3_scale(0.5, last);
      s.have |= ETHD_SPACE_HAVE_COMMANDED;
      ethd_vec3_put(last, s.commanded);
    }
    ck_assert_int_eq(ethd_space_step(space, &s, NULL, 0, &command, NULL), ETHD_OK);
    ck_assert_double_eq_tol(command.value[0], last.x + 5e-3, 1e-15);
    last = ethd_vec3_of(command.value);
  }
  ethd_space_sense s = {.have = ETHD_SPACE_HAVE_FINGER | ETHD_SPACE_HAVE_COMMANDED, .commanded = {0, NAN, 0}};
  ethd_space_command command;
  ck_assert_int_eq(ethd_space_step(space, &s, NULL, 0, &command, NULL), ETHD_E_NOT_FINITE);
  ck_assert(command.safe && command.value[0] == 0);
  ethd_space_destroy(space);
}
