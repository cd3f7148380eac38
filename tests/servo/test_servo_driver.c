/* The servo as the loop sees it, in lock-step on a virtual clock, with a drive of our own behind a real connection: torques,
   positions, readings, settings. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "clock.h"
#include "servo/driven.h"

/* ---- what goes and comes ---- */

TEST(test_goes_and_comes) {
  start_device();
  drive.words[MOCK_POSITION1] = 0xFFFF;
  drive.words[MOCK_POSITION1 + 1] = 0xFFFE;
  drive.words[MOCK_POSITION2 + 1] = 100;
  ck_assert_int_eq(tick(0.5, -0.25), ETHD_OK);
  ck_assert_double_eq_tol(sense.q[0], -2 * COUNT, 1e-15);
  ck_assert_double_eq_tol(sense.q[1], 100 * COUNT, 1e-15);
  ck_assert_int_eq(sense.time_ns, now);
  ck_assert_int_eq(sense.faults, 0);
  ck_assert_int_eq(tick(0, 0), ETHD_OK);
  ck_assert_int_eq(raw(MOCK_TORQUE1), (int)lrint(0.5 * NM)); /* a tick of age */
  ck_assert_int_eq(raw(MOCK_TORQUE2), (int)lrint(-0.25 * NM));
  tick(100, -100); /* the map's limits */
  tick(0, 0);
  ck_assert_int_eq(raw(MOCK_TORQUE1), 2000);
  ck_assert_int_eq(raw(MOCK_TORQUE2), -2000);
  ck_assert_double_eq_tol(servo->limits(device).torque, 0.2 * 9.8, 1e-12);
  ck_assert(servo->limits(device).gap == ethd_limits_device().gap &&
            servo->limits(device).clean_time == 1); /* a real device */
  ck_assert_int_eq(servo->stop(device), ETHD_OK);
  ck_assert_int_eq(raw(MOCK_TORQUE1) | raw(MOCK_CONTROL) | raw(MOCK_STATUS), 0);
  close_device();
}

/* Virtual instants stay what they are, also where they happen to be near the system's: nothing waits, and what is
   read is stamped with the tick's own. */
TEST(test_virtual_near_the_clock) {
  start_device();
  now = ethd__clock_now() - 20 * TICK;
  for (int i = 0; i < 20; i++) {
    ck_assert_int_eq(tick(0, 0), ETHD_OK);
    ck_assert_int_eq(sense.time_ns, now);
  }
  close_device();
}

static void place(int64_t count) {
  drive.words[MOCK_POSITION1] = (uint16_t)(count >> 16);
  drive.words[MOCK_POSITION1 + 1] = (uint16_t)count;
}

static void set_float(int at, float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  drive.words[at] = (uint16_t)(bits >> 16);
  drive.words[at + 1] = (uint16_t)bits;
}

/* A finger's place relative to the ring, 2.5 ms old, once for each count of readings. */
TEST(test_reading) {
  start_device();
  ck_assert_int_eq(tick(0, 0), ETHD_OK);
  set_float(MOCK_READING_X, 0.00125f);
  set_float(MOCK_READING_Y, -0.0035f);
  drive.words[MOCK_READING_AGE] = 2500;
  drive.words[MOCK_READING_COUNT] = 1;
  ck_assert_int_eq(tick(0, 0), ETHD_OK);
  ck_assert(sense.have & ETHD_HAVE_CENTRE);
  ck_assert_double_eq(sense.centre[0], (double)0.00125f);
  ck_assert_double_eq(sense.centre[1], (double)-0.0035f);
  ck_assert_int_eq(sense.sample_ns, now - 2500000);
  ck_assert_int_eq(tick(0, 0), ETHD_OK);
  ck_assert(!(sense.have & ETHD_HAVE_CENTRE));
  /* the next one's age says that it is older: readings come in their order all the same */
  int64_t before = now - TICK - 2500000;
  drive.words[MOCK_READING_AGE] = 5000;
  drive.words[MOCK_READING_COUNT] = 2;
  ck_assert_int_eq(tick(0, 0), ETHD_OK);
  ck_assert(sense.have & ETHD_HAVE_CENTRE);
  ck_assert_int_eq(sense.sample_ns, before + 1);
  close_device();
}

TEST(test_unwraps) {
  mock_start(&drive, 0);
  ethd_setting settings[] = {{"map", "plant.map", 1}, {"port", drive.port, 2}};
  place(2147483000);
  ck_assert_msg(open_with(settings, 2) == ETHD_OK, "%s", message);
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  now = 0;
  for (int64_t count = 2147483000; count < 2147485000; count += 100) {
    place(count);
    ck_assert_int_eq(tick(0, 0), ETHD_OK);
    ck_assert_double_eq_tol(sense.q[0], (double)count * COUNT, 1e-9);
    ck_assert_int_eq(sense.faults, 0);
  }
  close_device();
}

TEST(test_speed_limit) {
  open_device();
  ck_assert_double_eq(servo->limits(device).speed, 1.2);
  close_device();
  mock_start(&drive, 0);
  ethd_setting slow[] = {{"map", "plant.map", 1}, {"port", drive.port, 2}, {"speed", "0.3", 3}};
  ck_assert_msg(open_with(slow, 3) == ETHD_OK, "%s", message);
  ck_assert_double_eq(servo->limits(device).speed, 0.3);
  close_device();
}

