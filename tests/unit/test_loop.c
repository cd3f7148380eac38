/* The loop on a virtual clock: the grid, overruns, what the device gets, rows; the histogram against a sort. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "unit/bench.h"

/* ---- the grid ---- */

TEST(test_ticks_stand_on_the_grid) {
  bench b;
  ethd_loop_stats s;
  bench_open(&b);
  bench_start(&b);
  for (int i = 0; i < 10; i++) ck_assert_int_eq(bench_tick(&b).trace.sense.missed, 0);
  for (int i = 0; i < 10; i++) ck_assert_int_eq(b.d.read_at[i], (6 + i) * (int64_t)PERIOD);
  ethd_loop_read(b.loop, &s);
  ck_assert_uint_eq(s.ticks, 10);
  ck_assert_uint_eq(s.overruns, 0);
  ck_assert_uint_eq(s.missed, 0);
  ck_assert_uint_eq(ethd_loop_periods(b.loop), 10);
  ck_assert_int_eq(s.wake.max, 0);
  ck_assert_int_eq(b.d.services, 10);
  bench_close(&b);
}

/* A tick of `busy` ns, from tick 3: the next one is on the grid, and knows what it missed. Exactly at the next
   instant is in time. */
static const struct {
  int64_t busy, missed;
} busy_ticks[] = {{PERIOD / 2, 0}, {PERIOD, 0},         {PERIOD + 1, 1},     {2 * PERIOD - 1, 1},
                  {2 * PERIOD, 1}, {2 * PERIOD + 1, 2}, {7 * PERIOD / 2, 3}, {100 * PERIOD, 99}};

TEST_LOOP(test_overruns_are_counted_and_realigned, 0, sizeof busy_ticks / sizeof *busy_ticks) {
  bench b;
  ethd_loop_stats s;
  int64_t missed = busy_ticks[_i].missed;
  bench_open(&b);
  b.d.stall_write[3] = busy_ticks[_i].busy;
  bench_start(&b);
  for (int i = 0; i < 10; i++) ck_assert_int_eq(bench_tick(&b).trace.sense.missed, i == 4 ? missed : 0);
  for (int i = 0; i < 10; i++) ck_assert_int_eq(b.d.read_at[i], (6 + i + (i > 3 ? missed : 0)) * (int64_t)PERIOD);
  ethd_loop_read(b.loop, &s);
  ck_assert_uint_eq(s.overruns, missed > 0);
  ck_assert_uint_eq(ethd_loop_periods(b.loop), (uint64_t)(10 + missed));
  ck_assert_uint_eq(s.missed, (uint64_t)missed);
  ck_assert_int_eq(s.tick.max, busy_ticks[_i].busy);
  bench_close(&b);
}

/* The clock ran on while the loop slept (preempted, suspended). */
TEST(test_late_wake_up_is_an_overrun) {
  bench b;
  ethd_loop_stats s;
  bench_open(&b);
  bench_start(&b);
  bench_tick(&b);
  b.clock += 3 * PERIOD + PERIOD / 4; /* now 9.25, due 7 */
  ethd_loop_row row = bench_tick(&b);
  ck_assert_int_eq(row.trace.sense.missed, 2);
  ck_assert_int_eq(b.d.read_at[1], 9 * (int64_t)PERIOD);
  bench_tick(&b);
  ck_assert_int_eq(b.d.read_at[2], 10 * (int64_t)PERIOD);
  ethd_loop_read(b.loop, &s);
  ck_assert_uint_eq(s.overruns, 1);
  ck_assert_uint_eq(s.missed, 2);
  ck_assert_int_eq(s.wake.max, 2 * PERIOD + PERIOD / 4);
  bench_close(&b);
}

/* The step's duration reaches the next step: the budget guard lives on it. A virtual step takes no time. */
TEST(test_two_runs_are_equal) {
  bench *b = calloc(2, sizeof *b);
  for (int k = 0; k < 2; k++) {
    bench_open(&b[k]);
    b[k].d.stall_read[7] = 2500000;
    bench_start(&b[k]);
  }
  for (int i = 0; i < 40; i++) {
    ethd_loop_row rows[2] = {bench_tick(&b[0]), bench_tick(&b[1])};
    ck_assert_int_eq(rows[0].trace.sense.step_ns, 0);
    ck_assert_mem_eq(&rows[0].trace, &rows[1].trace, sizeof rows[0].trace);
  }
  bench_close(&b[0]);
  bench_close(&b[1]);
  free(b);
}

