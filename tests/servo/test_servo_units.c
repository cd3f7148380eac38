/* One device of two units on one bus: two drives of one axis behind a gateway, or on one serial line. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "clock.h"
#include "ethd/driver.h"
#include "servo/device.h"
#include "servo/mock.h"
#include "servo/words.h"
#include "text/text.h"
#include "unit/rig.h"

#define TICK 1000000
#define COUNT (2 * 3.14159265358979323846 / (4000 * 9.8))
#define RAW(nm) ((int)lrint((nm) / 9.8 / 1e-4)) /* of a torque at the joint, Nm */
#define PAIR "tests/servo/two_units.map"

static const ethd_driver *const servo = &ethd_driver_servo;
static mock drive;
static ethd__servo_map map;
static ethd__servo_link link_;
static ethd_setup setup;
static void *device;
static char message[ETHD_MESSAGE_MAX];
static ethd_sense sense;
static int64_t now;

/* ---- the link alone ---- */

static ethd_status turn(double torque1, double torque2) {
  return ethd__servo_link_turn(&link_, ethd__clock_now(), (const double[]){torque1, torque2});
}

static void begin(int is_rtu, int32_t exchange) {
  mock_start(&drive, is_rtu);
  ck_assert_msg(ethd__servo_map_load(PAIR, "two_units.map", &map, message) == ETHD_OK, "%s", message);
  strcpy(map.port, drive.port);
  map.transport = is_rtu ? ETHD__SERVO_RTU : ETHD__SERVO_TCP;
  map.baud = 500000;
  map.response = 0.2;
  map.drain = 0.02;
  map.exchange = exchange;
  ethd__servo_link_make(&map, &link_);
  ck_assert_msg(ethd__servo_link_connect(&link_, ethd__clock_now()) == ETHD_OK, "%s", link_.message);
}

static void reach(ethd__servo_state state, double torque1, double torque2) {
  for (int i = 0; i < 100 && link_.state != state; i++) (void)!turn(torque1, torque2);
  ck_assert_msg(link_.state == state, "state %d: %s", link_.state, link_.message);
}

static void enable(void) {
  reach(ETHD__SERVO_IDENTIFIED, 0, 0);
  ethd__servo_link_begin(&link_, ETHD__SERVO_ENABLE, ethd__clock_now());
  reach(ETHD__SERVO_ENABLED, 0, 0);
}

static void end(void) {
  ethd__servo_link_close(&link_);
  mock_stop(&drive);
}

/* Equal addresses, and each unit has its own torque, angle and counter; a question a unit when both halves are one. */
TEST_LOOP(test_each_has_its_own, 0, 4) {
  begin(_i & 1, _i & 2 ? ETHD__SERVO_COMBINED : ETHD__SERVO_SEPARATE);
  enable();
  drive.words[MOCK_POSITION1 + 1] = 100;
  drive.second[MOCK_POSITION1 + 1] = 200;
  uint64_t before = drive.requests;
  ck_assert_msg(turn(0.5, -0.25) == ETHD_OK, "%s", link_.message);
  ck_assert_uint_eq(drive.requests - before, _i & 2 ? 4 : 6); /* torque and counter aren't neighbours */
  ck_assert_int_eq((int16_t)drive.words[MOCK_TORQUE1], RAW(0.5));
  ck_assert_int_eq((int16_t)drive.second[MOCK_TORQUE1], RAW(-0.25));
  ck_assert_int_eq(drive.words[MOCK_COUNTER], drive.second[MOCK_COUNTER]);
  ck_assert_double_eq(link_.raw[map.roles[ETHD__SERVO_POSITION1]], 100);
  ck_assert_double_eq(link_.raw[map.roles[ETHD__SERVO_POSITION2]], 200);
  ck_assert(drive.words[MOCK_STATUS] == 2 && drive.second[MOCK_STATUS] == 2);
  ethd__servo_link_begin(&link_, ETHD__SERVO_DISABLE, ethd__clock_now());
  while (link_.sequence >= 0) ck_assert_int_eq(turn(0, 0), ETHD_OK);
  ck_assert_int_eq(link_.result, ETHD_OK);
  ck_assert(drive.words[MOCK_STATUS] == 0 && drive.second[MOCK_STATUS] == 0);
  end();
}

