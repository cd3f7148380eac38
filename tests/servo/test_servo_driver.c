/* The servo as the loop sees it, in lock-step on a virtual clock, with a drive of our own behind a real connection. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "clock.h"
#include "ethd/driver.h"
#include "servo/device.h"
#include "servo/mock.h"
#include "text/text.h"
#include "unit/device_of.h"
#include "unit/rig.h"

#define TICK 1000000
#define COUNT (2 * 3.14159265358979323846 / (4000 * 9.8))
#define NM (1 / 9.8 / 1e-4) /* raw of 1 Nm at the joint */

static const ethd_driver *const servo = &ethd_driver_servo;
static ethd_setup setup;
static mock drive;
static void *device;
static char message[ETHD_MESSAGE_MAX], folder[] = "/tmp/ethd-servo-XXXXXX";
static int64_t now;
static ethd_sense sense;
static ethd_status last;

static int is_virtual = 1;

static ethd_status open_with(ethd_setting *settings, uint32_t count) {
  setup = ethd_setup_default();
  const ethd_device_def def = {&setup, settings, count, folder, "d.ini", is_virtual};
  ethd_status status = servo->open(&def, &device, message);
  if (status && device) servo->close(device), device = NULL;
  return status;
}

static void open_device(void) {
  mock_start(&drive, 0);
  ethd_setting settings[] = {{"map", "plant.map", 1}, {"port", drive.port, 2}};
  ck_assert_msg(open_with(settings, 2) == ETHD_OK, "%s", message);
  now = 0;
}

static void start_device(void) {
  open_device();
  ck_assert_int_eq(servo->start(device), ETHD_OK);
}

static void close_device(void) {
  servo->close(device);
  mock_stop(&drive);
}

/* One tick as the loop makes it; what read said, the sense beside. */
static ethd_status tick(double torque1, double torque2) {
  const ethd_command command = {{torque1, torque2}, 0, 0};
  now += TICK;
  (void)!servo->service(device, 0, now);
  memset(&sense, 0, sizeof sense);
  last = servo->read(device, now, &sense);
  (void)!servo->write(device, now, &command);
  return last;
}

static char *map_text(void) {
  char *text, path[64];
  size_t length;
  snprintf(path, sizeof path, "%s/plant.map", folder);
  ck_assert_int_eq(ethd_text_read(path, 1 << 16, &text, &length, message), ETHD_OK);
  return text;
}

/* Opens with another map; a third setting is the caller's. */
static ethd_status open_map(const char *text, const ethd_setting *more) {
  char path[64];
  snprintf(path, sizeof path, "%s/changed.map", folder);
  ck_assert_int_eq(ethd_text_write(path, text, strlen(text), message), ETHD_OK);
  mock_start(&drive, 0);
  ethd_setting settings[3] = {{"map", "changed.map", 1}, {"port", drive.port, 2}};
  if (more) settings[2] = *more;
  ethd_status status = open_with(settings, more ? 3 : 2);
  now = 0;
  unlink(path);
  return status;
}

/* The plant's map with one line changed, opened. */
static ethd_status open_changed(const char *was, const char *now_) {
  char *text = map_text(), *at = strstr(text, was), *all;
  ck_assert_msg(at != NULL, "no %s", was);
  ck_assert_int_ge(asprintf(&all, "%.*s%s%s", (int)(at - text), text, now_, at + strlen(was)), 0);
  ethd_status status = open_map(all, NULL);
  free(text);
  free(all);
  return status;
}

static int shows(ethd_fault row) { return (sense.faults & ETHD_FAULT_BIT(row)) != 0; }

/* Ticks until a row shows; most + 1: it doesn't. */
static int ticks_until(ethd_fault row, int most) {
  int n = 0;
  do tick(0.1, 0);
  while (++n <= most && !shows(row));
  return n;
}

static int32_t raw(int at) { return (int16_t)drive.words[at]; }

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

