/* The servo on slow buses, through the loop: any divisor, a wire that is too slow, slow registers, a camera behind the drive. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "servo/driven.h"
#include "unit/device_of.h"

/* ---- slow buses ---- */

static ethd_control *control;
static ethd_loop *loop;
static ethd_device driven; /* the servo, whose I/O may stand still */

static void open_loop(void) {
  ethd_loop_def def = ethd_loop_default();
  ethd_error error;
  ethd_limits own = servo->limits(device);
  setup.limits = ethd_limits_narrower(&own, &setup.limits);
  device_of(&driven, servo, device);
  def.device = &driven;
  def.clock = &now;
  def.gap = setup.limits.gap;
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  ck_assert_int_eq(ethd_control_create(&setup, &control, &error), ETHD_OK);
  def.control = control;
  ck_assert_int_eq(ethd_loop_create(&def, &loop, &error), ETHD_OK);
  ck_assert_int_eq(ethd_loop_start(loop, &error), ETHD_OK);
}

static void close_loop(void) {
  ethd_loop_destroy(loop);
  ethd_control_destroy(control);
}

static int64_t rows_seen(void) {
  ethd_loop_stats stats;
  int64_t rows = 0;
  ethd_loop_read(loop, &stats);
  for (int i = 1; i < ETHD_FAULT_COUNT; i++)
    if (stats.faults[i]) rows |= ETHD_FAULT_BIT(i);
  return rows;
}

/* s of the loop until the device had all of the torque, by its rows. */
static double soft_start(void) {
  static double whole;
  ethd_loop_row row;
  int64_t ticks = 0;
  while (ethd_loop_take(loop, &row) == ETHD_OK) {
    ticks += 1 + row.trace.sense.missed;
    if (row.share < 1) whole = 1e-3 * (double)ticks;
  }
  return whole;
}

/* However rarely a bus answers, down to 40 ms twice: the loop lives on it, a missing answer is only counted, and a bus
   that stays silent is row 5 after the larger of 5 ms and two exchanges. */
TEST_LOOP(test_divisors, 1, 21) {
  char line[32];
  int divisor = _i;
  snprintf(line, sizeof line, "divisor = %d", divisor);
  ck_assert_msg(open_changed("divisor = 1", line) == ETHD_OK, "%s", message);
  open_loop();
  for (int i = 0; i < 1500; i++) ethd_loop_tick(loop);
  ck_assert_int_eq(rows_seen(), 0);
  ck_assert(ethd_loop_armed(loop));
  ck_assert_double_ge(soft_start(), 0.099 - 1e-3 * divisor); /* however seldom it steps */
  ck_assert_double_le(soft_start(), 0.1 + 2e-3 * divisor);
  ck_assert_uint_le(((ethd__servo_device *)device)->link.counts.exchanges, (uint64_t)(1500 / divisor + 20));
  ck_assert_uint_ge(((ethd__servo_device *)device)->link.counts.exchanges, (uint64_t)(1500 / divisor));
  spoil(1, MOCK_DROP, 0);
  for (int i = 0; i < 200; i++) ethd_loop_tick(loop);
  ck_assert_int_eq(rows_seen(), ETHD_FAULT_BIT(ETHD_FAULT_REPLY_MISSING));
  ck_assert(ethd_loop_armed(loop));
  driven.at[0].units = 0; /* nothing comes any more, and no true time goes by */
  int n = 0;
  for (; n < 100 && ethd_loop_armed(loop); n++) ethd_loop_tick(loop);
  int bound = 2 * divisor > 5 ? 2 * divisor : 5;
  ck_assert_int_ge(n, bound - divisor);
  ck_assert_int_le(n, bound + 2); /* behind a tick of age, and in the next one */
  ck_assert(rows_seen() & ETHD_FAULT_BIT(ETHD_FAULT_FEEDBACK_OLD));
  close_loop();
  close_device();
}

TEST(test_too_slow) {
  ck_assert_int_eq(open_changed("divisor = 1", "divisor = 26"), ETHD_E_RANGE);
  ck_assert_msg(
      strstr(message, "bus.divisor: found 26, an exchange in 26 ms; at most 25 ms are allowed: choose up to 25"), "%s",
      message);
  mock_stop(&drive);
  ck_assert_msg(open_changed("divisor = 1", "divisor = 25") == ETHD_OK, "%s", message);
  close_device();
}

/* What the wire itself takes is refused before anything is tried. */
TEST(test_wire_too_slow) {
  ck_assert_int_eq(open_changed("transport = tcp", "transport = rtu\nbaud = 115200"), ETHD_E_RANGE);
  ck_assert_msg(strstr(message, "bus.divisor: found 1, an exchange in 1 ms; its 2 messages take") &&
                    strstr(message, "choose from 8, a faster line, or fewer registers"),
                "%s", message);
  mock_stop(&drive);
}