/* An answer from another station is none, over tcp, too, where libmodbus wouldn't look. */
TEST_LOOP(test_another_station, 0, 2) {
  begin(_i, ETHD__SERVO_SEPARATE);
  enable();
  drive.astray = 1;
  ck_assert_int_eq(turn(0, 0), ETHD_E_DEVICE);
  ck_assert_uint_eq(link_.counts.garbled, 1);
  drive.astray = 0;
  ck_assert_msg(turn(0, 0) == ETHD_OK, "%s", link_.message);
  end();
}

/* Over tcp an answer has its question's number. */
TEST(test_another_number) {
  begin(0, ETHD__SERVO_SEPARATE);
  reach(ETHD__SERVO_IDENTIFIED, 0, 0);
  uint16_t before = link_.bus.number, got;
  ck_assert_int_eq(turn(0, 0), ETHD_OK);
  ck_assert_uint_eq(link_.bus.number - before, 6);
  const ethd__servo_span span = {2, ETHD__SERVO_HOLDING, MOCK_VOLTAGE, 1};
  ethd__servo_frame question;
  ethd__servo_frame_read(&map, span, &question);
  ethd__servo_frame_number(&map, 0x1234, &question);
  uint8_t answer[] = {0x12, 0x34, 0, 0, 0, 5, 2, 3, 2, 1, 0xE0};
  ck_assert(ethd__servo_frame_begins(&map, &question, answer, sizeof answer));
  ck_assert_int_eq(ethd__servo_frame_take(&map, &question, answer, sizeof answer, &got), 0);
  ck_assert_uint_eq(got, 480);
  answer[1] = 0x33;
  ck_assert(!ethd__servo_frame_begins(&map, &question, answer, 2));
  ck_assert_int_ne(ethd__servo_frame_take(&map, &question, answer, sizeof answer, &got), 0);
  end();
}

static _Atomic int reads;

/* The second unit's answer is the one that it gave before. */
static mock_act old_of_the_second(void *user, uint64_t n, int function) {
  (void)user, (void)n;
  if (function == 16) return (mock_act){MOCK_ANSWER, 0, 0};
  return (mock_act){++reads == 4 ? MOCK_OLD : MOCK_ANSWER, 0, 0};
}

/* The torque stays the same, so that only the counter of its unit shows it. */
TEST(test_old_answer_of_the_second) {
  begin(1, ETHD__SERVO_SEPARATE);
  enable();
  reads = 0;
  drive.act = old_of_the_second;
  ck_assert_int_eq(turn(0, 0), ETHD_OK);
  ck_assert_int_eq(turn(0, 0), ETHD_E_DEVICE);
  ck_assert_uint_eq(link_.counts.stale, 1);
  end();
}

/* ---- a unit that vanishes ---- */

static ethd_status open_pair(int is_virtual) {
  char folder[256];
  ethd_setting settings[] = {{"map", PAIR, 1}, {"port", drive.port, 2}, {"unguarded", "yes", 3}};
  ck_assert(getcwd(folder, sizeof folder) != NULL);
  setup = ethd_setup_default();
  const ethd_device_def def = {&setup, settings, 3, folder, "d.ini", is_virtual, NULL};
  return servo->open(&def, &device, message);
}

/* Of two units one is asked after the other: the sense has the later one's instant, and the age of the other. */
TEST(test_ages) {
  int seen = 0;
  mock_start(&drive, 0);
  ck_assert_msg(open_pair(0) == ETHD_OK, "%s", message);
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  for (int i = 0; i < 40; i++) {
    (void)!servo->service(device, 0, ethd__clock_now());
    memset(&sense, 0, sizeof sense);
    const int64_t at = ethd__clock_now();
    if (servo->read(device, at, &sense) != ETHD_OK) continue;
    seen++;
    ck_assert(sense.have & ETHD_HAVE_AGE && sense.time_ns <= at);
    ck_assert((sense.age[0] > 0) != (sense.age[1] > 0) && fmin(sense.age[0], sense.age[1]) == 0);
  }
  ck_assert_int_gt(seen, 20);
  servo->close(device);
  mock_stop(&drive);
}