/* ---- what the device gets ---- */

TEST(test_soft_start) {
  bench b;
  bench_open(&b);
  b.def.soft_start = 0.004;
  bench_start(&b);
  for (int i = 0; i < 8; i++) {
    ethd_loop_row row = bench_tick(&b);
    double share = i < 4 ? i / 4.0 : 1;
    ck_assert_double_eq_tol(row.share, share, 1e-12);
    ck_assert(row.trace.tau[0] != 0);
    ck_assert_double_eq(b.d.written[i].torque[0], row.share * row.trace.tau[0]);
    ck_assert_int_eq(row.armed, 1);
  }
  bench_close(&b);
}

TEST(test_disarm_and_enable) {
  bench b;
  bench_open(&b);
  bench_start(&b);
  ck_assert_int_eq(bench_tick(&b).marks, ETHD_ROW_STARTED);
  ck_assert(b.d.written[0].torque[0] != 0 && !b.d.written[0].safe);
  ethd_loop_disarm(b.loop);
  for (int i = 1; i < 4; i++) {
    ethd_loop_row row = bench_tick(&b);
    ck_assert(row.share == 0 && row.armed == 0 && row.trace.tau[0] != 0 && row.marks == 0);
    ck_assert(b.d.written[i].torque[0] == 0 && b.d.written[i].torque[1] == 0 && b.d.written[i].safe);
  }
  ck_assert_int_eq(b.d.safes, 1);
  ck_assert_int_eq(ethd_loop_enable(b.loop), ETHD_OK);
  ck_assert_int_eq(b.d.starts, 1);
  ethd_loop_row row = bench_tick(&b);
  ck_assert_int_eq(row.marks, ETHD_ROW_STARTED);
  ck_assert_int_eq(row.trace.tick, 0);
  ck_assert(b.d.written[4].torque[0] != 0);
  bench_close(&b);
}

/* Nobody knows what state a device is in that couldn't be started: it gets no torque, also if it had one before. */
TEST_LOOP(test_failed_enable_disarms, 0, 3) {
  static const ethd_status gives[] = {ETHD_E_DEVICE, ETHD_E_FILE, ETHD_STATUS_BUSY};
  bench b;
  bench_open(&b);
  bench_start(&b);
  bench_tick(&b);
  ck_assert_int_eq(ethd_loop_armed(b.loop), 1);
  b.d.start_gives = gives[_i];
  ck_assert_int_eq(ethd_loop_enable(b.loop), gives[_i] < 0 ? gives[_i] : ETHD_E_DEVICE);
  ck_assert_int_eq(ethd_loop_armed(b.loop), 0);
  ethd_loop_row row = bench_tick(&b);
  ck_assert(row.armed == 0 && row.share == 0 && row.marks == 0);
  ck_assert(b.d.written[1].safe && b.d.written[1].torque[0] == 0 && b.d.written[1].torque[1] == 0);
  ck_assert_int_eq(b.d.safes, 1);
  b.d.start_gives = ETHD_OK;
  ck_assert_int_eq(ethd_loop_enable(b.loop), ETHD_OK);
  ck_assert_int_eq(bench_tick(&b).armed, 1);
  bench_close(&b);
}

/* A second start would put the clock's grid and the soft start back under a device that has its torque. */
TEST(test_starts_once) {
  bench b;
  ethd_error error;
  bench_open(&b);
  bench_start(&b);
  for (int i = 0; i < 3; i++) bench_tick(&b);
  ethd_loop_disarm(b.loop);
  ck_assert_int_eq(ethd_loop_start(b.loop, &error), ETHD_E_ARGUMENT);
  ck_assert_str_eq(error.name, "loop");
  ck_assert_int_eq(ethd_loop_armed(b.loop), 0);
  ck_assert_int_eq(bench_tick(&b).marks, 0);
  ck_assert_int_eq(ethd_loop_join(b.loop), ETHD_OK);
  ck_assert_int_eq(ethd_loop_start(b.loop, NULL), ETHD_E_ARGUMENT);
  bench_close(&b);
}

