/* One encoder: counts to angles, speeds and faults. */
#include <math.h>
#include <string.h>

#include "draw.h"
#include "encoder/unwrap.h"
#include "rig.h"

#define MS 1000000
#define BIT(name) ETHD_FAULT_BIT(ETHD_FAULT_##name)

static const double TURN = 6.283185307179586;

/* 1000 lines, ratio 12, 16 bits, rising with the angle. */
static ethd__encoder_def ordinary(void) {
  return (ethd__encoder_def){.ceiling = 0xFFFF,
                             .counts_per_turn = 4000,
                             .ratio = 12,
                             .offset = 0,
                             .speed_max = 10,
                             .freeze_torque = 0.3,
                             .freeze_time = 0.050,
                             .reverse_torque = 0.1,
                             .reverse_time = 0.020,
                             .sign = 1};
}

typedef struct track {
  ethd__encoder_def def;
  ethd__encoder e;
  int64_t t, grave, seen;
} track;

static int64_t feed(track *k, int64_t position, double torque) {
  k->t += MS;
  ethd__count s = {.time_ns = k->t, .raw = (uint64_t)position & k->def.ceiling};
  int64_t bits = ethd__encoder_step(&k->def, &k->e, &s, torque, &k->grave);
  k->seen |= bits;
  return bits;
}

/* ---- unwrapping ---- */

/* Any width, any step that is less than half way round. */
START_TEST(test_widths) {
  uint32_t width = (uint32_t)_i;
  track k = {.def = ordinary()};
  k.def.ceiling = ethd__count_ceiling(width);
  k.def.speed_max = (double)INFINITY;
  int64_t half = width < 64 ? (int64_t)((k.def.ceiling >> 1) + 1) : INT64_MAX, p = 0;
  if (half > (int64_t)1 << 50) half = (int64_t)1 << 50;
  for (uint64_t i = 0; i < 2000; i++) {
    feed(&k, p, NAN);
    ck_assert_int_eq(k.e.position, p);
    if (half > 1) p += (int64_t)(draw_bits(i) % (uint64_t)(2 * half - 1)) - (half - 1);
  }
  ck_assert_int_eq(k.seen, 0);
}
END_TEST

/* A ceiling that is no power of two less one: 0 to 999. */
START_TEST(test_any_ceiling) {
  track k = {.def = ordinary()};
  k.def.ceiling = 999;
  for (int64_t p = -5000; p < 5000; p += 7) {
    k.t += MS;
    ethd__count s = {.time_ns = k.t, .raw = (uint64_t)(((p % 1000) + 1000) % 1000)};
    ck_assert_int_eq(ethd__encoder_step(&k.def, &k.e, &s, NAN, &k.grave), 0);
    ck_assert_int_eq(k.e.position, p + 5000);
  }
}
END_TEST

START_TEST(test_angle) {
  track k = {.def = ordinary()};
  k.def.offset = 0.5;
  feed(&k, 0, NAN);
  ck_assert_double_eq(k.e.q, 0.5);
  for (int i = 1; i <= 480; i++) feed(&k, 10 * i, NAN);
  ck_assert_double_eq_tol(k.e.q, 0.5 + TURN * 4800 / 48000, 1e-15);
  k.def.sign = -1;
  feed(&k, 4800, NAN);
  ck_assert_double_eq_tol(k.e.q, 0.5 - TURN * 4800 / 48000, 1e-15);
  ck_assert(!k.e.has_dq);
}
END_TEST

/* ---- jumps ---- */

START_TEST(test_one_jump_is_dropped) {
  track k = {.def = ordinary()};
  for (int i = 0; i < 50; i++) ck_assert_int_eq(feed(&k, 20 * i, NAN), 0);
  double before = k.e.q;
  ck_assert_int_eq(feed(&k, 20 * 50 + 500, NAN), BIT(ENCODER_JUMP)); /* 10 rad/s are 76 counts */
  ck_assert_double_eq_tol(k.e.q, before + 20 * TURN / 48000, 1e-12);  /* goes on as it went */
  ck_assert_int_eq(feed(&k, 20 * 51, NAN), 0);
  ck_assert_int_eq(k.e.position, 20 * 51);
  ck_assert_int_eq(k.grave, 0);
}
END_TEST

