/* One encoder: counts to angles, speeds and faults. */
#include <math.h>
#include <string.h>

#include "draw.h"
#include "encoder/unwrap.h"
#include "rig.h"
#include "unit/suite.h"

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
                             .reverse_time = 0.010,
                             .inertia = 0.01,
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
TEST_LOOP(test_widths, 1, 65) {
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

/* A ceiling that is no power of two less one: 0 to 999. */
TEST(test_any_ceiling) {
  track k = {.def = ordinary()};
  k.def.ceiling = 999;
  for (int64_t p = -5000; p < 5000; p += 7) {
    k.t += MS;
    ethd__count s = {.time_ns = k.t, .raw = (uint64_t)(((p % 1000) + 1000) % 1000)};
    ck_assert_int_eq(ethd__encoder_step(&k.def, &k.e, &s, NAN, &k.grave), 0);
    ck_assert_int_eq(k.e.position, p + 5000);
  }
}

TEST(test_angle) {
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

/* ---- jumps ---- */

TEST(test_one_jump_is_dropped) {
  track k = {.def = ordinary()};
  for (int i = 0; i < 50; i++) ck_assert_int_eq(feed(&k, 20 * i, NAN), 0);
  double before = k.e.q;
  ck_assert_int_eq(feed(&k, 20 * 50 + 500, NAN), BIT(ENCODER_JUMP)); /* 10 rad/s are 76 counts */
  ck_assert_double_eq_tol(k.e.q, before + 20 * TURN / 48000, 1e-12); /* goes on as it went */
  ck_assert_int_eq(feed(&k, 20 * 51, NAN), 0);
  ck_assert_int_eq(k.e.position, 20 * 51);
  ck_assert_int_eq(k.grave, 0);
}

/* A counter that was set anew jumps again at the next sample. */
TEST(test_second_jump_is_grave) {
  track k = {.def = ordinary()};
  for (int i = 0; i < 50; i++) feed(&k, 20 * i, NAN);
  feed(&k, 20000, NAN);
  ck_assert_int_eq(k.grave, 0);
  ck_assert_int_eq(feed(&k, 20000, NAN), BIT(ENCODER_JUMP));
  ck_assert_int_eq(k.grave, BIT(ENCODER_JUMP));
}

TEST(test_jumps_far_apart) {
  track k = {.def = ordinary()};
  for (int i = 0; i < 100; i++) feed(&k, i % 11 == 10 ? 9000 : 0, NAN);
  ck_assert_int_eq(k.seen, BIT(ENCODER_JUMP));
  ck_assert_int_eq(k.grave, 0);
  for (int i = 0; i < 20; i++) feed(&k, i % 10 == 9 ? 9000 : 0, NAN); /* 10 ms */
  ck_assert_int_eq(k.grave, BIT(ENCODER_JUMP));
}

/* What was away for some samples may have gone further. */
TEST(test_gap_is_no_jump) {
  track k = {.def = ordinary()};
  feed(&k, 0, NAN);
  k.t += 9 * MS;
  ck_assert_int_eq(feed(&k, 700, NAN), 0);
}

TEST(test_above_the_ceiling) {
  track k = {.def = ordinary()};
  k.def.ceiling = 9999;
  feed(&k, 0, NAN);
  k.t += MS;
  ethd__count s = {.time_ns = k.t, .raw = 10000};
  ck_assert_int_eq(ethd__encoder_step(&k.def, &k.e, &s, NAN, &k.grave), BIT(ENCODER_JUMP));
}

/* ---- against the torque ---- */

TEST(test_frozen) {
  track k = {.def = ordinary()};
  for (int i = 0; i < 200; i++) ck_assert_int_eq(feed(&k, 0, 1.0), 0); /* pressed against a wall, and steady */
  for (int i = 0; i < 100; i++) ck_assert_int_eq(feed(&k, 0, 1.0 + (i % 2 ? 0.1 : -0.1)), 0);
  int t = 0;
  while (!feed(&k, 0, 1.5)) t++;
  ck_assert(k.seen == BIT(ENCODER_FROZEN) && t >= 48 && t <= 51);
  ck_assert_int_eq(feed(&k, 1, 1.5), 0); /* it moves */
  for (int i = 0; i < 100; i++) ck_assert_int_eq(feed(&k, 1, 1.5), 0);
  for (int i = 0; i < 100; i++) ck_assert_int_eq(feed(&k, 1, NAN), 0);
}

/* A joint of 0.01 kg m^2 under a torque and a hand, its reading's sign; ms until the row is seen, -1: never. */
static int drive(double torque, double hand, double v, int reading) {
  track k = {.def = ordinary()};
  double q = 0;
  for (int ms = 0; ms < 100; ms++) {
    v += 1e-3 * (torque + hand) / 0.01;
    q += 1e-3 * v;
    if (feed(&k, reading * (int64_t)rint(q * 48000 / TURN), torque)) return k.seen == BIT(ENCODER_REVERSED) ? ms : -2;
    if (fabs(v) > 5) break;
  }
  return -1;
}

TEST(test_reversed) {
  for (double torque = 0.15; torque < 0.8; torque += 0.1) {
    int after = drive(torque, 0, 0, -1);
    ck_assert_msg(after >= 9 && after <= 20, "%g Nm: %d ms", torque, after);
    ck_assert_int_eq(drive(torque, 0, 0, 1), -1);             /* as it should be */
    ck_assert_int_eq(drive(torque, 0, -1.5, 1), -1);          /* it brakes */
    ck_assert_int_eq(drive(torque, -1.1 * torque, 0, 1), -1); /* a hand pushes back, a little stronger */
    ck_assert_int_eq(drive(torque, -0.5 * torque, 0, -1) > 8, 1);
  }
  ck_assert_int_eq(drive(0.09, 0, 0, -1), -1); /* too little to tell */
}

/* ---- index marks ---- */

static int64_t pass(track *k, int64_t position, int64_t index) {
  k->t += MS;
  ethd__count s = {.time_ns = k->t,
                   .raw = (uint64_t)position & k->def.ceiling,
                   .index = (uint64_t)index & k->def.ceiling,
                   .flags = ETHD__COUNT_INDEX};
  return ethd__encoder_step(&k->def, &k->e, &s, NAN, &k->grave);
}

static int64_t turn_to(track *k, int64_t to) {
  int64_t bits = 0, p = k->e.position;
  for (; p != to; bits |= feed(k, p, NAN)) p += to > p ? (to - p < 60 ? to - p : 60) : (p - to < 60 ? to - p : -60);
  return bits;
}

TEST(test_index_distances) {
  track k = {.def = ordinary()};
  feed(&k, 100, NAN);
  ck_assert_int_eq(pass(&k, 105, 103), 0);
  ck_assert_int_eq(turn_to(&k, 4100), 0);
  ck_assert_int_eq(pass(&k, 4110, 4104), 0); /* a turn and one */
  ck_assert_int_eq(turn_to(&k, 105), 0);
  ck_assert_int_eq(pass(&k, 100, 103), 0);
  turn_to(&k, 8095);
  ck_assert_int_eq(pass(&k, 8100, 8103), 0);
  turn_to(&k, 12090);
  ck_assert_int_eq(pass(&k, 12100, 12105), BIT(INDEX)); /* two over */
  ck_assert_int_eq(k.e.misindexed, 1);
  ethd__encoder_restart(&k.e);
  ck_assert_int_eq(k.e.misindexed, 1);
}

/* The home mark is a whole turn's, the one that is nearest to where the joint was said to be. */
TEST(test_home) {
  for (int64_t mark = -9000; mark < 9000; mark += 777) {
    track k = {.def = ordinary()};
    k.def.home = 1;
    k.def.offset = 0.1;
    feed(&k, mark - 5, NAN);
    ck_assert(!k.e.homed);
    ck_assert_int_eq(pass(&k, mark + 5, mark), 0);
    ck_assert(k.e.homed);
    double turns = (double)(mark - k.e.home) / 4000;
    ck_assert(turns == rint(turns) && fabs((double)k.e.home) <= 2000);
    ck_assert_double_eq_tol(k.e.q, 0.1 + (double)(mark + 5 - k.e.home) * TURN / 48000, 1e-12);
  }
}

/* ---- speed from edges ---- */

/* At 30 mm/s of the ring (0.12 rad/s, an edge in 1.1 ms), turning around and standing: the difference of counts
   is wrong by up to a count in a ms, 0.13 rad/s. */
TEST(test_edges) {
  track k = {.def = ordinary()};
  k.def.stamps = 1;
  int64_t count = 0, edge = 0;
  double sum = 0, worst = 0;
  int n = 0;
  for (int us = 0; us < 400000; us += 10) {
    double t = 1e-6 * us, q = 0.12 * (t < 0.2 ? t : 0.4 - t);
    int64_t now = (int64_t)floor(q * 48000 / TURN);
    if (now != count) edge = (int64_t)us * 1000 + 1, count = now;
    if (us % 1000) continue;
    ethd__count s = {.time_ns = (int64_t)us * 1000 + 2, .edge_ns = edge, .raw = (uint64_t)count & k.def.ceiling};
    ck_assert_int_eq(ethd__encoder_step(&k.def, &k.e, &s, NAN, &k.grave), 0);
    if (us < 5000 || (us > 199000 && us < 205000)) continue;
    ck_assert_int_eq(k.e.has_dq, 1);
    double error = k.e.dq - (t < 0.2 ? 0.12 : -0.12);
    worst = fmax(worst, fabs(error));
    sum += error * error;
    n++;
  }
  ck_assert_msg(sqrt(sum / n) < 0.01 * 0.12 && worst < 0.02 * 0.12, "rms %g, worst %g rad/s", sqrt(sum / n), worst);
  for (int i = 1; i < 60; i++) {
    ethd__count s = {.time_ns = 400000000 + (int64_t)i * MS, .edge_ns = edge, .raw = (uint64_t)count & k.def.ceiling};
    ck_assert_int_eq(ethd__encoder_step(&k.def, &k.e, &s, NAN, &k.grave), 0);
    ck_assert_double_le(fabs(k.e.dq), TURN / 48000 / (1e-3 * i));
  }
  ck_assert_double_eq(k.e.dq, 0);
}

/* ---- checks of a definition ---- */

TEST(test_check) {
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