/* A device that can't be read: the same tick gives zero torque, latched, until acknowledged and enabled. */
TEST(test_failed_read_disarms) {
  bench b;
  bench_open(&b);
  b.d.fail_read = 2;
  bench_start(&b);
  for (int i = 0; i < 5; i++) {
    ethd_loop_row row = bench_tick(&b);
    ck_assert_int_eq(row.trace.fault, i < 2 ? ETHD_FAULT_NONE : ETHD_FAULT_INPUT);
    ck_assert_int_eq(b.d.written[i].safe, i >= 2);
    if (i >= 2) ck_assert(b.d.written[i].torque[0] == 0 && b.d.written[i].torque[1] == 0);
  }
  ck_assert_int_eq(ethd_loop_armed(b.loop), 0);
  ck_assert_int_eq(b.d.safes, 1);
  ethd_loop_acknowledge(b.loop);
  ethd_loop_row row = bench_tick(&b);
  ck_assert_int_eq(row.marks, ETHD_ROW_CLEARED);
  ck_assert_int_eq(row.trace.fault, ETHD_FAULT_NONE);
  ck_assert(b.d.written[5].safe);
  bench_close(&b);
}

TEST(test_failed_write_disarms) {
  bench b;
  ethd_loop_stats s;
  bench_open(&b);
  b.d.fail_write = 2;
  bench_start(&b);
  for (int i = 0; i < 4; i++) bench_tick(&b);
  ck_assert_int_eq(b.d.written[2].safe, 0);
  ck_assert_int_eq(b.d.written[3].safe, 1);
  ck_assert_int_eq(b.d.safes, 1);
  ethd_loop_read(b.loop, &s);
  ck_assert_uint_eq(s.write_failures, 1);
  bench_close(&b);
}

TEST(test_zero_torque_is_the_last_thing) {
  bench b;
  bench_open(&b);
  bench_start(&b);
  bench_tick(&b);
  ethd_loop_stop(b.loop);
  ck_assert_int_eq(ethd_loop_join(b.loop), ETHD_OK);
  ck_assert_int_eq(b.d.writes, 2);
  ck_assert(b.d.written[1].safe && b.d.written[1].torque[0] == 0 && b.d.written[1].torque[1] == 0);
  ck_assert_int_eq(ethd_loop_ended(b.loop), 1);
  bench_close(&b);
  ck_assert_int_eq(b.d.writes, 2);
}

/* Rows without room are counted, and the next one says how many. */
TEST(test_lost_rows) {
  bench b;
  ethd_loop_row row;
  ethd_loop_stats s;
  bench_open(&b);
  b.def.rows = 4;
  bench_start(&b);
  for (int i = 0; i < 7; i++) ethd_loop_tick(b.loop);
  for (int i = 0; i < 4; i++) {
    ck_assert_int_eq(ethd_loop_take(b.loop, &row), ETHD_OK);
    ck_assert_int_eq(row.trace.tick, i);
    ck_assert_uint_eq(row.lost, 0);
  }
  ck_assert_int_eq(ethd_loop_take(b.loop, &row), ETHD_STATUS_EMPTY);
  row = bench_tick(&b);
  ck_assert_int_eq(row.trace.tick, 7);
  ck_assert_uint_eq(row.lost, 3);
  ck_assert_uint_eq(bench_tick(&b).lost, 0);
  ethd_loop_read(b.loop, &s);
  ck_assert_uint_eq(s.rows_lost, 3);
  bench_close(&b);
}

/* ---- refusals ---- */

