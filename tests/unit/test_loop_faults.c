/* What the loop itself sees of the fault table, on a virtual clock: lateness, an application that is silent,
   rows that it raises. */
#include <math.h>
#include <string.h>

#include "unit/bench.h"

#define BIT(row) ETHD_FAULT_BIT(ETHD_FAULT_##row)

static int64_t rows_of_tick(bench *b) { return bench_tick(b).trace.sense.faults; }

/* One late tick is counted; over 5 ms it is a stop, if anybody says so. */
static const struct {
  int64_t busy; /* ns of tick 3 */
  int limited;
  int64_t rows; /* of tick 4 */
} late_ticks[] = {{PERIOD, 0, 0},
                  {PERIOD + 1, 0, BIT(OVERRUN)},
                  {20 * PERIOD, 0, BIT(OVERRUN)},
                  {PERIOD + 1, 1, BIT(OVERRUN)},
                  {6 * PERIOD, 1, BIT(OVERRUN)},
                  {6 * PERIOD + 1, 1, BIT(OVERRUN) | BIT(OVERRUNS)}};

TEST_LOOP(test_late, 0, sizeof late_ticks / sizeof *late_ticks) {
  bench b;
  ethd_loop_stats stats;
  bench_open(&b);
  if (late_ticks[_i].limited) b.def.gap = 0.005;
  b.d.stall_write[3] = late_ticks[_i].busy;
  bench_start(&b);
  for (int i = 0; i < 8; i++) ck_assert_int_eq(rows_of_tick(&b), i == 4 ? late_ticks[_i].rows : 0);
  int stops = (late_ticks[_i].rows & BIT(OVERRUNS)) != 0;
  ck_assert_int_eq(ethd_loop_armed(b.loop), !stops); /* the ring is at rest */
  ethd_loop_read(b.loop, &stats);
  ck_assert_uint_eq(stats.faults[ETHD_FAULT_OVERRUN], late_ticks[_i].rows != 0);
  ck_assert_uint_eq(stats.faults[ETHD_FAULT_OVERRUNS], (uint64_t)stops);
  bench_close(&b);
}

/* The machine is suspended between two ticks: the loop's clock hasn't moved. */
static const struct {
  int64_t ns;
  int limited;
  int64_t faults, grave, missed; /* of tick 3 */
} suspensions[] = {{PERIOD - 1, 1, 0, 0, 0},
                   {PERIOD, 1, BIT(CLOCK), 0, 1},
                   {5 * PERIOD, 1, BIT(CLOCK), 0, 5},
                   {5 * PERIOD + 1, 1, 0, BIT(CLOCK), 5},
                   {3600000 * (int64_t)PERIOD, 1, 0, BIT(CLOCK), 3600000},
                   {3600000 * (int64_t)PERIOD, 0, BIT(CLOCK), 0, 3600000}};

TEST_LOOP(test_suspended, 0, sizeof suspensions / sizeof *suspensions) {
  bench b;
  int64_t suspended = 7777777; /* before the loop was there */
  bench_open(&b);
  if (suspensions[_i].limited) b.def.gap = 0.005;
  b.def.suspended = &suspended;
  bench_start(&b);
  for (int i = 0; i < 8; i++) {
    if (i == 3) suspended += suspensions[_i].ns;
    ethd_sense s = bench_tick(&b).trace.sense;
    ck_assert_int_eq(s.faults, i == 3 ? suspensions[_i].faults : 0);
    ck_assert_int_eq(s.grave, i == 3 ? suspensions[_i].grave : 0);
    ck_assert_int_eq(s.missed, i == 3 ? suspensions[_i].missed : 0);
  }
  ck_assert_int_eq(ethd_loop_armed(b.loop), !suspensions[_i].grave);
  suspended += 3600000 * (int64_t)PERIOD; /* before it is enabled anew */
  ck_assert_int_eq(ethd_loop_enable(b.loop), ETHD_OK);
  ck_assert_int_eq(bench_tick(&b).trace.fault, ETHD_FAULT_NONE);
  bench_close(&b);
}

/* The device's own limit is as good as the application's. */
static ethd_limits strict(const void *d) {
  (void)d;
  return ethd_limits_device();
}

TEST(test_limit_of_the_device) {
  bench b;
  bench_open(&b);
  ethd_driver own = *b.of_d.at[0].driver;
  own.limits = strict;
  device_of(&b.of_d, &own, &b.d);
  b.d.stall_write[3] = 7 * PERIOD;
  bench_start(&b);
  for (int i = 0; i < 4; i++) rows_of_tick(&b);
  ck_assert_int_eq(rows_of_tick(&b), BIT(OVERRUN) | BIT(OVERRUNS));
  bench_close(&b);
}

