/* The board's clock in host time: jitter, bursts, drift, lost frames, a reset, corrupt times. */
#include <math.h>
#include <stdio.h>

#include "proximity_ring/board_clock.h"
#include "unit/rig.h"
#include "unit/ring_frames.h"

#define DELAY 0.0035
#define NS 1e-9

/* A board: its frames, when they were taken in truth, and when they arrive. */
typedef struct board {
  double drift, jitter; /* host per board second, less 1; s */
  double hold;          /* s: arrivals wait for the next multiple of it, as a USB adapter's; 0: they don't */
  int64_t start_ns;     /* host time at board time 0 */
  uint32_t first_us;    /* t_us at board time 0 */
  uint32_t key;
} board;

static double taken(const board *b, uint32_t i) { return (double)i / ETHD__FRAME_RATE * (1 + b->drift); }

static ethd__ring_frame frame_of(const board *b, uint32_t i) {
  ethd__ring_frame f = {.type = ETHD__FRAME_TYPE, .seq = (uint16_t)i, .flags = i ? 0 : ETHD__FRAME_FIRST};
  f.t_us = b->first_us + (uint32_t)((uint64_t)i * 1000000 / ETHD__FRAME_RATE);
  return f;
}

/* Mostly near the least delay, with a long tail. */
static int64_t arrival(const board *b, uint32_t i) {
  double late = -b->jitter * log(1 - draw(((uint64_t)b->key << 32) + i, 0, 1));
  double t = taken(b, i) + DELAY + late;
  if (b->hold > 0) t = b->hold * ceil(t / b->hold);
  return b->start_ns + llrint(1e9 * t);
}

static double error_of(const board *b, uint32_t i, int64_t t_ns) {
  return NS * (double)(t_ns - b->start_ns) - taken(b, i);
}

/* The largest error of frames from..to, s; all must be good. */
static double run(ethd__board_clock *c, const board *b, uint32_t from, uint32_t to) {
  double worst = 0;
  for (uint32_t i = from; i < to; i++) {
    ethd__ring_frame f = frame_of(b, i);
    int64_t t_ns;
    ck_assert_int_eq(ethd__board_clock_step(c, &f, arrival(b, i), &t_ns), ETHD__CLOCK_GOOD);
    worst = fmax(worst, fabs(error_of(b, i, t_ns)));
  }
  return worst;
}

enum { SECOND = ETHD__FRAME_RATE };

TEST(test_steady) {
  static const struct {
    double drift, jitter, hold, first_second, later; /* the largest error then, s */
  } rows[] = {
      {0, 0, 0, 2e-6, 2e-6},
      {50e-6, 200e-6, 0, 0.5e-3, 40e-6},
      {-50e-6, 200e-6, 0, 0.5e-3, 40e-6},
      {50e-6, 200e-6, 1e-3, 1.5e-3, 0.4e-3}, /* a USB adapter, low latency */
      {50e-6, 200e-6, 16e-3, 18e-3, 1.5e-3}, /* and as it comes */
      {5e-3, 200e-6, 1e-3, 4e-3, 0.4e-3},    /* a ceramic resonator */
      {-5e-3, 200e-6, 1e-3, 4e-3, 0.4e-3},
      {20e-3, 200e-6, 0, 8e-3, 0.1e-3}, /* a broken one: the finger isn't lost by it */
      {-20e-3, 200e-6, 0, 8e-3, 0.1e-3},
      {-20e-3, 200e-6, 1e-3, 8e-3, 0.4e-3},
  };
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
    for (uint32_t key = 0; key < 4; key++) {
      board b = {rows[k].drift, rows[k].jitter, rows[k].hold, 123456789012345, 0xfffff000u - 77 * key, key};
      ethd__board_clock c = {.delay = DELAY};
      double first = run(&c, &b, 0, SECOND), soon = run(&c, &b, SECOND, 8 * SECOND);
      double later = run(&c, &b, 8 * SECOND, 60 * SECOND);
      if (key == 0)
        printf(
            "drift %5.0f ppm, jitter %.0f us, hold %2.0f ms: largest error %7.1f us in the first second, %6.1f to 8 s, "
            "%6.1f then\n",
            1e6 * b.drift, 1e6 * b.jitter, 1e3 * b.hold, 1e6 * first, 1e6 * soon, 1e6 * later);
      ck_assert_msg(first <= rows[k].first_second, "row %zu: %g s at first", k, first);
      ck_assert_msg(later <= rows[k].later, "row %zu: %g s then", k, later);
      ck_assert_uint_eq(c.jumps + c.doubts, 0);
    }
}