/* A borrowed register counts only as far as does no harm, and still shows an answer of the exchange before. */
TEST(test_small_counter) {
  ck_assert_msg(open_changed("[register counter]  ", "[register counter]\nmax = 3\n#") == ETHD_OK, "%s", message);
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  int seen = 0;
  for (int i = 0; i < 40; i++) {
    ck_assert_int_eq(tick(0.1, 0), ETHD_OK);
    ck_assert_uint_le(drive.words[MOCK_COUNTER], 3);
    seen |= 1 << drive.words[MOCK_COUNTER];
  }
  ck_assert_int_eq(seen, 15);
  spoil(2, MOCK_OLD, 0); /* under the same torque as before */
  ck_assert_int_eq(tick(0.1, 0), ETHD_STATUS_STALE);
  ck_assert_int_eq(tick(0.1, 0), ETHD_OK);
  ck_assert_int_eq(sense.faults, ETHD_FAULT_BIT(ETHD_FAULT_REPLY_STALE));
  close_device();
}

/* A camera at 90 Hz behind the drive: without its rate every reading would be late. */
TEST(test_camera) {
  static const struct {
    const char *key;
    double age;
    int late;
  } all[] = {{"rate = 90\n", 3 / 90.0, 0}, {"", 0.010, 1}};
  for (int k = 0; k < 2; k++) {
    char section[64];
    snprintf(section, sizeof section, "[register reading_count]\n%s", all[k].key);
    ck_assert_msg(open_changed("[register reading_count]\n", section) == ETHD_OK, "%s", message);
    ck_assert_double_eq_tol(servo->limits(device).finger_age, all[k].age, 1e-12);
    ck_assert_double_eq_tol(servo->limits(device).finger_lost, 3 * all[k].age, 1e-12);
    drive.words[MOCK_POSITION1 + 1] = (uint16_t)lrint(0.2 / COUNT); /* a pose that isn't singular */
    drive.words[MOCK_POSITION2 + 1] = (uint16_t)lrint(1.5 / COUNT);
    open_loop();
    int late = 0;
    for (int i = 0; i < 3000; i++) {
      if (i * 90 / 1000 != (i - 1) * 90 / 1000) drive.words[MOCK_READING_COUNT]++;
      drive.words[MOCK_READING_AGE] = (uint16_t)(i * 1000 % 11111 / 1000 * 1000);
      ethd_loop_tick(loop);
    }
    late = (rows_seen() & ETHD_FAULT_BIT(ETHD_FAULT_FINGER_OLD)) != 0;
    ck_assert_int_eq(late, all[k].late);
    close_loop();
    close_device();
  }
}

/* What measures says how often; a servo without a finger says nothing of it. */
TEST(test_no_finger) {
  char *text = map_text(), *from = strstr(text, "[register reading_x]");
  memset(from, '\n', (size_t)(strstr(text, "[enable]") - from));
  ck_assert_msg(open_map(text, NULL) == ETHD_OK, "%s", message);
  free(text);
  ck_assert(isinf(servo->limits(device).finger_age) && isinf(servo->limits(device).finger_lost));
  close_device();
}

/* A slow register costs its question every tenth time, and its row comes so much later. */
TEST(test_every) {
  ck_assert_msg(open_changed("[register bus_voltage]\n", "[register bus_voltage]\nevery = 10\n") == ETHD_OK, "%s",
                message);
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  for (int i = 0; i < 20; i++) tick(0, 0);
  uint64_t before = drive.requests;
  for (int i = 0; i < 100; i++) tick(0, 0);
  /* torques and counter; what stands before the voltage; its own words; what stands behind it */
  ck_assert_uint_eq(drive.requests - before, 100 * 3 + 10);
  int worst = 0;
  for (int k = 0; k < 20; k++) {
    for (int i = 0; i < 10 + k; i++) tick(0, 0);
    ck_assert(!shows(ETHD_FAULT_BUS_VOLTAGE));
    drive.words[MOCK_VOLTAGE] = 230;
    int n = ticks_until(ETHD_FAULT_BUS_VOLTAGE, 20);
    if (n > worst) worst = n;
    drive.words[MOCK_VOLTAGE] = 480;
    for (int i = 0; i < 10; i++) tick(0, 0);
  }
  ck_assert_int_eq(worst, 10);
  close_device();
}

FIXTURE(driven_set_up, driven_tear_down)