/* A counter that jumps is dropped and told; once more within 10 ms it is grave. */
TEST(test_encoder_jump) {
  start_device();
  for (int i = 0; i < 20; i++) tick(0, 0);
  place(500);
  ck_assert_int_eq(tick(0, 0), ETHD_OK);
  ck_assert_int_eq(sense.faults, ETHD_FAULT_BIT(ETHD_FAULT_ENCODER_JUMP));
  ck_assert_int_eq(sense.grave, 0);
  ck_assert_double_eq_tol(sense.q[0], 0, COUNT);
  place(0);
  ck_assert_int_eq(tick(0, 0), ETHD_OK);
  ck_assert_int_eq(sense.faults, 0);
  place(-500);
  tick(0, 0);
  ck_assert_int_eq(sense.faults & sense.grave, ETHD_FAULT_BIT(ETHD_FAULT_ENCODER_JUMP));
  close_device();
}

/* By default, from the drive's limits: no key of the map asks for it. */
TEST(test_encoder_frozen) {
  start_device();
  for (int i = 0; i < 20; i++) tick(0, 0);
  int n = 0;
  do tick(1, 0); /* 0.3 of 1.96 Nm would do */
  while (++n < 200 && !shows(ETHD_FAULT_ENCODER_FROZEN));
  ck_assert_int_ge(n, 50);
  ck_assert_int_le(n, 53); /* 50 ms, behind a tick of age and one until the torque is out */
  /* a joint that turns a count now and then isn't frozen */
  for (int i = 0; i < 300; i++) {
    if (i % 40 == 0) place(1 + i / 40);
    tick(1, 0);
    ck_assert(i < 2 || !shows(ETHD_FAULT_ENCODER_FROZEN));
  }
  close_device();
}

