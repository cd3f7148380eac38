/* Rows of the fault table that device or loop saw: each meets its reaction, is counted and told once, and
   replays. */
#include <math.h>
#include <string.h>

#include "unit/draw.h"
#include "unit/moody.h"

static ethd_status with(rig *r, ethd_sense s, int64_t faults, int64_t grave) {
  s.faults = faults;
  s.grave = grave;
  return rig_try(r, &s);
}

/* Ring moving at v along x, 20 mm from the wall. */
static ethd_sense moving(const rig *r, double v) {
  motion m = rig_at(0.020, v, 0.001);
  ethd_sense s = rig_sense(&r->setup.arm, &m);
  s.time_ns = r->sense.time_ns + 1000000;
  return s;
}

/* ---- reactions, row by row ---- */

static void expect_goes_on(rig *r, const rig *healthy) {
  ck_assert(r->status == ETHD_OK && r->trace.fault == 0 && r->command.safe == 0);
  ck_assert_mem_eq(r->command.torque, healthy->command.torque, sizeof r->command.torque);
}

/* dx/dq1 = -0.25 m, and the ring moves to -x: damping, Ns/m, turns joint 1 to -. */
static void expect_damped(const rig *r, int row, double damping, double v) {
  ck_assert(r->status < 0 && r->trace.fault == row && r->command.safe == 0);
  ck_assert_double_eq_tol(r->command.torque[0], -0.25 * damping * v, 0.01 * v * damping);
}

/* After `missed` periods the first torque is taken to be held for as long, and is the smaller. */
static void expect_stops(rig *r, int row, int64_t missed) {
  expect_damped(r, row, MOODY_PROBE / (double)(1 + missed), 0.3);
  with(r, moving(r, 0.2), 0, 0);
  expect_damped(r, row, MOODY_DAMPING, 0.2);
  with(r, moving(r, 0.019), 0, 0);
  ck_assert(r->command.safe == 1 && r->command.torque[0] == 0 && r->trace.fault == row);
  with(r, moving(r, 0.3), 0, 0); /* moved by hand */
  ck_assert(r->command.safe == 1 && r->command.torque[0] == 0 && r->trace.fault == row);
}

static void expect_zero(rig *r, int row) {
  for (int i = 0; i < 3; i++, with(r, moving(r, 0.3), 0, 0))
    ck_assert(r->status < 0 && r->trace.fault == row && r->command.safe == 1 && r->command.torque[0] == 0 &&
              r->command.torque[1] == 0 && r->trace.tau[0] == 0);
}

TEST_LOOP(test_reaction, 2, 2 * ETHD_FAULT_COUNT) {
  int row = _i / 2, grave = _i % 2;
  rig r, healthy;
  moody_open(&r, 1);
  moody_open(&healthy, 1);
  rig_try(&r, &(ethd_sense){0});
  rig_try(&healthy, &(ethd_sense){0});
  with(&r, moving(&r, 0.3), grave ? 0 : ETHD_FAULT_BIT(row), grave ? ETHD_FAULT_BIT(row) : 0);
  with(&healthy, moving(&healthy, 0.3), 0, 0);
  ethd_reaction reaction = ethd_fault_reaction((ethd_fault)row, grave);
  if (reaction == ETHD_REACTION_STOP)
    expect_stops(&r, row, 0);
  else if (reaction == ETHD_REACTION_ZERO)
    expect_zero(&r, row);
  else
    expect_goes_on(&r, &healthy);
  ck_assert_uint_eq(rig_counted(&r, row), 1);
  if (grave || (row != ETHD_FAULT_TORQUE && row != ETHD_FAULT_TORQUE_RATE))
    moody_expect_event(&r, ETHD_EVENT_FAULT, row, grave);
  ck_assert_int_eq(rig_poll(&r).kind, 0);
  rig_close(&healthy);
  rig_close(&r);
}

/* Bits outside of the table mean nothing. */
TEST(test_unknown_bits) {
  rig r;
  moody_open(&r, 1);
  for (int bit = 0; bit < 64; bit++) {
    if (bit >= 1 && bit < ETHD_FAULT_COUNT) continue;
    ck_assert_int_eq(with(&r, moody_sense(&r), (int64_t)(UINT64_C(1) << bit), (int64_t)(UINT64_C(1) << bit)), ETHD_OK);
  }
  ck_assert_int_eq(rig_poll(&r).kind, 0);
  rig_close(&r);
}

