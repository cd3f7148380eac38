/* The traps of a Modbus, into which plain libmodbus falls as its examples use it, and the link doesn't. Nothing here
   measures time: answers and their order are compared. */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <modbus/modbus.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "clock.h"
#include "servo/line_speed.h"
#include "servo/link.h"
#include "servo/mock.h"
#include "servo/words.h"
#include "unit/rig.h"

#define RESPONSE 150000 /* us: long beside what a busy machine adds */
#define CYCLES 200      /* or ETHD_SERVO_CYCLES, where one late answer is awaited */

static ethd__servo_map map;
static ethd__servo_link link_;
static mock drive;
static char message[ETHD_MESSAGE_MAX];
static const double none[2] = {0, 0};

static void open_mock(int is_rtu) {
  mock_start(&drive, is_rtu);
  ck_assert_msg(ethd__servo_map_load("apps/config/plant.map", "plant.map", &map, message) == ETHD_OK, "%s", message);
  strcpy(map.port, drive.port);
  map.transport = is_rtu ? ETHD__SERVO_RTU : ETHD__SERVO_TCP;
  map.baud = 500000;
  map.response = 1e-6 * RESPONSE;
  map.drain = 30e-3;
  map.back_off = 1e-3;
}

static void open_link(int is_rtu) {
  open_mock(is_rtu);
  ethd__servo_link_make(&map, &link_);
  ck_assert_msg(ethd__servo_link_connect(&link_, ethd__clock_now()) == ETHD_OK, "%s", link_.message);
}

static void close_link(void) {
  ethd__servo_link_close(&link_);
  mock_stop(&drive);
}

static ethd_status turn(void) { return ethd__servo_link_turn(&link_, ethd__clock_now(), none); }

static void turn_until(ethd__servo_state state) {
  for (int i = 0; i < 2000 && link_.state != state; i++) {
    (void)!turn();
    usleep(200);
  }
  ck_assert_msg(link_.state == state, "state %d: %s", link_.state, link_.message);
}

/* ---- requests that go wrong ---- */

static mock_act garble_sometimes(void *user, uint64_t n, int function) {
  (void)user, (void)function;
  return (mock_act){n % 13 == 5 ? MOCK_GARBLE : MOCK_ANSWER, 0, 0};
}

static mock_act late_once(void *user, uint64_t n, int function) {
  (void)function;
  return (mock_act){MOCK_LATE, 0, n == *(_Atomic uint64_t *)user ? RESPONSE + RESPONSE / 10 : 300};
}

/* Cycles of the link: position1 holds the counter, which no echo watches. How many answers are another question's, taken
   for this one's. */
static int link_cycles(int *errors) {
  int stale = 0;
  for (int i = 0; i < CYCLES; i++) {
    drive.words[MOCK_POSITION1 + 1] = 0;
    if (turn())
      ++*errors;
    else
      stale += (uint16_t)link_.raw[map.registers[map.roles[ETHD__SERVO_COUNTER]].echo] != link_.counter;
  }
  return stale;
}

/* RTU has no transaction numbers. */
TEST_LOOP(test_late, 0, 2) {
  int errors = 0;
  open_link(_i);
  turn_until(ETHD__SERVO_IDENTIFIED);
  _Atomic uint64_t at = drive.requests + 20;
  drive.act = late_once;
  drive.user = &at;
  ck_assert_int_eq(link_cycles(&errors), 0);
  ck_assert_int_ge(errors, 1);
  ck_assert_int_le(errors, 5);
  close_link();
}

static mock_act late_sometimes(void *user, uint64_t n, int function) {
  (void)user, (void)function;
  return (mock_act){MOCK_LATE, 0, n % 41 == 17 ? 3000 : 0};
}

/* In our own framing, as the standard's order of the checksum isn't this drive's; on two wires what is sent
   comes back. */
