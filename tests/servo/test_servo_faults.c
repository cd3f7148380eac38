/* The servo's rows of the fault table, in lock-step: answers that are missing, old or wrong, a drive's faults, a connection that is
   lost, a loop that ends. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "servo/driven.h"

/* ---- rows of the fault table ---- */

TEST(test_missing_once) {
  start_device();
  for (int i = 0; i < 20; i++) ck_assert_int_eq(tick(0.1, 0), ETHD_OK);
  spoil(1, MOCK_DROP, 0);
  ck_assert_int_eq(tick(0.1, 0), ETHD_STATUS_STALE); /* the loop holds its torque, and knows no new fault */
  ck_assert_int_eq(sense.faults | sense.grave, 0);
  ck_assert_int_eq(tick(0.1, 0), ETHD_OK);
  ck_assert_int_eq(sense.faults, ETHD_FAULT_BIT(ETHD_FAULT_REPLY_MISSING));
  ck_assert_int_eq(tick(0.1, 0), ETHD_OK);
  ck_assert_int_eq(sense.faults, 0);
  ck_assert_int_eq(raw(MOCK_TORQUE1), (int)lrint(0.1 * NM));
  close_device();
}

TEST(test_drive_fault) {
  start_device();
  for (int i = 0; i < 20; i++) tick(0.1, 0);
  drive.words[MOCK_CONTROL] = drive.words[MOCK_STATUS] = 0; /* disabled by itself is a fault, too */
  ck_assert_int_eq(ticks_until(ETHD_FAULT_DRIVE, 5), 1);
  servo->safe(device); /* and a fault bit alone, when nothing is enabled */
  for (int i = 0; i < 5; i++) tick(0, 0);
  ck_assert(!shows(ETHD_FAULT_DRIVE));
  drive.words[MOCK_STATUS] = 1;
  ck_assert_int_eq(ticks_until(ETHD_FAULT_DRIVE, 5), 1);
  close_device();
}

/* A fault that stays until the drive is told to leave it: without [clear] it could never be acknowledged. */
TEST(test_clear) {
  start_device();
  for (int i = 0; i < 20; i++) tick(0.1, 0);
  drive.words[MOCK_STATUS] |= 1;
  ck_assert_int_eq(ticks_until(ETHD_FAULT_DRIVE, 5), 1);
  servo->safe(device);
  for (int i = 0; i < 200; i++) {
    tick(0, 0);
    ck_assert(shows(ETHD_FAULT_DRIVE));
  }
  servo->clear(device);
  for (int i = 0; i < 5; i++) tick(0, 0);
  for (int i = 0; i < 1100; i++) {
    tick(0, 0);
    ck_assert_int_eq(sense.faults, 0);
  }
  ck_assert_int_eq(raw(MOCK_STATUS), 0); /* cleared, and not enabled by it */
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  ck_assert_str_eq(servo->why(device), "");
  servo->clear(device); /* while it is enabled nothing is written */
  for (int i = 0; i < 20; i++) ck_assert_int_eq(tick(0.1, 0), ETHD_OK);
  ck_assert_int_eq(raw(MOCK_CONTROL), 1);
  close_device();
}

/* Why a start failed is said. */
TEST(test_why) {
  start_device();
  servo->safe(device);
  for (int i = 0; i < 5; i++) tick(0, 0);
  drive.stuck = 700;
  ck_assert_int_eq(servo->start(device), ETHD_E_DEVICE);
  ck_assert_msg(strstr(servo->why(device), "still holds an old set-point"), "%s", servo->why(device));
  close_device();
}

/* ---- lost and found ---- */

static void connect_again(void) {
  for (int i = 0; i < 3000 && ((ethd__servo_device *)device)->link.state != ETHD__SERVO_IDENTIFIED; i++) {
    tick(0.5, 0.5);
    usleep(100);
  }
  ck_assert_int_eq(((ethd__servo_device *)device)->link.state, ETHD__SERVO_IDENTIFIED);
}

/* ETHD_SERVO_PLUGS times, 10 without. */
TEST(test_unplugged) {
  const char *given = getenv("ETHD_SERVO_PLUGS");
  const int plugs = given ? atoi(given) : 10;
  start_device();
  for (int k = 0; k < plugs; k++) {
    for (int i = 0; i < 5; i++) tick(0.5, 0);
    ck_assert_int_eq(raw(MOCK_TORQUE1), (int)lrint(0.5 * NM));
    mock_unplug(&drive);
    ck_assert_int_le(ticks_until(ETHD_FAULT_LINK_LOST, 4), 2);
    ck_assert_int_eq(last, ETHD_STATUS_STALE);
    mock_plug(&drive);
    connect_again();
    /* back, seeing, and never enabled by itself: zero torque whatever the loop writes */
    for (int i = 0; i < 20; i++) {
      ck_assert_int_eq(tick(0.5, 0.5), ETHD_OK);
      ck_assert_int_eq(raw(MOCK_TORQUE1) | raw(MOCK_TORQUE2), 0);
    }
    ck_assert(!shows(ETHD_FAULT_LINK_LOST));
    ck_assert_int_eq(servo->start(device), ETHD_OK);
  }
  ck_assert_uint_eq(((ethd__servo_device *)device)->link.counts.lost, (uint64_t)plugs);
  close_device();
}