/* Eighty minutes, the board's clock wraps: the error doesn't grow. */
TEST(test_long) {
  board b = {.drift = 80e-6, .jitter = 200e-6, .start_ns = INT64_C(1) << 50, .first_us = 1};
  ethd__board_clock c = {.delay = DELAY};
  run(&c, &b, 0, 10 * SECOND);
  ck_assert_double_le(run(&c, &b, 10 * SECOND, 80 * 60 * SECOND), 100e-6);
  ck_assert_uint_eq(c.jumps + c.doubts, 0);
}

/* Every 5 s the host sleeps for 0.3 s and finds all frames at once. */
TEST(test_bursts) {
  board b = {.drift = 50e-6, .jitter = 200e-6, .start_ns = 1000};
  ethd__board_clock c = {.delay = DELAY};
  double worst = 0;
  for (uint32_t i = 0; i < 60 * SECOND; i++) {
    ethd__ring_frame f = frame_of(&b, i);
    int64_t at = arrival(&b, i), in_round = (at - b.start_ns) % 5000000000, t_ns;
    if (in_round > 4700000000) at += 5000000000 - in_round;
    ck_assert_int_eq(ethd__board_clock_step(&c, &f, at, &t_ns), ETHD__CLOCK_GOOD);
    if (i > 8 * SECOND) worst = fmax(worst, fabs(error_of(&b, i, t_ns)));
  }
  printf("stalls of 300 ms: largest error %.1f us\n", 1e6 * worst);
  ck_assert_double_le(worst, 60e-6);
}

TEST(test_lost_frames) {
  board b = {.drift = 50e-6, .jitter = 200e-6};
  ethd__board_clock c = {.delay = DELAY};
  run(&c, &b, 0, 9 * SECOND);
  for (uint32_t i = 9 * SECOND, n = 0; n < 3000; n++, i += 1 + (n % 100 == 0 ? 5 * SECOND : n % 7))
    ck_assert_double_le(run(&c, &b, i, i + 1), 60e-6);
}

/* Board 0 loses 1 to 9 periods: time goes on, the sequence doesn't. Told by the flag, or with that frame lost. */
TEST(test_late) {
  for (uint32_t lost = 0; lost < 2; lost++) {
    board b = {.drift = 50e-6};
    ethd__board_clock c = {.delay = DELAY};
    uint16_t behind = 0;
    for (uint32_t i = 0; i < 20 * SECOND; i++) {
      bool late = i % 100 == 99;
      uint32_t periods = late ? 1 + i / 100 % 9 : 0;
      i += periods;
      behind = (uint16_t)(behind + periods);
      ethd__ring_frame f = frame_of(&b, i);
      f.seq = (uint16_t)(f.seq - behind);
      if (late && lost) continue;
      if (late) f.flags |= ETHD__FRAME_LATE;
      int64_t t_ns;
      ck_assert_int_eq(ethd__board_clock_step(&c, &f, arrival(&b, i), &t_ns), ETHD__CLOCK_GOOD);
    }
  }
}

/* A reset is seen in its first frame; if that is lost, in the next and believed in the one after. The board's
   own drift is known by then: the time is right at once. */
