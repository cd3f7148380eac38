/* Register maps that come with the programs, and the words that registers hold. */
#include <math.h>
#include <string.h>

#include "servo/map_text.h"
#include "servo/wire.h"
#include "servo/words.h"
#include "unit/draw.h"
#include "unit/rig.h"

/* ---- what comes with the programs ---- */

TEST(test_plant) {
  read_map("apps/config/plant.map");
  ck_assert_msg(try(text) == ETHD_OK, "%s", message);
  const ethd__servo_register *torque = named("torque1"), *position = named("position2");
  ck_assert_uint_eq(torque->address, 1);
  ck_assert_double_eq(torque->ratio, 9.80);
  ck_assert_str_eq(map.registers[torque->echo].name, "seen1");
  ck_assert_int_eq(position->type, ETHD__SERVO_I32);
  ck_assert_int_eq(map.watchdog, ETHD__SERVO_WATCH_SILENCE);
  ck_assert_uint_eq(map.sequences[ETHD__SERVO_ENABLE].count, 4);
  ck_assert_ptr_null(ethd__servo_risk(&map, 0));
  ck_assert_double_eq_tol(ethd__servo_most(torque), 0.2 * 9.80, 1e-12);
  /* a joint turn is 4000 x 9.80 counts */
  ck_assert_double_eq_tol(ethd__servo_joint(position, 39200), 6.283185307179586, 1e-12);
}

/* The SVD48V at 500 kBd, by hand: a byte has 10 bits, a silence 3.5 bytes of 11. Writing two words is 13 + 8 bytes,
   reading n of them 8 + 5 + 2 n; currents come every second time, running bits and error words in turn between them, the
   voltage every 50th. */
TEST(test_wire) {
  const double byte = 10 / 500e3, silence = 3.5 * 11 / 500e3;
  read_map("apps/config/svd48v.map");
  ck_assert_msg(try(text) == ETHD_OK, "%s", message);
  ethd__servo_wire w = ethd__servo_wire_of(&map, 0);
  ck_assert_uint_eq(w.questions, 5);
  ck_assert_uint_eq(w.bytes, 13 + 8 + (8 + 9) + (8 + 13) + 11 + 8 + (8 + 7)); /* and the counter, there and back */
  ck_assert_double_eq_tol(w.usual, 93 * byte + 5 * silence, 1e-12);
  ck_assert_double_eq_tol(w.most, w.usual + (17 + 15) * byte + 2 * silence, 1e-12);
  ck_assert_double_eq_tol(ethd__servo_wire_of(&map, 1e-4).usual, w.usual + 5e-4, 1e-12);
  map.turnaround = 2e-4;
  ck_assert_double_eq_tol(ethd__servo_wire_of(&map, (double)NAN).usual, w.usual + 10e-4, 1e-12);
  map.format = 1; /* parity */
  ck_assert_double_eq_tol(ethd__servo_wire_of(&map, 0).usual, 93 * 1.1 * byte + 5 * silence, 1e-12);
  ck_assert_uint_eq(ethd__servo_divisor_for(2.2e-3, 1e-3), 3);
  ck_assert_uint_eq(ethd__servo_divisor_for(0.1e-3, 1e-3), 1);
  ck_assert_uint_eq(ethd__servo_divisor_for(1 / 1.1 * 4e-3, 1e-3), 4);
  /* the map's divisor holds what its wire takes, with turnarounds of 0.2 ms */
  ck_assert_uint_ge(map.divisor, ethd__servo_divisor_for(w.most + 7 * 2e-4, 1e-3));
}

/* Rows 12 and 13 are watched unless a map says otherwise, and then it is said. */
TEST(test_watched) {
  static const struct {
    const char *was, *now, *says;
  } all[] = {{"counts = 4000", "counts = 4000\nfreeze_torque = 4", "freeze_torque is out of reach"},
             {"counts = 4000", "counts = 4000\nreverse_torque = 2", "reverse_torque is out of reach"},
             {"unit = count\ncounts = 4000", "unit = turn", "a position that isn't in counts"}};
  static char changed[sizeof text + 64];
  read_map("apps/config/plant.map");
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
    char *at = strstr(strstr(text, "[register position2]"), all[i].was);
    snprintf(changed, sizeof changed, "%.*s%s%s", (int)(at - text), text, all[i].now, at + strlen(all[i].was));
    ck_assert_msg(try(changed) == ETHD_OK, "%s", message);
    const char *risk = ethd__servo_risk(&map, 0);
    ck_assert_msg(risk && strstr(risk, all[i].says), "%s", risk ? risk : "no risk");
    ck_assert_ptr_null(ethd__servo_risk(&map, 1));
  }
}

