/* The guard's stops, through the controller. */
#include <math.h>
#include <string.h>

#include "unit/moody.h"

/* Too fast: braked at once, whatever the rate limit; still: nothing, and only then safe. */
START_TEST(test_speed) {
  rig r;
  moody_open(&r, 1);
  r.setup.limits.speed = 0.5;
  r.setup.limits.torque_rate = 1e-3;
  rig_post(&r);
  motion m = rig_at(0.020, 0.4, 0);
  ethd_sense s = rig_sense(&r.setup.arm, &m);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  m = rig_at(0.020, 0.6, 0); /* F = 6 N in x */
  s = rig_sense(&r.setup.arm, &m);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_E_RANGE);
  ck_assert_double_eq_tol(r.command.torque[0], -0.6 * MOODY_PROBE * 0.25, 0.01); /* dx/dq1 = -y = -0.25 m */
  ck_assert(r.command.safe == 0 && r.trace.guard == ETHD_GUARD_SPEED && r.trace.fault == ETHD_FAULT_SPEED);
  m = rig_at(0.020, 0.3, 0); /* slower than the limit, and still stopping */
  s = rig_sense(&r.setup.arm, &m);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_E_RANGE);
  ck_assert_double_eq_tol(r.command.torque[0], -0.3 * MOODY_DAMPING * 0.25, 0.05);
  m = rig_at(0.020, 0.019, 0);
  s = rig_sense(&r.setup.arm, &m);
  rig_try(&r, &s);
  moody_expect_safe(&r, ETHD_E_RANGE, ETHD_FAULT_SPEED);
  m = rig_at(0.020, 0.3, 0); /* moved by hand: nothing any more */
  s = rig_sense(&r.setup.arm, &m);
  rig_try(&r, &s);
  moody_expect_safe(&r, ETHD_E_RANGE, ETHD_FAULT_SPEED);
  moody_expect_event(&r, ETHD_EVENT_TAKEN, 0, 0);
  moody_expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_SPEED, NAN);
  ethd_control_acknowledge(r.control);
  m = rig_at(0.020, 0.3, 0.001);
  s = rig_sense(&r.setup.arm, &m);
  for (int i = 0; i < 300; i++) ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  ck_assert_double_eq_tol(r.command.torque[0], 299e-6, 1e-12); /* follows again, at the rate's pace */
  rig_close(&r);
}
END_TEST

START_TEST(test_workspace) {
  rig r;
  moody_open(&r, 0);
  r.setup.limits.workspace[0] = 0.24;
  rig_post(&r);
  motion m = rig_at(-0.009, 0.1, 0);
  ethd_sense s = rig_sense(&r.setup.arm, &m);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  m = rig_at(-0.0101, 0.1, 0);
  s = rig_sense(&r.setup.arm, &m);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_E_RANGE);
  ck_assert(r.trace.fault == ETHD_FAULT_WORKSPACE && r.trace.guard == ETHD_GUARD_WORKSPACE);
  ck_assert_double_lt(r.command.torque[0], 0); /* against the motion */
  m = rig_at(-0.009, 0.1, 0);
  s = rig_sense(&r.setup.arm, &m);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  rig_close(&r);
}
END_TEST

int main(void) {
  Suite *suite = suite_create("fault_stop");
  TCase *t = tcase_create("fault_stop");
  tcase_add_test(t, test_speed);
  tcase_add_test(t, test_workspace);
  suite_add_tcase(suite, t);
  return rig_run(suite);
}