TEST(test_raise) {
  bench b;
  bench_open(&b);
  bench_start(&b);
  bench_tick(&b);
  ethd_loop_raise(b.loop, ETHD_FAULT_RECORDER);
  ethd_loop_raise(b.loop, ETHD_FAULT_NONE);
  ethd_loop_raise(b.loop, (ethd_fault)-1);
  ethd_loop_raise(b.loop, ETHD_FAULT_COUNT);
  ck_assert_int_eq(rows_of_tick(&b), BIT(RECORDER));
  ck_assert_int_eq(rows_of_tick(&b), 0); /* once */
  ck_assert_int_eq(ethd_loop_armed(b.loop), 1);
  ethd_loop_raise(b.loop, ETHD_FAULT_EMERGENCY_STOP);
  ethd_loop_row row = bench_tick(&b);
  ck_assert(row.trace.fault == ETHD_FAULT_EMERGENCY_STOP && !row.armed && b.d.safes == 1);
  ck_assert(b.d.written[b.d.writes - 1].safe == 1 && b.d.written[b.d.writes - 1].torque[0] == 0);
  bench_close(&b);
}

/* Counts outlive the reset of an enabling. */
TEST(test_counts_over_an_enabling) {
  bench b;
  ethd_loop_stats stats;
  bench_open(&b);
  bench_start(&b);
  for (int i = 0; i < 3; i++) {
    ethd_loop_raise(b.loop, ETHD_FAULT_EMERGENCY_STOP);
    bench_tick(&b);
    ck_assert_int_eq(ethd_loop_enable(b.loop), ETHD_OK);
    bench_tick(&b);
  }
  ethd_loop_read(b.loop, &stats);
  ck_assert_uint_eq(stats.faults[ETHD_FAULT_EMERGENCY_STOP], 3);
  bench_close(&b);
}

/* A joint sample that is due but not there; what the device says meanwhile. */
static struct {
  int from, until; /* ticks without */
  int64_t faults;
  ethd_status status; /* that says so */
} gap = {.status = ETHD_STATUS_STALE};

static const ethd_status nothing_new[] = {ETHD_STATUS_STALE, ETHD_STATUS_BUSY, ETHD_STATUS_EMPTY};
#define NOTHING_NEW (int)(sizeof nothing_new / sizeof *nothing_new)

static ethd_status gappy_read(void *device_, int64_t now, ethd_sense *out) {
  device *d = device_;
  int tick = d->reads++;
  out->have |= tick == gap.from ? ETHD_HAVE_RAYS : 0;
  if (tick < gap.from || tick >= gap.until) {
    out->q[0] = d->sense.q[0];
    out->q[1] = d->sense.q[1];
    out->time_ns = now;
    return ETHD_OK;
  }
  if (tick > gap.from) out->faults |= gap.faults;
  return gap.status;
}

static void open_gap(bench *b, ethd_driver *own, int64_t faults) {
  bench_open(b);
  *own = *b->of_d.at[0].driver;
  own->read = gappy_read;
  device_of(&b->of_d, own, &b->d);
  gap.from = 4, gap.until = 7, gap.faults = faults;
  bench_start(b);
}

static int rows_made(bench *b, ethd_loop_row *row) {
  ethd_loop_tick(b->loop);
  return ethd_loop_take(b->loop, row) == ETHD_OK;
}

/* Rows that only count wait for the next sample, and come with it; so does whatever else has come meanwhile. */
TEST_LOOP(test_holds_without_a_sample, 0, NOTHING_NEW) {
  bench b;
  ethd_driver own;
  ethd_loop_row row;
  gap.status = nothing_new[_i];
  open_gap(&b, &own, BIT(SENSOR) | BIT(OVERRUN));
  for (int i = 0; i < 4; i++) ck_assert(rows_made(&b, &row));
  for (int i = 4; i < 7; i++) ck_assert(!rows_made(&b, &row));
  ck_assert(rows_made(&b, &row));
  ck_assert(row.trace.sense.faults == (BIT(SENSOR) | BIT(OVERRUN)) && row.trace.sense.missed == 3);
  ck_assert(row.trace.sense.have & ETHD_HAVE_RAYS);
  ck_assert(row.trace.sense.q[0] == b.d.sense.q[0] && row.armed && row.trace.fault == 0);
  bench_close(&b);
}

/* Somebody who disarms doesn't wait for a sample. */
TEST(test_disarms_without_a_sample) {
  bench b;
  ethd_driver own;
  ethd_loop_row row;
  open_gap(&b, &own, 0);
  for (int i = 0; i < 4; i++) ck_assert(rows_made(&b, &row));
  ck_assert(!rows_made(&b, &row));
  ck_assert_int_eq(b.d.safes, 0);
  ethd_loop_disarm(b.loop);
  for (int i = 5; i < 7; i++) ck_assert(!rows_made(&b, &row));
  ck_assert_int_eq(b.d.safes, 1);
  ck_assert(rows_made(&b, &row) && !row.armed && row.share == 0);
  ck_assert_int_eq(b.d.safes, 1);
  bench_close(&b);
}

