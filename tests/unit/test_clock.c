/* The device's clock in space, and in either front where a new setup begins to watch it. The plane's own cases are in
   test_fault_rows.c. */
#include <math.h>

#include "ethd/space.h"
#include "unit/mover.h"
#include "unit/rig.h"

#define GAP 0.005 /* s */

static uint64_t clock_faults(const ethd_space *space) {
  ethd_counters counters;
  ethd_space_counters(space, &counters);
  return counters.faults[ETHD_FAULT_CLOCK];
}

static ethd_space_setup watching(void) {
  ethd_space_setup setup = ethd_space_setup_default();
  setup.gap = GAP;
  return setup;
}

/* A tick whose sample is of this instant. */
static void tick(ethd_space *space, int64_t time_ns, int64_t faults, int64_t missed) {
  const ethd_space_sense s = {.time_ns = time_ns, .have = ETHD_SPACE_HAVE_FINGER, .missed = missed, .faults = faults};
  ethd_space_command command;
  (void)ethd_space_step(space, &s, NULL, 0, &command, NULL);
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

TEST_LOOP(test_rate_in_space, 0, sizeof clocks / sizeof *clocks) {
  const ethd_space_setup setup = watching();
  ethd_space *space = made(&setup);
  int seen = 0;
  for (int i = 0; i < 100; i++) tick(space, 1000000 * (i - 100), 0, 0);
  for (int i = 0; i <= 1000 && !seen; i++) {
    const int sample = i / clocks[_i].every * clocks[_i].every;
    tick(space, llround(clocks[_i].rate * 1e6 * sample), clocks[_i].told ? ETHD_FAULT_BIT(ETHD_FAULT_FEEDBACK_OLD) : 0,
         0);
    if (clock_faults(space)) seen = i;
  }
  ck_assert_msg(seen >= clocks[_i].least && seen <= clocks[_i].most, "row CLOCK after %d ticks", seen);
  ethd_space_destroy(space);
}

/* A step that is late, or a stamp that jumps, by more than the gap. */
static const struct {
  int64_t missed, jump; /* periods, ns */
  uint64_t faults;
} steps[] = {{0, 0, 0}, {4, 0, 0}, {5, 0, 1}, {0, 4900000, 0}, {0, 5100000, 1}, {0, -5100000, 1}, {0, INT64_MAX, 1}};

TEST_LOOP(test_step_in_space, 0, sizeof steps / sizeof *steps) {
  const ethd_space_setup setup = watching();
  ethd_space *space = made(&setup);
  for (int i = 0; i < 3; i++) tick(space, 1000000 * (i - 3), 0, 0);
  tick(space, 1000000 * steps[_i].missed + steps[_i].jump, 0, steps[_i].missed);
  ck_assert_uint_eq(clock_faults(space), steps[_i].faults);
  ethd_space_destroy(space);
}

/* A setup that begins to limit the gap while the device runs compares no stamp from before it; from then on it does. */
TEST(test_begins_in_space) {
  ethd_space_setup setup = ethd_space_setup_default();
  ethd_space *space = made(&setup);
  ethd_error error;
  const int64_t now = 3600 * INT64_C(1000000000);
  for (int i = 0; i < 600; i++) {
    if (i == 100 || i == 300) setup.gap = GAP;
    if (i == 200) setup.gap = INFINITY;
    if (i % 100 == 0) ck_assert_int_eq(ethd_space_post(space, &setup, &error), ETHD_OK);
    tick(space, now + 1000000 * i, 0, 0);
    ck_assert_uint_eq(clock_faults(space), 0);
  }
  tick(space, now, 0, 0);
  ck_assert_uint_eq(clock_faults(space), 1);
  ethd_space_destroy(space);
}

TEST(test_begins_in_the_plane) {
  rig r;
  rig_begin(&r, RIG_WALL, NULL);
  const motion m = rig_at(0.02, 0, 0.001);
  r.sense.time_ns = 3600 * INT64_C(1000000000);
  for (int i = 0; i < 600; i++) {
    if (i == 100 || i == 300) r.setup.limits.gap = GAP;
    if (i == 200) r.setup.limits.gap = INFINITY;
    if (i % 100 == 0) rig_post(&r);
    (void)rig_step(&r, &m); /* which fails with a fault */
  }
  ethd_sense late = r.sense;
  late.time_ns += 1000000 + 6000000;
  ck_assert_int_eq(rig_try(&r, &late), ETHD_E_DEVICE);
  ck_assert_int_eq(r.trace.fault, ETHD_FAULT_CLOCK);
  rig_close(&r);
}