/* A torque over the register's limit goes out cut, and the sense says so; one that is only rounded isn't mentioned. */
TEST(test_cut_torque) {
  static const double asked[][2] = {{0.5, -0.25}, {1e3, 0.25}, {0.3, -1e3}};
  mock_start(&drive, 0);
  ck_assert_msg(open_pair(1) == ETHD_OK, "%s", message);
  const double most = servo->limits(device).torque;
  now = 0;
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  for (int k = 0; k < 3; k++) {
    const ethd_command command = {{asked[k][0], asked[k][1]}, 0, 0};
    for (int i = 0; i < 3; i++) {
      now += TICK;
      (void)!servo->write(device, now, &command);
      (void)!servo->service(device, 0, now);
    }
    memset(&sense, 0, sizeof sense);
    ck_assert_int_eq(servo->read(device, now, &sense), ETHD_OK);
    ck_assert_int_eq((sense.have & ETHD_HAVE_COMMANDED) != 0, k > 0);
    for (int i = 0; i < 2 && k > 0; i++)
      ck_assert_double_eq_tol(sense.commanded[i], fmax(-most, fmin(most, asked[k][i])), 1e-2 * most);
    ck_assert(!(sense.have & ETHD_HAVE_AGE)); /* on a virtual clock an exchange takes no time */
  }
  servo->close(device);
  mock_stop(&drive);
}

static int pushes(const _Atomic uint16_t *words) { return words[MOCK_TORQUE1] != 0; }

/* As the loop does it: a grave row ends the torque, and the device is made safe. */
static void tick(void) {
  static const int64_t ends = ETHD_FAULT_BIT(ETHD_FAULT_FEEDBACK_OLD) | ETHD_FAULT_BIT(ETHD_FAULT_LINK_LOST);
  ethd_command command = {{0.5, -0.25}, 0, 0};
  now += TICK;
  (void)!servo->service(device, 0, now);
  memset(&sense, 0, sizeof sense);
  (void)!servo->read(device, now, &sense);
  if (sense.faults & ends) {
    command = (ethd_command){{0, 0}, 0, 1};
    servo->safe(device);
  }
  (void)!servo->write(device, now, &command);
}

/* Whichever of them is gone: 5 ms later the feedback is too old, and the next exchange takes the other's torque, too.
   Then it is disabled. */
TEST_LOOP(test_one_vanishes, 0, 2) {
  int gone = 1 + _i, until = 0;
  mock_start(&drive, 0);
  ck_assert_msg(open_pair(1) == ETHD_OK, "%s", message);
  now = 0;
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  /* until ten ticks in a row went well: on a busy machine an answer may be missing */
  for (int i = 0, well = 0; i < 200 && well < 10; i++) tick(), well = sense.faults ? 0 : well + 1;
  ck_assert(pushes(drive.words) && pushes(drive.second));
  const ethd_sense before = sense;
  const _Atomic uint16_t *other = gone == 1 ? drive.second : drive.words;
  drive.mute = gone;
  while (pushes(other) && until < 100) tick(), until++;
  printf("unit %d gone: the other has no torque after %d ticks\n", gone, until);
  ck_assert_int_le(until, 7);
  ck_assert_int_eq(sense.have & ETHD_HAVE_CENTRE, 0);
  ck_assert_int_eq(before.faults, 0);
  for (int i = 0; i < 100 && other[MOCK_STATUS]; i++) {
    tick();
    ck_assert(!pushes(other));
  }
  ck_assert_int_eq(other[MOCK_STATUS], 0);
  /* it is back: the device is disabled, and starts again by a start alone */
  drive.mute = 0;
  for (int i = 0; i < 50; i++) tick();
  ck_assert(!pushes(drive.words) && !pushes(drive.second));
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  servo->close(device);
  mock_stop(&drive);
}

/* One answer that is missing is asked for again, and ends nothing. */
static mock_act drop_one(void *user, uint64_t n, int function) {
  (void)function;
  return (mock_act){n == *(uint64_t *)user ? MOCK_DROP : MOCK_ANSWER, 0, 0};
}

TEST(test_one_missing) {
  mock_start(&drive, 0);
  ck_assert_msg(open_pair(1) == ETHD_OK, "%s", message);
  now = 0;
  ck_assert_int_eq(servo->start(device), ETHD_OK);
  for (uint64_t of = 0; of < 6; of++) { /* each of an exchange's questions */
    for (int i = 0; i < 10; i++) tick();
    uint64_t which = drive.requests + of;
    drive.user = &which;
    drive.act = drop_one;
    for (int i = 0; i < 4; i++) {
      tick();
      ck_assert_int_eq(sense.faults & ETHD_FAULT_BIT(ETHD_FAULT_FEEDBACK_OLD), 0);
    }
    drive.act = NULL;
    ck_assert(pushes(drive.words) && pushes(drive.second));
  }
  servo->close(device);
  mock_stop(&drive);
}

