/* Homing through the loop: only while it is disarmed, and the controller begins anew where the pose may have jumped. */
#include <math.h>
#include <string.h>

#include "unit/bench.h"

static ethd_status answer;
static int homings;
static double given[2];

static ethd_status home(void *d, const double q[2]) {
  (void)d;
  homings++;
  if (q) memcpy(given, q, sizeof given);
  return answer;
}

/* The bench's driver with a home. */
static void open_with_home(bench *b) {
  static ethd_driver driver;
  answer = ETHD_OK;
  homings = 0;
  bench_open(b);
  driver = *b->of_d.at[0].driver;
  driver.home = home;
  device_of(&b->of_d, &driver, &b->d);
  bench_start(b);
}

TEST(test_no_home) {
  bench b;
  bench_open(&b);
  bench_start(&b);
  ethd_loop_disarm(b.loop);
  bench_tick(&b);
  ck_assert_int_eq(ethd_loop_home(b.loop, NULL), ETHD_E_ARGUMENT);
  ck_assert_int_eq(bench_tick(&b).trace.tick, 1);
  bench_close(&b);
}

TEST(test_armed) {
  bench b;
  open_with_home(&b);
  bench_tick(&b);
  ck_assert_int_eq(ethd_loop_home(b.loop, NULL), ETHD_STATUS_BUSY);
  ck_assert_int_eq(homings, 0);
  ethd_loop_row row = bench_tick(&b);
  ck_assert(row.trace.tick == 1 && row.armed == 1);
  bench_close(&b);
}

TEST(test_pose_jumps) {
  const double q[2] = {0.3, -0.4};
  bench b;
  open_with_home(&b);
  bench_tick(&b);
  ethd_loop_disarm(b.loop);
  ck_assert_int_eq(bench_tick(&b).trace.tick, 1);
  ck_assert_int_eq(ethd_loop_home(b.loop, q), ETHD_OK);
  ck_assert(homings == 1 && given[0] == q[0] && given[1] == q[1]);
  ethd_loop_row row = bench_tick(&b);
  ck_assert_int_eq(row.trace.tick, 0);
  ck_assert(row.armed == 0 && b.d.written[2].safe && b.d.starts == 0); /* homed isn't enabled */
  bench_close(&b);
}

/* No driver is told an angle that no joint can have. */
TEST(test_no_angles) {
  const double bad[] = {NAN, INFINITY, -INFINITY, -1.001 * ETHD_SENSE_ANGLE_MAX};
  bench b;
  open_with_home(&b);
  ethd_loop_disarm(b.loop);
  bench_tick(&b);
  for (int i = 0; i < 8; i++) {
    double q[2] = {0.3, -0.4};
    q[i % 2] = bad[i / 2];
    ck_assert_int_eq(ethd_loop_home(b.loop, q), ETHD_E_RANGE);
  }
  ck_assert_int_eq(homings, 0);
  ck_assert_int_eq(bench_tick(&b).trace.tick, 1);
  bench_close(&b);
}

TEST(test_home_fails) {
  bench b;
  open_with_home(&b);
  ethd_loop_disarm(b.loop);
  bench_tick(&b);
  answer = ETHD_E_DEVICE;
  ck_assert_int_eq(ethd_loop_home(b.loop, NULL), ETHD_E_DEVICE);
  ck_assert_int_eq(homings, 1);
  ck_assert_int_eq(bench_tick(&b).trace.tick, 1);
  bench_close(&b);
}

/* What the controller knows of a fault stays until somebody acknowledges it. */
TEST(test_fault_stays) {
  bench b;
  open_with_home(&b);
  b.d.fail_read = 1;
  bench_tick(&b);
  ck_assert_int_eq(bench_tick(&b).trace.fault, ETHD_FAULT_INPUT);
  ck_assert_int_eq(ethd_loop_home(b.loop, NULL), ETHD_OK);
  ethd_loop_row row = bench_tick(&b);
  ck_assert_int_eq(row.trace.fault, ETHD_FAULT_INPUT);
  ck_assert_int_eq(row.trace.tick, 2);
  bench_close(&b);
}