TEST_LOOP(test_own_framing, 0, 2) {
  const char *given = getenv("ETHD_SERVO_CYCLES");
  const int cycles = given ? atoi(given) : CYCLES;
  int errors = 0, stale = 0;
  open_mock(1);
  drive.crc_high = 1;
  drive.mirror = _i;
  map.crc = ETHD__SERVO_CRC_HIGH_FIRST;
  map.local_echo = _i;
  map.response = 2e-3; /* so that late ones are late, on a busy machine more of them */
  map.drain = 4e-3;
  ethd__servo_link_make(&map, &link_);
  ck_assert_msg(ethd__servo_link_connect(&link_, ethd__clock_now()) == ETHD_OK, "%s", link_.message);
  ck_assert_ptr_null(link_.bus.modbus);
  turn_until(ETHD__SERVO_IDENTIFIED);
  drive.act = late_sometimes;
  for (int done = 0; done < cycles; done += CYCLES) stale += link_cycles(&errors);
  printf("late answers, own framing: %d of %d answers are stale, %d errors\n", stale, cycles, errors);
  ck_assert_int_eq(stale, 0);
  ck_assert_int_ge(errors, 3);
  drive.act = garble_sometimes;
  errors = 0;
  uint64_t garbled = link_.counts.garbled;
  ck_assert_int_eq(link_cycles(&errors), 0);
  ck_assert_uint_gt(link_.counts.garbled, garbled);
  close_link();
}

/* With the other order of the checksum, or with libmodbus, nothing comes. */
TEST(test_other_checksum) {
  uint16_t got;
  for (int order = 0; order < 2; order++)
    for (int asked = 0; asked < 2; asked++) {
      ethd__servo_bus bus;
      open_mock(1);
      drive.crc_high = order;
      map.crc = asked;
      map.response = asked == order ? 1e-6 * RESPONSE : 20e-3;
      ck_assert_int_eq(ethd__servo_bus_open(&map, &bus, message), ETHD_OK);
      ck_assert_int_eq(ethd__servo_bus_read(&bus, (ethd__servo_span){1, ETHD__SERVO_HOLDING, MOCK_VOLTAGE, 1}, &got),
                       asked == order ? ETHD__SERVO_DONE : ETHD__SERVO_MISSING);
      ethd__servo_bus_close(&bus);
      mock_stop(&drive);
    }
}

/* Even an answer that comes after the quiet, or is the drive's own old one, isn't taken. */
static mock_act old_sometimes(void *user, uint64_t n, int function) {
  (void)user;
  return (mock_act){n % 7 == 3 && function == 3 ? MOCK_OLD : MOCK_ANSWER, 0, 0};
}
TEST(test_old_answers) {
  int errors = 0;
  open_link(0);
  turn_until(ETHD__SERVO_IDENTIFIED);
  drive.act = old_sometimes;
  ck_assert_int_eq(link_cycles(&errors), 0);
  ck_assert_uint_gt(link_.counts.stale, CYCLES / 20);
  ck_assert_uint_eq(link_.rows[ETHD_FAULT_REPLY_STALE], link_.counts.stale);
  ck_assert_uint_eq(link_.counts.lost, 0);
  close_link();
}

/* ---- lines ---- */

TEST(test_baud) {
  open_mock(1);
  static const double rates[] = {9600, 250000, 400000, 500000, 2000000, 76923};
  for (size_t i = 0; i < sizeof rates / sizeof *rates; i++) {
    ethd__servo_bus bus;
    map.baud = rates[i];
    ck_assert_msg(ethd__servo_bus_open(&map, &bus, message) == ETHD_OK, "%s", message);
    ck_assert_uint_eq(line_speed(bus.fd), (unsigned)rates[i]);
    ethd__servo_bus_close(&bus);
  }
  strcpy(map.port, "/dev/null");
  ethd__servo_bus bus;
  ck_assert_int_lt(ethd__servo_bus_open(&map, &bus, message), 0);
  ck_assert_ptr_nonnull(strstr(message, "/dev/null: "));
  mock_stop(&drive);
}