TEST(test_refused_defs) {
  bench b;
  ethd_error error;
  bench_open(&b);
#define REFUSED(field, value, code)                                  \
  do {                                                               \
    ethd_loop_def def = b.def;                                       \
    def.field = value;                                               \
    ck_assert_int_eq(ethd_loop_create(&def, &b.loop, &error), code); \
    ck_assert_ptr_null(b.loop);                                      \
    if (code == ETHD_E_RANGE) ck_assert_str_eq(error.name, #field);  \
  } while (0)
  REFUSED(cookie, 0, ETHD_E_ARGUMENT);
  REFUSED(device, NULL, ETHD_E_ARGUMENT);
  REFUSED(control, NULL, ETHD_E_ARGUMENT);
  REFUSED(period, 0, ETHD_E_RANGE);
  REFUSED(period, (double)NAN, ETHD_E_RANGE);
  REFUSED(period, 2, ETHD_E_RANGE);
  REFUSED(period, 0.002, ETHD_E_ARGUMENT);
  ck_assert(!strcmp(error.name, "period") && error.found == 0.002 && error.min == ethd_control_period(b.def.control));
  REFUSED(cpu, -3, ETHD_E_RANGE);
  REFUSED(cpu, 1024, ETHD_E_RANGE);
  REFUSED(priority, 0, ETHD_E_RANGE);
  REFUSED(priority, 100, ETHD_E_RANGE);
  REFUSED(early_wake, 0.0006, ETHD_E_RANGE);
  REFUSED(early_wake, (double)NAN, ETHD_E_RANGE);
  REFUSED(soft_start, -1, ETHD_E_RANGE);
  REFUSED(dma_latency, -2, ETHD_E_RANGE);
  REFUSED(stack, 1000, ETHD_E_RANGE);
  REFUSED(rows, 1000, ETHD_E_RANGE);
  REFUSED(rows, 1u << 21, ETHD_E_RANGE);
  rig_close(&b.r);
}

/* ---- histogram ---- */

TEST(test_bins_join) {
  for (uint32_t bin = 0; bin + 1 < ETHD_BINS; bin++) {
    int64_t first = ethd_histogram_first(bin), last = ethd_histogram_last(bin);
    ck_assert(first <= last && last + 1 == ethd_histogram_first(bin + 1));
    ck_assert(bin < 64 ? first == last : (last - first) * 32 < first);
  }
}

static int by_size(const void *a, const void *b) {
  int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
  return (x > y) - (x < y);
}

/* The answer is in the bin of the sorted list's element, over it by at most 1/32. */
TEST(test_percentiles_against_a_sort) {
  enum { N = 20000 };
  static int64_t ns[N];
  static ethd_histogram h;
  static const double shares[] = {0, 1e-4, 0.01, 0.5, 0.9, 0.99, 0.999, 0.9999, 1};
  uint64_t x = 88172645463325252u;
  for (int i = 0; i < N; i++) {
    x ^= x << 13, x ^= x >> 7, x ^= x << 17;
    ns[i] = (int64_t)(x >> (30 + x % 32)); /* 2 to 2^34 */
    ethd_histogram_add(&h, ns[i]);
  }
  qsort(ns, N, sizeof *ns, by_size);
  for (size_t i = 0; i < sizeof shares / sizeof *shares; i++) {
    int64_t rank = (int64_t)ceil(shares[i] * N);
    int64_t exact = ns[rank > 0 ? rank - 1 : 0], found = ethd_histogram_at(&h, shares[i]);
    ck_assert_msg(found >= exact && (found - exact) * 32 <= exact, "%g: %ld, sorted %ld", shares[i], (long)found,
                  (long)exact);
  }
  ck_assert_int_eq(ethd_histogram_at(&h, 1), ns[N - 1]);
  ck_assert_int_eq(h.max, ns[N - 1]);
}

TEST(test_histogram_ends) {
  static ethd_histogram h;
  ck_assert_int_eq(ethd_histogram_at(&h, 0.5), 0);
  ethd_histogram_add(&h, -5);
  ck_assert_uint_eq(h.counts[0], 1);
  ethd_histogram_add(&h, INT64_MAX);
  ck_assert_uint_eq(h.counts[ETHD_BINS - 1], 1);
  ck_assert_int_eq(ethd_histogram_at(&h, 1), INT64_MAX);
  ck_assert_int_eq(ethd_histogram_at(&h, 0.5), 0);
}

/* Every shortfall has words, and nothing else has. */
TEST(test_shortfalls_have_words) {
  for (int i = 0; i < ETHD_SHORT_COUNT; i++) {
    ck_assert_str_ne(ethd_shortfall_sentence(1 << i), ethd_shortfall_sentence(1 << ETHD_SHORT_COUNT));
    ck_assert_uint_gt(strlen(ethd_shortfall_mend(1 << i)), 10);
  }
  ck_assert_str_eq(ethd_shortfall_mend(3), "");
}
