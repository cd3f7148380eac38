/* One tick of a number that can't be, or that is finite but enormous: what the next ticks do. */
#include <math.h>

#include "unit/moody.h"

static void begin(rig *r, ethd_velocity_method method, double torque_rate) {
  moody_open(r, 0);
  ethd_control_destroy(r->control);
  ethd_setup_velocity(&r->setup, method);
  r->setup.limits.torque_rate = torque_rate;
  rig_start(r);
}

/* Beside the wall, a tick later than the last. */
static ethd_status tick(rig *r, double q) {
  motion m = rig_at(0.01, 0, 0);
  ethd_sense s = rig_sense(&r->setup.arm, &m);
  s.time_ns = r->sense.time_ns + 1000000;
  s.have &= ~(int64_t)ETHD_HAVE_DQ;
  s.q[0] += q;
  return rig_try(r, &s);
}

/* A torque that was taken away at once rises from zero at the rate's pace, also where nothing latches: 100 Nm/s over
   the two periods since the last torque. */
TEST(test_rises_from_zero) {
  rig r;
  begin(&r, ETHD_VELOCITY_DIFFERENCE, 100);
  mood.tracking = MOODY_BAD;
  mood.value = 1;
  for (int i = 0; i < 20; i++) ck_assert_int_eq(tick(&r, 0), ETHD_OK);
  ck_assert_double_eq(r.command.torque[1], 1);
  ck_assert_int_eq(tick(&r, (double)NAN), ETHD_E_NOT_FINITE);
  moody_expect_safe(&r, ETHD_E_NOT_FINITE, ETHD_FAULT_INPUT);
  ck_assert_int_eq(tick(&r, 0), ETHD_OK);
  ck_assert_double_eq_tol(r.command.torque[1], 0.2, 1e-12);
  ck_assert_int_eq(tick(&r, 0), ETHD_OK);
  ck_assert_double_eq_tol(r.command.torque[1], 0.3, 1e-12);
  rig_close(&r);
}

/* An enormous torque, up to the largest double, where no limit is set: the estimator that takes it for the arm's
   acceleration is itself again a few ticks later. */
static const double enormous[] = {1e100, 1e306, 1.7e308};
enum { ENORMOUS = sizeof enormous / sizeof *enormous };

TEST_LOOP(test_estimator_heals, 0, ETHD_VELOCITY_COUNT *ENORMOUS) {
  const double torque = enormous[_i % ENORMOUS];
  rig r;
  begin(&r, (ethd_velocity_method)(_i / ENORMOUS), (double)INFINITY);
  for (int i = 0; i < 20; i++) ck_assert_int_eq(tick(&r, 0), ETHD_OK);
  mood.tracking = MOODY_BAD;
  mood.value = torque;
  (void)tick(&r, 0);
  ck_assert_double_eq(r.command.torque[1], torque);
  mood.tracking = MOODY_WELL;
  (void)tick(&r, 0);
  for (int i = 0; i < 5; i++) (void)tick(&r, 0);
  ck_assert_int_eq(r.status, ETHD_OK);
  ck_assert_double_eq_tol(r.trace.qd[0], 0, 1e-6);
  ck_assert_double_eq_tol(r.trace.qd[1], 0, 1e-6);
  ck_assert(isfinite(r.command.torque[0]) && fabs(r.command.torque[1]) < 1);
  rig_close(&r);
}