/* A line that can't do what its map wants isn't opened; one that hands bytes over late says so. */
TEST(test_line_keys) {
  ethd__servo_bus bus;
  open_mock(1);
  ck_assert_int_eq(ethd__servo_bus_open(&map, &bus, message), ETHD_OK);
  ck_assert(!bus.at_once); /* a pseudo terminal knows no such thing */
  ethd__servo_bus_close(&bus);
  map.rs485 = 1;
  ck_assert_int_lt(ethd__servo_bus_open(&map, &bus, message), 0);
  ck_assert_msg(strstr(message, "RTS can't switch its direction") && strstr(message, "rs485 = adapter"), "%s", message);
  ck_assert_int_eq(bus.fd, -1);
  mock_stop(&drive);
}

TEST(test_no_delay) {
  int on = 0;
  socklen_t size = sizeof on;
  open_link(0);
  ck_assert_int_eq(getsockopt(link_.bus.fd, IPPROTO_TCP, TCP_NODELAY, &on, &size), 0);
  ck_assert_int_ne(on, 0);
  close_link();
}

/* The line is taken away, for good. */
TEST(test_unplugged) {
  open_link(0);
  turn_until(ETHD__SERVO_IDENTIFIED);
  mock_unplug(&drive);
  for (int i = 0; i < 50; i++) {
    (void)!turn();
    usleep(500);
  }
  ck_assert_int_eq(link_.state, ETHD__SERVO_DOWN);
  ck_assert_uint_eq(link_.counts.lost, 1);
  ck_assert_double_gt(link_.back_off, map.back_off);
  mock_plug(&drive);
  turn_until(ETHD__SERVO_IDENTIFIED);
  ck_assert_uint_eq(link_.counts.connects, 2);
  close_link();
}

static mock_act halves(void *user, uint64_t n, int function) {
  (void)user;
  return (mock_act){n == 0 && function ? MOCK_HALF : MOCK_ANSWER, 0, 2 * RESPONSE};
}

/* Half an answer, the rest two response times later: whoever returns with it has waited that long. */
TEST(test_byte_timeout) {
  uint16_t got;
  open_mock(1);
  ethd__servo_bus bus;
  ck_assert_int_eq(ethd__servo_bus_open(&map, &bus, message), ETHD_OK);
  drive.act = halves;
  ck_assert_int_eq(ethd__servo_bus_read(&bus, (ethd__servo_span){1, ETHD__SERVO_HOLDING, MOCK_POSITION1, 1}, &got),
                   ETHD__SERVO_MISSING);
  ethd__servo_bus_close(&bus);
  mock_stop(&drive);
}

/* A descriptor over 1023, which libmodbus hands to select. */
TEST(test_descriptor) {
  const struct rlimit many = {FD_SETSIZE + 64, FD_SETSIZE + 64};
  ethd__servo_bus bus;
  open_mock(0);
  setrlimit(RLIMIT_NOFILE, &many);
  while (open("/dev/null", O_RDONLY) < FD_SETSIZE) continue;
  ck_assert_int_eq(ethd__servo_bus_open(&map, &bus, message), ETHD_E_DEVICE);
  ck_assert_msg(strstr(message, "under 1024 is needed") != NULL, "%s", message);
}

/* Floats of two words come back to the bit. */
TEST(test_floats) {
  uint16_t own[2];
  const ethd__servo_register r = {.type = ETHD__SERVO_F32, .order = ETHD__SERVO_HIGH_FIRST};
  const float value = 0.1234567f;
  ethd__servo_pack(&r, (double)value, own);
  ck_assert_double_eq(ethd__servo_unpack(&r, own), (double)value);
}

/* ---- exceptions ---- */

static mock_act refuse_reads(void *user, uint64_t n, int function) {
  (void)n;
  return (mock_act){function == 3 ? MOCK_EXCEPTION : MOCK_ANSWER, *(int *)user, 0};
}

