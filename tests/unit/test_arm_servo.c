/* Joints that follow: the answer to a step of the commanded speed, in closed form. */
#include "arm/servo.h"

#include <math.h>

#include "unit/arm_tables.h"

static ethd__arm_servo servo;

/* v and q at the time t after a step to 1 rad/s reached a joint of frequency w and damping z. */
static void answer(double w, double z, double t, double *v, double *q) {
  *v = *q = 0;
  if (t <= 0) return;
  if (z == 1) {
    *v = 1 - (1 + w * t) * exp(-w * t);
    *q = t - 2 / w + (t + 2 / w) * exp(-w * t);
    return;
  }
  const double turn = w * sqrt(1 - z * z), e = exp(-z * w * t), c = cos(turn * t), s = sin(turn * t);
  *v = 1 - e * (c + z * w / turn * s);
  *q = t - 2 * z / w + e / w * (2 * z * c + (2 * z * z - 1) * w / turn * s);
}

TEST_LOOP(test_step, 0, 6) {
  const double delays[] = {0, 0.008, 0.0333}, T = 0.002;
  ethd__arm_table table;
  arm_table("planar", "", &table);
  table.limits.period = T;
  table.servo.delay = delays[_i / 2];
  table.servo.damping = _i % 2 ? 1 : 0.6;
  table.servo.frequency = 130;
  const double start[2] = {0.5, -1}, u[2] = {1, -3};
  ethd__arm_servo_start(&table, start, &servo);
  for (int k = 1; k <= 200; k++) {
    double v, q;
    ethd__arm_servo_step(&servo, u);
    answer(130, table.servo.damping, k * T - table.servo.delay, &v, &q);
    for (int i = 0; i < 2; i++) {
      ck_assert_double_eq_tol(servo.joint[i].v, u[i] * v, 1e-12);
      ck_assert_double_eq_tol(servo.joint[i].q, start[i] + u[i] * q, 1e-12);
    }
  }
}

/* What was commanded arrives in the end: the joint stands where the speeds commanded add up to. */
TEST(test_adds_up) {
  ethd__arm_table table;
  arm_table("ur5e", "", &table);
  ethd__arm_servo_start(&table, table.posture, &servo);
  double sum = 0;
  for (int k = 0; k < 700; k++) {
    double u[6] = {k < 300 ? sin(0.1 * k) + 0.2 : 0};
    sum += u[0] * table.limits.period;
    ethd__arm_servo_step(&servo, u);
  }
  ck_assert_double_gt(sum, 0.1);
  ck_assert_double_eq_tol(servo.joint[0].q, table.posture[0] + sum, 1e-13);
  ck_assert_double_eq_tol(servo.joint[0].v, 0, 1e-13);
}

TEST(test_brakes) {
  ethd__arm_table table;
  arm_table("ur5e", "", &table);
  ethd__arm_servo_start(&table, table.posture, &servo);
  const double u[6] = {1, 1, 1, 1, 1, 1}, zero[6] = {0};
  for (int k = 0; k < 100; k++) ethd__arm_servo_step(&servo, u);
  const double q = servo.joint[3].q;
  ck_assert_double_gt(q, table.posture[3] + 0.1);
  ethd__arm_servo_brake(&servo);
  for (int k = 0; k < 100; k++) ethd__arm_servo_step(&servo, zero);
  ck_assert(servo.joint[3].q == q && servo.joint[3].v == 0);
}