/* Zero at once, whatever the rate limit: after a fault of the device, and of a law. */
TEST_LOOP(test_zero_is_quicker_than_the_rate_limit, 0, 2) {
  rig r;
  moody_open(&r, 1);
  r.setup.limits.torque_rate = 1;
  rig_post(&r);
  for (int i = 0; i < 100; i++) with(&r, moody_sense(&r), 0, 0);
  ck_assert_double_gt(fabs(r.command.torque[0]), 0.05);
  mood.contact = _i ? MOODY_FAIL : MOODY_WELL;
  with(&r, moody_sense(&r), _i ? 0 : ETHD_FAULT_BIT(ETHD_FAULT_DRIVE), 0);
  moody_expect_safe(&r, _i ? ETHD_E_LAW : ETHD_E_DEVICE, _i ? ETHD_FAULT_LAW : ETHD_FAULT_DRIVE);
  rig_close(&r);
}

/* ---- occurrences ---- */

TEST(test_occurrences) {
  const int row = ETHD_FAULT_FRAME_LOST, other = ETHD_FAULT_SENSOR;
  static const char way[] = "..##.#####..#", worse[] = "......xx.....";
  rig r;
  moody_open(&r, 1);
  for (int i = 0; way[i]; i++)
    with(&r, moody_sense(&r), way[i] == '#' ? ETHD_FAULT_BIT(row) | ETHD_FAULT_BIT(ETHD_FAULT_OVERRUN) : 0,
         worse[i] == 'x' ? ETHD_FAULT_BIT(ETHD_FAULT_TORQUE) : 0);
  ck_assert(rig_counted(&r, row) == 3 && rig_counted(&r, ETHD_FAULT_OVERRUN) == 3 &&
            rig_counted(&r, ETHD_FAULT_TORQUE) == 1);
  ck_assert_int_eq(r.status, ETHD_OK);
  for (int i = 0; i < 3; i++) {
    moody_expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_OVERRUN, 0);
    moody_expect_event(&r, ETHD_EVENT_FAULT, row, 0);
    if (i == 1) moody_expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_TORQUE, 1);
  }
  /* an occurrence that comes to the worst is told twice and counted once */
  with(&r, moody_sense(&r), ETHD_FAULT_BIT(other), 0);
  with(&r, moody_sense(&r), ETHD_FAULT_BIT(other), ETHD_FAULT_BIT(other));
  moody_expect_event(&r, ETHD_EVENT_FAULT, other, 0);
  moody_expect_event(&r, ETHD_EVENT_FAULT, other, 1);
  ck_assert(rig_counted(&r, other) == 1 && r.trace.fault == other);
  rig_close(&r);
}

/* ---- which is latched ---- */

TEST(test_first_stays) {
  rig r;
  moody_open(&r, 1);
  ethd_sense bad;
  with(&r, moving(&r, 0.3), ETHD_FAULT_BIT(ETHD_FAULT_APPLICATION), 0);
  ck_assert(r.trace.fault == ETHD_FAULT_APPLICATION && r.command.safe == 0);
  with(&r, moving(&r, 0.2), ETHD_FAULT_BIT(ETHD_FAULT_OVERRUNS), 0);
  expect_damped(&r, ETHD_FAULT_APPLICATION, MOODY_DAMPING, 0.2);
  with(&r, moving(&r, 0.3), ETHD_FAULT_BIT(ETHD_FAULT_EMERGENCY_STOP), 0); /* ends the damping */
  moody_expect_safe(&r, ETHD_E_DEVICE, ETHD_FAULT_APPLICATION);
  with(&r, moving(&r, 0.3), 0, 0);
  moody_expect_safe(&r, ETHD_E_DEVICE, ETHD_FAULT_APPLICATION);
  bad = moving(&r, 0.3);
  bad.q[0] = NAN;
  with(&r, bad, 0, 0);
  moody_expect_safe(&r, ETHD_E_DEVICE, ETHD_FAULT_APPLICATION);
  const int rows[] = {ETHD_FAULT_APPLICATION, ETHD_FAULT_OVERRUNS, ETHD_FAULT_EMERGENCY_STOP, ETHD_FAULT_INPUT};
  for (int i = 0; i < 4; i++) {
    moody_expect_event(&r, ETHD_EVENT_FAULT, rows[i], 0);
    ck_assert_uint_eq(rig_counted(&r, rows[i]), 1);
  }
  rig_close(&r);
}