/* A row that ends the torque doesn't wait: the step knows the joints as they were last. */
TEST(test_ends_without_a_sample) {
  bench b;
  ethd_driver own;
  ethd_loop_row row, last;
  open_gap(&b, &own, BIT(FEEDBACK_OLD));
  for (int i = 0; i < 4; i++) ck_assert(rows_made(&b, &last));
  ck_assert(!rows_made(&b, &row));
  ck_assert(rows_made(&b, &row));
  ck_assert(row.trace.fault == ETHD_FAULT_FEEDBACK_OLD && row.trace.sense.missed == 1 && !row.armed);
  ck_assert(row.trace.sense.q[0] == b.d.sense.q[0] && row.trace.sense.q[1] == b.d.sense.q[1]);
  ck_assert_int_eq(row.trace.sense.time_ns, last.trace.sense.time_ns);
  ck_assert(row.trace.x[0] == last.trace.x[0] && row.trace.x[1] == last.trace.x[1]);
  bench_close(&b);
}

/* Ticks from the last sample to the one that ends the torque, by the gap in periods: so far two steps may be apart. The
   row that is named is the device's, and lasts as long as the samples are old. */
static const struct {
  double gap; /* periods; 0: none */
  int ticks;
} olds[] = {{0, 60}, {100, 60}, {20.5, 20}, {5, 5}, {2, 2}, {1, 1}};

TEST_LOOP(test_old_samples, 0, NOTHING_NEW * sizeof olds / sizeof *olds) {
  const int way = _i / NOTHING_NEW;
  bench b;
  ethd_driver own;
  ethd_loop_row row = {.armed = 0}, last;
  bench_open(&b);
  own = *b.of_d.at[0].driver;
  own.read = gappy_read;
  device_of(&b.of_d, &own, &b.d);
  if (olds[way].gap > 0) b.def.gap = olds[way].gap * 1e-9 * PERIOD;
  gap.status = nothing_new[_i % NOTHING_NEW];
  gap.from = 4, gap.until = 90, gap.faults = 0;
  bench_start(&b);
  for (int i = 0; i < 4; i++) ck_assert(rows_made(&b, &last));
  ck_assert(last.armed && last.trace.fault == 0);
  for (int i = 1; i < olds[way].ticks; i++) ck_assert(!rows_made(&b, &row));
  ck_assert_int_eq(b.d.safes, 0);
  for (int i = olds[way].ticks; i < olds[way].ticks + 8; i++) {
    ck_assert(rows_made(&b, &row));
    ck_assert_int_eq(row.trace.fault, ETHD_FAULT_FEEDBACK_OLD);
    ck_assert(row.trace.sense.faults == BIT(FEEDBACK_OLD) && !row.armed && row.trace.tau[0] == 0);
    ck_assert(row.trace.sense.q[0] == b.d.sense.q[0]);
    ck_assert_int_eq(b.d.safes, 1);
  }
  ethd_event e;
  ck_assert_int_eq(ethd_control_poll(b.r.control, &e), ETHD_OK);
  ck_assert(e.kind == ETHD_EVENT_FAULT && e.code == ETHD_FAULT_FEEDBACK_OLD);
  ck_assert_int_eq(ethd_control_poll(b.r.control, &e), ETHD_STATUS_EMPTY);
  bench_close(&b);
}

/* A law that takes its time: 0.1 s is the step's budget without any limit. */
static int64_t *law_clock, law_takes;

static ethd_status dawdle(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) {
  *law_clock += law_takes;
  return ethd_tracking_pd.step(p, state, in, tau);
}

TEST(test_budget_without_a_limit) {
  const int64_t takes[] = {100000000, 100000001};
  for (int over = 0; over < 2; over++) {
    bench b;
    ethd_tracking_law law = ethd_tracking_pd;
    law.step = dawdle;
    bench_open(&b);
    double p[ETHD_PARAMS_MAX];
    memcpy(p, b.r.setup.tracking_p, sizeof p);
    ethd_setup_tracking(&b.r.setup, &law);
    memcpy(b.r.setup.tracking_p, p, sizeof p);
    law_clock = &b.clock;
    law_takes = 0;
    rig_post(&b.r);
    bench_start(&b);
    ck_assert_int_eq(bench_tick(&b).trace.fault, 0);
    law_takes = takes[over];
    ck_assert_int_eq(bench_tick(&b).trace.fault, 0);
    law_takes = 0;
    ethd_loop_row row = bench_tick(&b);
    ck_assert_int_eq(row.trace.sense.step_ns, takes[over]);
    ck_assert_int_eq(row.trace.fault, over ? ETHD_FAULT_BUDGET : 0);
    bench_close(&b);
  }
}

TEST(test_bad_bounds) {
  const double bad[] = {NAN, -1, 0, 0.0009};
  bench b;
  bench_open(&b);
  for (int i = 0; i < 8; i++) {
    ethd_loop_def def = b.def;
    ethd_error error;
    *(i % 2 ? &def.gap : &def.heartbeat) = bad[i / 2];
    ck_assert_int_eq(ethd_loop_create(&def, &b.loop, &error), ETHD_E_RANGE);
    ck_assert_str_eq(error.name, i % 2 ? "gap" : "heartbeat");
  }
  b.loop = NULL;
  bench_close(&b);
}