static _Atomic uint64_t zeroed;

/* The number of the request that takes the second unit's torque. */
static mock_act note_zero(void *user, uint64_t n, int function) {
  (void)user, (void)function;
  if (pushes(drive.second)) zeroed = n;
  return (mock_act){MOCK_ANSWER, 0, 0};
}

/* The first unit is gone and the program is silent: the guardian doesn't try it five times before the second gets
   zero. */
TEST_LOOP(test_guardian, 0, 2) {
  static ethd__servo_plan plan;
  static ethd__guardian guardian;
  static ethd__guardian_page page;
  bool at_once;
  mock_start(&drive, _i);
  ck_assert_int_eq(ethd__servo_map_load(PAIR, "two_units.map", &map, message), ETHD_OK);
  strcpy(map.port, drive.port);
  map.transport = _i ? ETHD__SERVO_RTU : ETHD__SERVO_TCP;
  map.baud = 500000;
  map.response = 0.05;
  ethd__servo_plan_make(&map, &plan);
  ethd__guardian_make(&map, &plan, TICK, &guardian);
  page = (ethd__guardian_page){.line = ETHD__GUARDIAN_OURS};
  guardian.page = &page;
  ck_assert_int_eq(ethd__servo_port_open(&map, &guardian.line, &at_once, message), ETHD_OK);
  ck_assert_uint_eq(guardian.zero_count, 4);
  drive.words[MOCK_TORQUE1] = drive.second[MOCK_TORQUE1] = 500;
  drive.words[MOCK_CONTROL] = drive.second[MOCK_CONTROL] = 1;
  drive.mute = 1;
  drive.act = note_zero;
  ck_assert(!ethd__guardian_act(&guardian)); /* one didn't answer */
  ck_assert_uint_eq(zeroed, 2);              /* behind torque and counter of the first */
  ck_assert(drive.second[MOCK_TORQUE1] == 0 && drive.second[MOCK_CONTROL] == 0);
  ck_assert(drive.words[MOCK_TORQUE1] == 500);
  mock_stop(&drive);
}

/* ---- a device whose joint nobody measures ---- */

static int is_prepare;

static ethd_status open_one(const char *ids, const char *path, ethd_device **opened) {
  ethd_setting one[] = {{"servo.map", path, 1}, {"servo.joint", "2", 2}};
  setup = ethd_setup_default();
  const ethd_device_def def = {&setup, one, 2, ".", "d.ini", 1, NULL};
  return is_prepare ? ethd_device_prepare(ids, &def, opened, message)
                    : ethd_device_open(ids, NULL, &def, opened, message);
}

TEST(test_joint_unmeasured) {
  static const char one[] = "[bus]\ntransport = tcp\nport = 127.0.0.1:1\n"
                            "[register torque1]\ndirection = write\naddress = 1\ntype = i16\nunit = Nm\nscale = 1e-4\n"
                            "min = -0.2\nmax = 0.2\n"
                            "[register position1]\ndirection = read\naddress = 5\ntype = u16\nunit = count\n"
                            "counts = 4000\nabsolute = yes\n";
  char path[] = "/tmp/ethd-units-XXXXXX";
  ethd_device *opened;
  close(mkstemp(path));
  ck_assert_int_eq(ethd_text_write(path, one, sizeof one - 1, message), ETHD_OK);
  is_prepare = 0; /* nothing answers at its port, which isn't asked */
  ck_assert_int_eq(open_one("servo", path, &opened), ETHD_E_ARGUMENT);
  is_prepare = 1;
  ck_assert_int_eq(open_one("servo", path, &opened), ETHD_E_ARGUMENT);
  ck_assert_str_eq(message,
                   "d.ini: device.driver: \"servo\" measures joint 2 alone; both joints are needed: in one map, "
                   "whose registers may be in several units (bus_unit), or from a second driver");
  ck_assert_int_eq(open_one("servo, nail", path, &opened), ETHD_E_ARGUMENT); /* a finger's sensor is no help */
  ck_assert_msg(open_one("servo, counter", path, &opened) == ETHD_OK, "%s", message);
  ethd_device_close(opened);
  remove(path);
}