/* Roboteq's rule (GDC3660E Modbus data sheet, 2018, p. 10), which has 0x2106, index 1 -> 0x20C1 as its example. */
static uint32_t roboteq(uint32_t id, uint32_t index) { return (id << 5 | index) & 0xFFFF; }

/* CANopen ids of Roboteq's object dictionary: user manual V1.8 p. 181 to 184, V2.0 p. 212, 223, CANbus manual V2.0 p.
   35. */
TEST(test_roboteq) {
  static const struct {
    const char *name;
    uint32_t id, index, address; /* address: as a driver that isn't ours has it */
  } known[] = {
      {"torque1", 0x2000, 1, 0x0001}, {"torque2", 0x2000, 2, 0x0002},     {"seen1", 0x2101, 1, 0x2021},
      {"seen2", 0x2101, 2, 0x2022},   {"position1", 0x2104, 1, 0x2081},   {"position2", 0x2104, 2, 0x2082},
      {"faults", 0x2112, 0, 0x2240},  {"bus_voltage", 0x210D, 2, 0x21A2}, {"emergency", 0x200C, 0, 0x0180},
      {"release", 0x200D, 0, 0x01A0},
  };
  ck_assert_uint_eq(roboteq(0x2106, 1), 0x20C1);
  read_map("apps/config/roboteq.map");
  ck_assert_msg(try(text) == ETHD_OK, "%s", message);
  ck_assert_uint_eq(map.count, sizeof known / sizeof *known); /* no register without a source */
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    ck_assert_uint_eq(named(known[i].name)->address, roboteq(known[i].id, known[i].index));
    ck_assert_uint_eq(named(known[i].name)->address, known[i].address);
  }
  for (uint32_t i = 0; i < map.count; i++) { /* what moves a motor: P, S, PR, PX, PRX; MS stops */
    uint32_t at = map.registers[i].address & ~31u;
    ck_assert(at != 0x20 && at != 0x40 && at != 0x1C0 && at != 0x1E0 && at != 0x200 && at != 0x220);
  }
  ck_assert_uint_eq(ethd__servo_unconfirmed(&map), 0);
}

/* The SVD48V's addresses as its manual (V2.01) has them, p. 15 and 23 to 26. */
TEST(test_svd48v) {
  static const struct {
    const char *name;
    uint32_t address;
  } known[] = {{"input", 0x3008},        {"mode1", 0x5100},     {"seen_mode1", 0x5100}, {"mode2", 0x5101},
               {"seen_mode2", 0x5101},   {"control1", 0x5300},  {"control2", 0x5301},   {"counter", 0x5304},
               {"seen_counter", 0x5304}, {"torque1", 0x5308},   {"torque2", 0x5309},    {"seen1", 0x5308},
               {"seen2", 0x5309},        {"running1", 0x5400},  {"running2", 0x5401},   {"bus_voltage", 0x5408},
               {"measured1", 0x5414},    {"measured2", 0x5415}, {"position1", 0x5418},  {"position2", 0x541A},
               {"error1", 0x5420},       {"error2", 0x5422}};
  read_map("apps/config/svd48v.map");
  ck_assert_msg(try(text) == ETHD_OK, "%s", message);
  ck_assert_uint_eq(map.count, sizeof known / sizeof *known); /* no register without a source */
  for (uint32_t i = 0; i < map.count; i++) ck_assert_uint_eq(named(known[i].name)->address, known[i].address);
  ck_assert_uint_eq(ethd__servo_unconfirmed(&map), 0);
  for (int i = 1; i <= 2; i++) { /* every bit is an alarm */
    const ethd__servo_register *error = named(i == 1 ? "error1" : "error2");
    ck_assert(error->type == ETHD__SERVO_U32 && error->fault_mask == UINT32_MAX && error->healthy == 0);
  }
  ck_assert_uint_eq(map.unit, 1);
  ck_assert_uint_eq(map.gap, 0);
  ck_assert_int_eq(named("position1")->order, ETHD__SERVO_LOW_FIRST);
  const ethd__servo_step *first = &map.sequences[ETHD__SERVO_ENABLE].at[0];
  ck_assert_str_eq(map.registers[first->at].name, "input");
  ck_assert_double_eq(first->value, 1);
}