/* A joint of 0.01 kg m^2 that speeds up as 0.5 Nm bids, read with the wrong sign, runs away from the torque. */
TEST(test_encoder_reversed) {
  for (int sign = -1; sign <= 1; sign += 2) {
    start_device();
    for (int i = 0; i < 20; i++) tick(0, 0);
    int n = 0;
    do {
      place(sign * (int64_t)lrint(0.5 / 0.01 * (1e-3 * n) * (1e-3 * n) / 2 / COUNT));
      tick(0.5, 0); /* 0.15 of 1.96 Nm would do */
    } while (++n < 60 && !shows(ETHD_FAULT_ENCODER_REVERSED));
    if (sign > 0)
      ck_assert_int_eq(n, 60);
    else
      ck_assert_msg(n > 20 && n <= 25, "%d ticks", n); /* 20 ms from the motion's begin, 2 of age, 2 until it shows */
    close_device();
  }
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

/* ---- rows of the fault table ---- */

static mock_act from_to(void *user, uint64_t n, int function) {
  const _Atomic uint64_t *range = user;
  (void)function;
  return (mock_act){n >= range[0] && n < range[1] ? (mock_kind)range[2] : MOCK_ANSWER, (int32_t)range[3], 0};
}

static _Atomic uint64_t range[4];
/* The next `count` requests go wrong. */
static void spoil(uint64_t count, mock_kind kind, int code) {
  range[0] = drive.requests;
  range[1] = range[0] + count;
  range[2] = (uint64_t)kind;
  range[3] = (uint64_t)code;
  drive.user = range;
  drive.act = from_to;
}

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

TEST(test_feedback_old) {
  start_device();
  for (int i = 0; i < 20; i++) tick(0.1, 0);
  double q = sense.q[0];
  spoil(1000, MOCK_DROP, 0);
  ck_assert_int_eq(ticks_until(ETHD_FAULT_FEEDBACK_OLD, 20), 6); /* the first tick over 5 ms */
  ck_assert_int_eq(last, ETHD_STATUS_STALE);
  ck_assert_double_eq(sense.q[0], q);
  close_device();
}

TEST(test_stale_answer) {
  start_device();
  for (int i = 0; i < 20; i++) tick(0.1, 0);
  spoil(2, MOCK_OLD, 0);
  ck_assert_int_eq(tick(0.1, 0), ETHD_STATUS_STALE);
  ck_assert_int_eq(tick(0.1, 0), ETHD_OK);
  ck_assert_int_eq(sense.faults, ETHD_FAULT_BIT(ETHD_FAULT_REPLY_STALE));
  close_device();
}

TEST(test_bad_answers) {
  start_device();
  for (int i = 0; i < 20; i++) tick(0.1, 0);
  spoil(1, MOCK_GARBLE, 0);
  ck_assert_int_eq(ticks_until(ETHD_FAULT_REPLY_BAD, 5), 2);
  ck_assert_int_eq(sense.grave, 0);
  /* a refusal is an error of the map: grave at once */
  spoil(1, MOCK_EXCEPTION, 2);
  ck_assert_int_eq(ticks_until(ETHD_FAULT_REPLY_BAD, 5), 1);
  ck_assert_int_eq(sense.grave, ETHD_FAULT_BIT(ETHD_FAULT_REPLY_BAD));
  close_device();
}

TEST(test_drive_fault) {
  start_device();
  for (int i = 0; i < 20; i++) tick(0.1, 0);
  drive.words[MOCK_STATUS] |= 1;
  ck_assert_int_eq(ticks_until(ETHD_FAULT_DRIVE, 5), 1);
  drive.words[MOCK_STATUS] = 0; /* disabled by itself is a fault, too */
  drive.words[MOCK_CONTROL] = 0;
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

TEST(test_bus_voltage) {
  start_device();
  tick(0, 0);
  drive.words[MOCK_VOLTAGE] = 230;
  ck_assert_int_eq(ticks_until(ETHD_FAULT_BUS_VOLTAGE, 5), 1);
  drive.words[MOCK_VOLTAGE] = 480;
  tick(0, 0);
  ck_assert(!shows(ETHD_FAULT_BUS_VOLTAGE));
  drive.words[MOCK_VOLTAGE] = 561;
  ck_assert_int_eq(ticks_until(ETHD_FAULT_BUS_VOLTAGE, 5), 1);
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

TEST(test_not_followed) {
  start_device();
  for (int i = 0; i < 20; i++) tick(0.1, 0);
  drive.frozen = 1;
  int n = 0;
  do tick(1, 0);
  while (++n < 50 && !shows(ETHD_FAULT_NOT_FOLLOWED));
  ck_assert_int_ge(n, 20);
  ck_assert_int_le(n, 23); /* 20 ms, behind a tick of age */
  drive.frozen = 0;
  tick(1, 0);
  ck_assert(!shows(ETHD_FAULT_NOT_FOLLOWED));
  close_device();
}

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

/* A camera at 90 Hz behind the drive: without its rate every reading would be late. */
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

/* The plant's map with answers awaited for long: a busy machine is no fault. 0: written. */
static void write_map(const char *path) {
  char *text;
  size_t length;
  ck_assert_int_eq(ethd_text_read("apps/config/plant.map", 1 << 16, &text, &length, message), ETHD_OK);
  memcpy(strstr(text, "response = 0.003 "), "response = 0.25  ", 17);
  memcpy(strstr(text, "drain = 0.0008 "), "drain = 0.0200 ", 15);
  ck_assert_int_eq(ethd_text_write(path, text, length, message), ETHD_OK);
  free(text);
}

/* The map of each test, in a folder of its own. */
static void set_up(void) {
  char path[64];
  ck_assert_ptr_nonnull(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/plant.map", folder);
  write_map(path);
}

static void tear_down(void) {
  char path[64];
  snprintf(path, sizeof path, "%s/plant.map", folder);
  unlink(path);
  ck_assert_int_eq(rmdir(folder), 0);
}

FIXTURE(set_up, tear_down)