TEST(test_exceptions) {
  static const struct {
    int code;
    ethd__servo_outcome outcome;
    ethd_fault row;
  } all[] = {{1, ETHD__SERVO_REFUSED, ETHD_FAULT_REPLY_BAD}, {2, ETHD__SERVO_REFUSED, ETHD_FAULT_REPLY_BAD},
             {3, ETHD__SERVO_REFUSED, ETHD_FAULT_REPLY_BAD}, {4, ETHD__SERVO_FAILED, ETHD_FAULT_DRIVE},
             {6, ETHD__SERVO_BUSY, ETHD_FAULT_REPLY_BAD},    {11, ETHD__SERVO_MISSING, ETHD_FAULT_REPLY_MISSING}};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
    uint16_t got;
    int code = all[i].code;
    open_link(0);
    turn_until(ETHD__SERVO_IDENTIFIED);
    drive.act = refuse_reads;
    drive.user = &code;
    ck_assert_int_eq(ethd__servo_bus_read(&link_.bus, (ethd__servo_span){1, ETHD__SERVO_HOLDING, 5, 1}, &got),
                     all[i].outcome);
    ck_assert_int_eq(link_.bus.error, MODBUS_ENOBASE + code);
    ck_assert_ptr_null(strstr(ethd__servo_bus_error(&link_.bus), "Unknown error"));
    uint32_t before = link_.rows[all[i].row];
    ck_assert_int_eq(turn(), ETHD_E_DEVICE);
    ck_assert_uint_eq(link_.rows[all[i].row], before + 1);
    /* a refusal is the map's fault, and grave at once */
    ck_assert_int_eq(link_.bucket > ETHD__SERVO_BUCKET_LIMIT, all[i].outcome == ETHD__SERVO_REFUSED);
    close_link();
  }
}

static mock_act bad(void *user, uint64_t n, int function) {
  (void)function;
  return (mock_act){n % 3 == 0 ? *(mock_kind *)user : MOCK_ANSWER, 0, 0};
}

/* Damaged answers: none is taken, the link stays, and too many of them are told. */
TEST(test_damaged) {
  static const mock_kind kinds[] = {MOCK_GARBLE, MOCK_CUT, MOCK_DROP};
  for (int is_rtu = 0; is_rtu < 2; is_rtu++)
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
      mock_kind kind = kinds[i];
      int errors = 0, good = 0;
      open_link(is_rtu);
      turn_until(ETHD__SERVO_IDENTIFIED);
      drive.act = bad;
      drive.user = &kind;
      for (int k = 0; k < 12; k++)
        if (turn())
          errors++;
        else
          good += (uint16_t)link_.raw[map.registers[map.roles[ETHD__SERVO_COUNTER]].echo] == link_.counter;
      ck_assert_int_ge(errors, 3);
      ck_assert_int_eq(errors + good, 12);
      ck_assert_uint_eq(link_.counts.lost, 0);
      ck_assert_int_eq(link_.bucket > ETHD__SERVO_BUCKET_LIMIT, kind == MOCK_GARBLE && errors > 5);
      close_link();
    }
}

static mock_act resets(void *user, uint64_t n, int function) {
  (void)user, (void)function;
  return (mock_act){n % 50 == 49 ? MOCK_RESET : MOCK_ANSWER, 0, 0};
}

TEST(test_reset) {
  open_link(0);
  turn_until(ETHD__SERVO_IDENTIFIED);
  drive.act = resets;
  for (int i = 0; i < 400; i++) {
    ethd_status status = turn();
    ck_assert_int_eq(link_.state == ETHD__SERVO_ENABLED, 0);
    if (status) usleep(500);
  }
  ck_assert_uint_gt(link_.counts.lost, 3);
  ck_assert_uint_eq(link_.rows[ETHD_FAULT_LINK_LOST], link_.counts.lost);
  close_link();
}

/* ---- sequences ---- */