/* The first set-point of a connection is zero, also where the drive goes on with the old one by itself. */
TEST(test_first_is_zero) {
  mock_start(&drive, 0);
  drive.words[MOCK_TORQUE1] = 1234;
  drive.words[MOCK_CONTROL] = 1;
  drive.words[MOCK_STATUS] = 2;
  ethd_setting settings[] = {{"map", "plant.map", 1}, {"port", drive.port, 2}};
  ck_assert_msg(open_with(settings, 2) == ETHD_OK, "%s", message);
  ck_assert_int_eq(raw(MOCK_TORQUE1), 0);
  close_device();
}

TEST(test_old_set_point) {
  start_device();
  for (int i = 0; i < 5; i++) tick(0.5, 0);
  servo->safe(device);
  for (int i = 0; i < 5; i++) tick(0.5, 0);
  ck_assert_int_eq(raw(MOCK_CONTROL) | raw(MOCK_TORQUE1), 0);
  drive.stuck = 700;
  ck_assert_int_eq(servo->start(device), ETHD_E_DEVICE);
  ck_assert_int_eq(raw(MOCK_CONTROL), 0); /* nothing was enabled */
  ck_assert_int_eq(ticks_until(ETHD_FAULT_SET_POINT, 5), 1);
  drive.stuck = 0;
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  ck_assert_int_eq(raw(MOCK_CONTROL), 1);
  tick(0, 0);
  ck_assert(!shows(ETHD_FAULT_SET_POINT));
  close_device();
}

TEST(test_safe) {
  start_device();
  for (int i = 0; i < 5; i++) tick(0.5, 0);
  servo->safe(device);
  tick(0.5, 0);
  ck_assert_int_eq(raw(MOCK_TORQUE1), 0);
  for (int i = 0; i < 5; i++) tick(0.5, 0);
  ck_assert_int_eq(raw(MOCK_CONTROL) | raw(MOCK_STATUS) | raw(MOCK_TORQUE1), 0);
  /* started anew; what the loop wrote before that counts no more */
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  now += TICK;
  (void)!servo->service(device, 0, now);
  ck_assert_int_eq(raw(MOCK_TORQUE1), 0);
  close_device();
}

/* Nothing comes from the loop: its last torque doesn't stay. */
TEST(test_loop_gone) {
  start_device();
  for (int i = 0; i < 5; i++) tick(0.5, 0);
  for (int i = 0; i < 5; i++) (void)!servo->service(device, 0, now += TICK);
  ck_assert_int_ne(raw(MOCK_TORQUE1), 0);
  (void)!servo->service(device, 0, now += TICK);
  ck_assert_int_eq(raw(MOCK_TORQUE1), 0);
  close_device();
}

static void *serve_once(void *unused) {
  (void)unused;
  (void)!servo->service(device, 0, now + TICK);
  return NULL;
}

static mock_act hold_all(void *user, uint64_t n, int function) {
  (void)user, (void)n, (void)function;
  return (mock_act){MOCK_HOLD, 0, 0};
}

/* While an exchange waits for its answer, the control thread's calls return. */
TEST(test_never_waits) {
  pthread_t thread;
  start_device();
  tick(0, 0);
  drive.act = hold_all;
  pthread_create(&thread, NULL, serve_once, NULL);
  while (!atomic_load(&drive.holding)) usleep(100);
  for (int i = 0; i < 10000; i++) {
    const ethd_command command = {{0.1, 0}, 0, 0};
    ck_assert_int_eq(servo->read(device, now, &sense), ETHD_STATUS_STALE);
    ck_assert_int_eq(servo->write(device, now, &command), ETHD_OK);
    servo->safe(device);
  }
  drive.act = (mock_plan)0;
  mock_release(&drive);
  pthread_join(thread, NULL);
  close_device();
}

TEST(test_figures) {
  ethd_figure figures[ETHD_FIGURES_MAX];
  start_device();
  for (int i = 0; i < 100; i++) tick(0, 0);
  uint32_t n = servo->figures(device, figures, ETHD_FIGURES_MAX);
  ck_assert_uint_ge(n, 12);
  for (uint32_t i = 0; i < n; i++) ck_assert(figures[i].name && figures[i].unit && isfinite(figures[i].value));
  ck_assert_double_ge(figures[0].value, 100);
  ck_assert_uint_eq(servo->figures(device, figures, 3), 3);
  ck_assert_ptr_null(servo->remark(device, 0));
  close_device();
}

FIXTURE(driven_set_up, driven_tear_down)