/* Of one tick's: zero before stop, then the lowest row. */
TEST(test_worst_of_a_tick) {
  rig r;
  moody_open(&r, 1);
  with(&r, moving(&r, 0.3),
       ETHD_FAULT_BIT(ETHD_FAULT_OVERRUNS) | ETHD_FAULT_BIT(ETHD_FAULT_DRIVE) | ETHD_FAULT_BIT(ETHD_FAULT_BUS_VOLTAGE),
       0);
  moody_expect_safe(&r, ETHD_E_DEVICE, ETHD_FAULT_DRIVE);
  rig_close(&r);
}

/* ---- the clean time ---- */

TEST(test_clean_time) {
  rig r;
  moody_open(&r, 1);
  r.setup.limits.clean_time = 0.05;
  rig_post(&r);
  with(&r, moody_sense(&r), 0, 0);
  moody_expect_event(&r, ETHD_EVENT_TAKEN, 0, 0);
  ck_assert(isinf(ethd_control_clean_time(r.control)));
  for (int i = 0; i < 3; i++) with(&r, moody_sense(&r), ETHD_FAULT_BIT(ETHD_FAULT_DRIVE), 0);
  ck_assert_double_eq(ethd_control_clean_time(r.control), 0);
  moody_expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_DRIVE, 0);
  for (int i = 1; i <= 30; i++) {
    ethd_control_acknowledge(r.control); /* too early: means nothing, now and later */
    with(&r, moody_sense(&r), 0, 0);
    moody_expect_safe(&r, ETHD_E_DEVICE, ETHD_FAULT_DRIVE);
    ck_assert_double_eq_tol(ethd_control_clean_time(r.control), 0.001 * i, 1e-12);
  }
  with(&r, moody_sense(&r), ETHD_FAULT_BIT(ETHD_FAULT_OVERRUN), 0); /* nothing that stops */
  with(&r, moody_sense(&r), ETHD_FAULT_BIT(ETHD_FAULT_LINK_LOST), 0);
  ck_assert_double_eq(ethd_control_clean_time(r.control), 0);
  for (int i = 1; i <= 50; i++) with(&r, moody_sense(&r), 0, 0);
  moody_expect_safe(&r, ETHD_E_DEVICE, ETHD_FAULT_DRIVE);
  ethd_control_acknowledge(r.control);
  ck_assert_int_eq(with(&r, moody_sense(&r), 0, 0), ETHD_OK);
  ck_assert(isinf(ethd_control_clean_time(r.control)));
  rig_close(&r);
}

/* ---- the clock ---- */

/* After `missed` periods, and with the sample's instant `jump` ns off. */
static const struct {
  int64_t missed, jump;
  int bad;
} gaps[] = {{0, 0, 0},        {4, 0, 0},       {5, 0, 1},        {100, 0, 1},
            {0, 4900000, 0},  {0, 5100000, 1}, {0, -5100000, 1}, {0, INT64_MAX / 2, 1},
            {3, -5100000, 1}, {0, -4000000, 0}};

TEST_LOOP(test_clock, 0, sizeof gaps / sizeof *gaps) {
  for (int limited = 0; limited < 2; limited++) {
    rig r;
    moody_open(&r, 1);
    if (limited) r.setup.limits.gap = 0.005;
    rig_post(&r);
    for (int i = 0; i < 3; i++) with(&r, moving(&r, 0.3), 0, 0);
    ethd_sense s = moving(&r, 0.3);
    s.missed = gaps[_i].missed;
    s.time_ns += 1000000 * s.missed + gaps[_i].jump;
    with(&r, s, 0, 0);
    if (limited && gaps[_i].bad)
      expect_stops(&r, ETHD_FAULT_CLOCK, gaps[_i].missed);
    else
      ck_assert(r.status == ETHD_OK && r.trace.fault == 0);
    rig_close(&r);
  }
}