/* A counter that was set anew jumps again at the next sample. */
START_TEST(test_second_jump_is_grave) {
  track k = {.def = ordinary()};
  for (int i = 0; i < 50; i++) feed(&k, 20 * i, NAN);
  feed(&k, 20000, NAN);
  ck_assert_int_eq(k.grave, 0);
  ck_assert_int_eq(feed(&k, 20000, NAN), BIT(ENCODER_JUMP));
  ck_assert_int_eq(k.grave, BIT(ENCODER_JUMP));
}
END_TEST

START_TEST(test_jumps_far_apart) {
  track k = {.def = ordinary()};
  for (int i = 0; i < 100; i++) feed(&k, i % 11 == 10 ? 9000 : 0, NAN);
  ck_assert_int_eq(k.seen, BIT(ENCODER_JUMP));
  ck_assert_int_eq(k.grave, 0);
  for (int i = 0; i < 20; i++) feed(&k, i % 10 == 9 ? 9000 : 0, NAN); /* 10 ms */
  ck_assert_int_eq(k.grave, BIT(ENCODER_JUMP));
}
END_TEST

/* What was away for some samples may have gone further. */
START_TEST(test_gap_is_no_jump) {
  track k = {.def = ordinary()};
  feed(&k, 0, NAN);
  k.t += 9 * MS;
  ck_assert_int_eq(feed(&k, 700, NAN), 0);
}
END_TEST

START_TEST(test_above_the_ceiling) {
  track k = {.def = ordinary()};
  k.def.ceiling = 9999;
  feed(&k, 0, NAN);
  k.t += MS;
  ethd__count s = {.time_ns = k.t, .raw = 10000};
  ck_assert_int_eq(ethd__encoder_step(&k.def, &k.e, &s, NAN, &k.grave), BIT(ENCODER_JUMP));
}
END_TEST

/* ---- checks of a definition ---- */

START_TEST(test_check) {
  ethd_error error;
  ethd__encoder_def d = ordinary();
  ck_assert_int_eq(ethd__encoder_check(&d, 0.001, &error), ETHD_OK);
  d.ceiling = 0xFF; /* 127 counts per ms are 16.6 rad/s */
  ck_assert_int_eq(ethd__encoder_check(&d, 0.001, &error), ETHD_OK);
  d.speed_max = 17;
  ck_assert_int_eq(ethd__encoder_check(&d, 0.001, &error), ETHD_E_RANGE);
  ck_assert_str_eq(error.name, "speed_max");
  ck_assert_double_eq_tol(error.max, 127 * TURN / 48, 1e-9);
  d = ordinary(), d.sign = 0;
  ck_assert_int_eq(ethd__encoder_check(&d, 0.001, &error), ETHD_E_RANGE);
  ck_assert_str_eq(error.name, "sign");
  d = ordinary(), d.ratio = NAN;
  ck_assert_int_eq(ethd__encoder_check(&d, 0.001, &error), ETHD_E_NOT_FINITE);
  d = ordinary(), d.ceiling = 1; /* one bit has no direction */
  ck_assert_int_eq(ethd__encoder_check(&d, 0.001, NULL), ETHD_E_RANGE);
  d = ordinary(), d.freeze_torque = (double)INFINITY;
  ck_assert_int_eq(ethd__encoder_check(&d, 0.001, NULL), ETHD_OK);
}
END_TEST

int main(void) {
  Suite *suite = suite_create("encoder");
  TCase *t = tcase_create("encoder");
  tcase_add_loop_test(t, test_widths, 1, 65);
  tcase_add_test(t, test_any_ceiling);
  tcase_add_test(t, test_angle);
  tcase_add_test(t, test_one_jump_is_dropped);
  tcase_add_test(t, test_second_jump_is_grave);
  tcase_add_test(t, test_jumps_far_apart);
  tcase_add_test(t, test_gap_is_no_jump);
  tcase_add_test(t, test_above_the_ceiling);
  tcase_add_test(t, test_check);
  suite_add_tcase(suite, t);
  return rig_run(suite);
}