TEST(test_sequences) {
  const double torque[2] = {0.3, -0.2};
  open_link(0);
  drive.words[MOCK_STATUS] = 1;
  turn_until(ETHD__SERVO_IDENTIFIED);
  ck_assert_int_eq(ethd__servo_link_turn(&link_, ethd__clock_now(), torque), ETHD_OK);
  ck_assert_uint_eq(drive.words[MOCK_TORQUE1], 0); /* not enabled: zero, whatever was asked for */
  ethd__servo_link_begin(&link_, ETHD__SERVO_ENABLE, ethd__clock_now());
  turn_until(ETHD__SERVO_ENABLED);
  ck_assert_uint_eq(drive.words[MOCK_STATUS], 2);
  ck_assert_int_eq(ethd__servo_link_turn(&link_, ethd__clock_now(), torque), ETHD_OK);
  ck_assert_int_eq((int16_t)drive.words[MOCK_TORQUE1], (int)lrint(0.3 / 9.8 / 1e-4));
  ck_assert_int_eq((int16_t)drive.words[MOCK_TORQUE2], (int)lrint(-0.2 / 9.8 / 1e-4));
  ethd__servo_link_begin(&link_, ETHD__SERVO_DISABLE, ethd__clock_now());
  ck_assert_int_eq(link_.state, ETHD__SERVO_IDENTIFIED);
  for (int i = 0; i < 50 && link_.sequence >= 0; i++)
    ck_assert_int_eq(ethd__servo_link_turn(&link_, ethd__clock_now(), torque), ETHD_OK);
  ck_assert_int_eq(link_.result, ETHD_OK);
  ck_assert_uint_eq(drive.words[MOCK_STATUS], 0);
  ck_assert_uint_eq(drive.words[MOCK_TORQUE1], 0);
  close_link();
}

/* A drive that doesn't come: the step's time-out says which and what it had. */
TEST(test_step_timeout) {
  int64_t clock = ethd__clock_now();
  open_link(0);
  turn_until(ETHD__SERVO_IDENTIFIED);
  ethd__servo_link_begin(&link_, ETHD__SERVO_ENABLE, clock);
  for (int i = 0; i < 2; i++) (void)!ethd__servo_link_turn(&link_, clock, none);
  for (int i = 0; i < 20 && link_.sequence >= 0; i++) {
    drive.words[MOCK_CONTROL] = 0; /* forgets at once */
    drive.words[MOCK_STATUS] = 0;
    clock += 200000000;
    (void)!ethd__servo_link_turn(&link_, clock, none);
  }
  ck_assert_int_eq(link_.result, ETHD_E_DEVICE);
  ck_assert_msg(strstr(link_.message, "enable.step4: status is 0x0 after 0.5 s") != NULL, "%s", link_.message);
  ck_assert_int_eq(link_.state, ETHD__SERVO_IDENTIFIED);
  close_link();
}

/* 0x17, input registers, registers in values: the same words go over the line. */
TEST(test_other_questions) {
  for (int k = 0; k < 3; k++) {
    open_mock(k == 2);
    if (k == 0) map.exchange = ETHD__SERVO_COMBINED;
    if (k == 1) map.addressing = ETHD__SERVO_BY_VALUE;
    if (k == 2) map.exchange = ETHD__SERVO_COMBINED;
    ethd__servo_link_make(&map, &link_);
    uint32_t questions = k == 1 ? 3 + link_.plan.read_count : 1;
    ck_assert_int_eq(ethd__servo_link_connect(&link_, ethd__clock_now()), ETHD_OK);
    turn_until(ETHD__SERVO_IDENTIFIED);
    uint64_t before = drive.requests;
    drive.words[MOCK_POSITION1] = 1;
    drive.words[MOCK_POSITION1 + 1] = 2;
    ck_assert_msg(turn() == ETHD_OK, "%s", link_.message);
    ck_assert_uint_eq(drive.requests - before, questions);
    ck_assert_double_eq(link_.raw[map.roles[ETHD__SERVO_POSITION1]], 65538);
    close_link();
  }
}