TEST(test_home) {
  mock_start(&drive, 0);
  drive.words[MOCK_POSITION1 + 1] = 500;
  ethd_setting home[] = {{"map", "plant.map", 1}, {"port", drive.port, 2}, {"q1", "0.7", 3}, {"q2", "-0.3", 4}};
  ck_assert_msg(open_with(home, 4) == ETHD_OK, "%s", message);
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  tick(0, 0);
  ck_assert_double_eq_tol(sense.q[0], 0.7, 1e-12);
  ck_assert_double_eq_tol(sense.q[1], -0.3, 1e-12);
  close_device();
}

/* A map of one axis, for the second joint. */
TEST(test_joint) {
  const ethd_setting joint = {"joint", "2", 3};
  char *text = map_text();
  for (const char **name = (const char *[]){"[register torque2]", "[register seen2]", "[register position2]",
                                            "[register measured2]", NULL};
       *name; name++) {
    char *from = strstr(text, *name), *to = strchr(from, '\n');
    while (strncmp(to, "\n\n", 2)) to++;
    memset(from, '\n', (size_t)(to - from));
  }
  ck_assert_msg(open_map(text, &joint) == ETHD_OK, "%s", message);
  free(text);
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  drive.words[MOCK_POSITION1 + 1] = 50;
  tick(0.1, 0.2);
  tick(0, 0);
  ck_assert_double_eq_tol(sense.q[1], 50 * COUNT, 1e-12);
  ck_assert_double_eq(sense.q[0], 0);
  ck_assert_int_eq(raw(MOCK_TORQUE1), (int)lrint(0.2 * NM));
  close_device();
}

TEST(test_unconfirmed) {
  ck_assert_msg(open_changed("address = 9\n", "address = 9 ; unconfirmed\n") == ETHD_OK, "%s", message);
  ck_assert_str_eq(servo->remark(device, 0),
                   "1 of 17 registers is unconfirmed: check its address in the drive's manual (step 2)");
  close_device();
}

TEST(test_settings_refused) {
  static const struct {
    ethd_setting one;
    const char *why;
  } all[] = {{{"q1", "0", 1}, "d.ini: device.map is missing"},
             {{"map", "no.map", 3}, "no.map: "},
             {{"hurry", "1", 7}, "d.ini:7: device.hurry: servo knows"},
             {{"speed", "inf", 7}, "d.ini:7: device.speed"},
             {{"joint", "3", 8}, "d.ini:8: device.joint: found \"3\", 1|2 is allowed"},
             {{"q1", "x", 9}, "d.ini:9: device.q1"}};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
    ethd_setting one = all[i].one;
    ck_assert_int_lt(open_with(&one, 1), 0);
    ck_assert_ptr_null(device);
    ck_assert_msg(strstr(message, all[i].why) && !strchr(message, '\n'), "%s", message);
  }
  ethd_setting nobody[] = {{"map", "plant.map", 1}, {"port", "127.0.0.1:1", 2}};
  ck_assert_int_eq(open_with(nobody, 2), ETHD_E_DEVICE);
  ck_assert_msg(strstr(message, "127.0.0.1:1: Connection refused") != NULL, "%s", message);
}

/* A drive that answers no question well: one line names its port, and nothing was enabled. */
TEST_LOOP(test_no_good_answer, 0, 6) {
  static const mock_kind kinds[] = {MOCK_DROP, MOCK_CUT, MOCK_GARBLE, MOCK_RESET, MOCK_EXCEPTION, MOCK_EXCEPTION};
  mock_start(&drive, 0);
  ethd_setting settings[] = {{"map", "plant.map", 1}, {"port", drive.port, 2}};
  spoil(UINT32_MAX, kinds[_i], _i == 4 ? 2 : 4);
  ck_assert_int_eq(open_with(settings, 2), ETHD_E_DEVICE);
  ck_assert_ptr_null(device);
  ck_assert_msg(strstr(message, drive.port) && !strchr(message, '\n'), "%s", message);
  ck_assert_uint_gt(drive.requests, 0);
  ck_assert_int_eq(raw(MOCK_CONTROL) | raw(MOCK_TORQUE1) | raw(MOCK_TORQUE2), 0);
  mock_stop(&drive);
}

/* ---- true time ---- */

/* A drive that answers late has read its joints when the question came; the sample isn't stamped after that. */
static _Atomic int64_t latched;

static mock_act answer_late(void *user, uint64_t n, int function) {
  (void)user, (void)n;
  if (function == 16) return (mock_act){MOCK_ANSWER, 0, 0};
  latched = ethd__clock_now();
  return (mock_act){MOCK_LATE, 0, 20000};
}

TEST_LOOP(test_no_sample_looks_younger, 0, 2) {
  is_virtual = 0;
  ck_assert_msg(open_changed("divisor = 1", _i ? "divisor = 1\nexchange = combined" : "divisor = 1") == ETHD_OK, "%s",
                message);
  drive.act = answer_late;
  for (int i = 0; i < 10; i++) {
    int64_t before = ethd__clock_now();
    (void)!servo->service(device, 0, before);
    memset(&sense, 0, sizeof sense);
    ck_assert_int_eq(servo->read(device, ethd__clock_now(), &sense), ETHD_OK);
    ck_assert_int_ge(sense.time_ns, before);
    ck_assert_int_le(sense.time_ns, latched);
  }
  close_device();
}

FIXTURE(driven_set_up, driven_tear_down)