TEST(test_reset) {
  for (uint32_t lost = 0; lost < 4; lost++)
    for (uint32_t when = 9 * SECOND; when < 9 * SECOND + 50; when++) {
      board b = {.drift = 50e-6, .jitter = 100e-6, .start_ns = 5}, after = b;
      ethd__board_clock c = {.delay = DELAY};
      int64_t t_ns;
      run(&c, &b, 0, when);
      after.start_ns += 40000000000 + when;
      ethd__ring_frame f = frame_of(&after, lost);
      ethd__clock_verdict verdict = ethd__board_clock_step(&c, &f, arrival(&after, lost), &t_ns);
      ck_assert_int_eq(verdict, lost ? ETHD__CLOCK_DOUBTFUL : ETHD__CLOCK_JUMPED);
      f = frame_of(&after, lost + 1);
      verdict = ethd__board_clock_step(&c, &f, arrival(&after, lost + 1), &t_ns);
      ck_assert_int_eq(verdict, lost ? ETHD__CLOCK_JUMPED : ETHD__CLOCK_GOOD);
      ck_assert_uint_eq(c.jumps, 1);
      ck_assert_double_le(run(&c, &after, lost + 2, SECOND), 1.2e-3);
      ck_assert_double_le(run(&c, &after, SECOND, 2 * SECOND), 50e-6);
    }
}

/* A time or sequence that has passed the CRC and is wrong: that frame isn't used, the next one is, and the
   alignment is what it was. */
TEST(test_corrupt_times) {
  for (uint32_t kind = 0; kind < 200; kind++) {
    board b = {.drift = 50e-6, .jitter = 100e-6};
    ethd__board_clock c = {.delay = DELAY};
    int64_t t_ns;
    run(&c, &b, 0, 9 * SECOND);
    ethd__ring_frame f = frame_of(&b, 9 * SECOND);
    if (kind & 1)
      f.t_us ^= 1u << (7 + kind / 2 % 25);
    else
      f.seq ^= (uint16_t)(1u << (kind / 2 % 16));
    ck_assert_int_eq(ethd__board_clock_step(&c, &f, arrival(&b, 9 * SECOND), &t_ns), ETHD__CLOCK_DOUBTFUL);
    f = frame_of(&b, 9 * SECOND + 1);
    ck_assert_int_eq(ethd__board_clock_step(&c, &f, arrival(&b, 9 * SECOND + 1), &t_ns), ETHD__CLOCK_RETURNED);
    ck_assert_double_le(fabs(error_of(&b, 9 * SECOND + 1, t_ns)), 40e-6);
    ck_assert_double_le(run(&c, &b, 9 * SECOND + 2, 12 * SECOND), 40e-6);
    ck_assert(c.jumps == 0 && c.doubts == 1);
  }
}

/* Time and sequence jump together, as after many lost frames, but no such time has passed. */
TEST(test_jump_ahead) {
  board b = {.drift = 50e-6, .jitter = 100e-6}, ahead = b;
  ethd__board_clock c = {.delay = DELAY};
  int64_t t_ns;
  run(&c, &b, 0, 9 * SECOND);
  ahead.start_ns -= 2000000000; /* 2 s */
  ethd__ring_frame f = frame_of(&ahead, 11 * SECOND);
  ck_assert_int_eq(ethd__board_clock_step(&c, &f, arrival(&ahead, 11 * SECOND), &t_ns), ETHD__CLOCK_DOUBTFUL);
  f = frame_of(&ahead, 11 * SECOND + 1);
  ck_assert_int_eq(ethd__board_clock_step(&c, &f, arrival(&ahead, 11 * SECOND + 1), &t_ns), ETHD__CLOCK_JUMPED);
  ck_assert_double_le(fabs(error_of(&ahead, 11 * SECOND + 1, t_ns)), 1e-3);
}

TEST(test_restart) {
  board b = {.drift = 50e-6, .jitter = 0, .start_ns = 7};
  ethd__board_clock c = {.delay = DELAY};
  run(&c, &b, 0, 9 * SECOND);
  ethd__board_clock_restart(&c);
  ck_assert_double_le(run(&c, &b, 300 * SECOND, 301 * SECOND), 2e-6);
  ck_assert_uint_eq(c.jumps + c.doubts, 0);
}