/* A clock that stands still or runs at another rate shows within two gaps of wrong time. Samples that come again, or
   that a device says are old, are late and no fault of a clock. */
static const struct {
  double rate;     /* of the device's clock */
  int every;       /* ticks between two new samples */
  bool told;       /* the device says that its feedback is old */
  int least, most; /* ticks after which row CLOCK shows; 0: it doesn't */
} clocks[] = {{1, 1, false, 0, 0},    {0, 1, false, 8, 12}, {4, 1, false, 2, 4},
              {1.01, 1, false, 0, 0}, {1, 7, false, 0, 0},  {0, 1, true, 0, 0}};

TEST_LOOP(test_clock_rate, 0, sizeof clocks / sizeof *clocks) {
  rig r;
  int seen = 0;
  moody_open(&r, 1);
  r.setup.limits.gap = 0.005;
  rig_post(&r);
  for (int i = 0; i < 100; i++) with(&r, moving(&r, 0), 0, 0);
  const int64_t from = r.sense.time_ns;
  for (int i = 1; i <= 1000 && !seen; i++) {
    ethd_sense s = moving(&r, 0);
    int64_t sample = i / clocks[_i].every * clocks[_i].every;
    s.time_ns = from + llround(clocks[_i].rate * 1e6 * (double)sample);
    with(&r, s, clocks[_i].told ? ETHD_FAULT_BIT(ETHD_FAULT_FEEDBACK_OLD) : 0, 0);
    if (rig_counted(&r, ETHD_FAULT_CLOCK)) seen = i;
  }
  ck_assert_msg(seen >= clocks[_i].least && seen <= clocks[_i].most, "row CLOCK after %d ticks", seen);
  rig_close(&r);
}

/* A bus's first sample may be from before the loop ran; the second may not. */
TEST_LOOP(test_first_sample, 0, 2) {
  rig r;
  moody_open(&r, 1);
  r.setup.limits.gap = 0.005;
  rig_post(&r);
  ethd_control_reset(r.control);
  for (int tick = 0; tick < 4; tick++) {
    ethd_sense s = moving(&r, 0);
    s.time_ns = 1000000 * (100 + tick) - (tick == _i ? 20000000 : 0);
    with(&r, s, 0, 0);
    ck_assert_int_eq(r.trace.fault, _i && tick > 1 ? ETHD_FAULT_CLOCK : 0);
  }
  rig_close(&r);
}

/* ---- replay ---- */

static void random_sense(const rig *r, int tick, ethd_sense *s) {
  uint64_t seed = (uint64_t)tick;
  *s = moving(r, draw(seed, -0.4, 0.4));
  s->time_ns = 1000000 * (int64_t)(tick + 1);
  if (draw(seed + 10000, 0, 1) < 0.05) s->faults = ETHD_FAULT_BIT((int)draw(seed + 20000, 1, ETHD_FAULT_COUNT));
  if (draw(seed + 30000, 0, 1) < 0.02) s->grave = ETHD_FAULT_BIT((int)draw(seed + 40000, 1, ETHD_FAULT_COUNT));
  if (draw(seed + 50000, 0, 1) < 0.01) s->q[1] = NAN;
}

TEST(test_replays) {
  enum { TICKS = 2000 };
  static ethd_trace first[TICKS];
  for (int pass = 0; pass < 2; pass++) {
    rig r;
    moody_open(&r, 1);
    r.setup.limits.clean_time = 0.01;
    rig_post(&r);
    int cleared = 0;
    for (int tick = 0; tick < TICKS; tick++) {
      ethd_sense s;
      random_sense(&r, tick, &s);
      if (pass) s = first[tick].sense;
      if (tick % 7 == 0) ethd_control_acknowledge(r.control);
      int64_t was = r.trace.fault;
      rig_try(&r, &s);
      cleared += was && !r.trace.fault;
      ck_assert(r.trace.fault == 0 || r.command.torque[0] == r.trace.tau[0]);
      if (pass) ck_assert_mem_eq(&r.trace, &first[tick], sizeof r.trace);
      first[tick] = r.trace;
    }
    ck_assert_int_gt(cleared, 10);
    rig_close(&r);
  }
}