TEST(test_makers) {
  read_map("apps/config/svd48v.map");
  ck_assert_msg(try(text) == ETHD_OK, "%s", message);
  ck_assert_uint_eq(named("torque1")->address, 0x5308);
  ck_assert_double_eq(map.baud, 500000);
  ck_assert_ptr_nonnull(strstr(ethd__servo_risk(&map, 0), "no watchdog"));
  read_map("apps/config/roboteq.map");
  ck_assert_msg(try(text) == ETHD_OK, "%s", message);
  ck_assert_ptr_nonnull(strstr(ethd__servo_risk(&map, 0), "goes on by itself"));
  /* an address that nobody knows keeps the drive from moving */
  read_map("apps/config/akd.map");
  ck_assert_int_lt(try(text), 0);
  ck_assert_msg(strstr(message, "torque1.address: found \"LOOK_UP\"") != NULL, "%s", message);
  for (char *at; (at = strstr(text, "LOOK_UP\n"));) memcpy(at, "1000   ", 7);
  for (char *at; (at = strstr(text, "LOOK_UP"));) memcpy(at, "1000   ", 7);
  ck_assert_msg(try(text) == ETHD_OK, "%s", message);
  ck_assert_uint_eq(ethd__servo_unconfirmed(&map), 6);
  ck_assert(!named("torque1")->unconfirmed && named("control")->unconfirmed);
  ck_assert_ptr_nonnull(strstr(ethd__servo_risk(&map, 0), "no watchdog"));
  /* 20 ms between messages: no exchange ends within the 25 ms that one may take */
  ck_assert_double_ge(ethd__servo_wire_of(&map, (double)NAN).usual, 0.04);
}

/* ---- words ---- */

TEST(test_words) {
  static const struct {
    int32_t type, order;
    double raw;
    uint16_t words[2];
  } known[] = {
      {ETHD__SERVO_U16, 0, 65535, {0xFFFF, 0}},
      {ETHD__SERVO_I16, 0, -2, {0xFFFE, 0}},
      {ETHD__SERVO_U32, 0, 0x12345678, {0x1234, 0x5678}},
      {ETHD__SERVO_U32, 1, 0x12345678, {0x5678, 0x1234}},
      {ETHD__SERVO_I32, 0, -2, {0xFFFF, 0xFFFE}},
      {ETHD__SERVO_I32, 1, -2, {0xFFFE, 0xFFFF}},
      {ETHD__SERVO_F32, 0, 1.5, {0x3FC0, 0}},
      {ETHD__SERVO_F32, 1, 1.5, {0, 0x3FC0}},
  };
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    const ethd__servo_register r = {.type = known[i].type, .order = known[i].order};
    uint16_t words[2] = {0, 0};
    ethd__servo_pack(&r, known[i].raw, words);
    ck_assert_msg(!memcmp(words, known[i].words, sizeof words), "row %zu: %04x %04x", i, words[0], words[1]);
    ck_assert_double_eq(ethd__servo_unpack(&r, words), known[i].raw);
  }
}

/* Back is what went, for every type and order; what doesn't fit is cut, what isn't a number is 0. */
TEST(test_words_back) {
  for (uint64_t i = 0; i < 20000; i++) {
    const ethd__servo_register r = {.type = (int32_t)(draw_bits(3 * i) % 5),
                                    .order = (int32_t)(draw_bits(3 * i + 1) % 2)};
    double min, max;
    uint16_t words[2];
    ethd__servo_range(&r, &min, &max);
    double raw =
        r.type == ETHD__SERVO_F32 ? (double)(float)draw(3 * i + 2, -1e6, 1e6) : rint(draw(3 * i + 2, min, max));
    ethd__servo_pack(&r, raw, words);
    ck_assert_double_eq(ethd__servo_unpack(&r, words), raw);
    ethd__servo_pack(&r, (double)INFINITY, words);
    ck_assert_double_eq(ethd__servo_unpack(&r, words), max);
    ethd__servo_pack(&r, (double)NAN, words);
    ck_assert_double_eq(ethd__servo_unpack(&r, words), 0);
  }
}

/* Less than a count remains: never more than was asked for, in its direction, and a torque of the words stays itself. */
static void rounds(const ethd__servo_register *r, double joint) {
  uint16_t words[2];
  double raw = ethd__servo_raw(r, joint);
  ethd__servo_pack(r, raw, words);
  double got = ethd__servo_joint(r, ethd__servo_unpack(r, words)), none = 1e-9 * ethd__servo_most(r);
  ck_assert_msg(fabs(got) <= fmax(fabs(joint), none), "%.17g Nm became %.17g", joint, got);
  ck_assert_msg(got * joint >= 0 || fabs(got) <= none, "%.17g Nm became %.17g", joint, got);
  double limit = fmin(fabs(joint), ethd__servo_most(r)), step = fmax(ethd__servo_least(r), 1e-6 * limit);
  ck_assert_msg(fabs(got) >= limit - step - none, "%.17g Nm became %.17g", joint, got);
  ck_assert(ethd__servo_raw(r, got) == raw || fabs(got) <= none);
}

static void rounds_all(const ethd__servo_register *r, uint64_t stream) {
  double most = ethd__servo_most(r), count = ethd__servo_least(r);
  rounds(r, 0);
  for (uint64_t i = 0; i < 300; i++) {
    rounds(r, draw(300 * stream + i, -2 * most, 2 * most));
    rounds(r, draw(300 * stream + i, -3 * count, 3 * count));
    rounds(r, floor(draw(300 * stream + i, -30, 30)) * count); /* whole counts, or an ulp beside them */
  }
}

TEST(test_rounds_towards_zero) {
  static const char *const maps[] = {"apps/config/svd48v.map", "apps/config/roboteq.map", "apps/config/plant.map",
                                     "apps/config/akd.map"};
  for (uint64_t k = 0; k < sizeof maps / sizeof *maps; k++) {
    read_map(maps[k]);
    for (char *at; (at = strstr(text, "LOOK_UP\n"));) memcpy(at, "1000   ", 7);
    for (char *at; (at = strstr(text, "LOOK_UP"));) memcpy(at, "1000   ", 7);
    ck_assert_msg(try(text) == ETHD_OK, "%s", message);
    for (int i = 0; i < 2; i++)
      if (map.roles[ETHD__SERVO_TORQUE1 + i] >= 0)
        rounds_all(&map.registers[map.roles[ETHD__SERVO_TORQUE1 + i]], 2 * k + (uint64_t)i);
  }
  for (uint64_t k = 0; k < 2000; k++) {
    ethd__servo_register r = {.type = k % 3 == 0   ? ETHD__SERVO_I16
                                      : k % 3 == 1 ? ETHD__SERVO_I32
                                                   : ETHD__SERVO_F32,
                              .order = ETHD__SERVO_HIGH_FIRST,
                              .reversed = !(k & 8),
                              .ratio = pow(10, draw(k, -2, 3)),
                              .unit = k & 16 ? 1 : 2,
                              .torque_constant = pow(10, draw(k + 5000, -3, 1)),
                              .scale = (k & 32 ? 1 : -1) * pow(10, draw(k + 9000, -4, 0))};
    r.offset = k & 64 && r.type != ETHD__SERVO_F32 ? -100 * r.scale : 0;
    r.max = draw(k + 1000, 2, 30000) * fabs(r.scale);
    r.min = -draw(k + 2000, 2, 30000) * fabs(r.scale);
    rounds_all(&r, 100 + k);
  }
  /* 0.1 A at 0.0389 Nm/A and 12 turns are 0.04668 Nm a count: less than that is nothing, and 0.12 are two */
  read_map(maps[0]);
  ck_assert_int_eq(try(text), ETHD_OK);
  ck_assert_double_eq(ethd__servo_raw(named("torque1"), 0.0466), 0);
  ck_assert_double_eq(ethd__servo_raw(named("torque1"), -0.12), -2);
  ck_assert_double_eq(ethd__servo_raw(named("torque1"), 1.5 * 0.04668), 1);
}
