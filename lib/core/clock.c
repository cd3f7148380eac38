#include "core/clock.h"

#include "core/rows.h"

#define WINDOW 0.2 /* s */

static double since(int64_t now, int64_t then) { return 1e-9 * (double)(int64_t)((uint64_t)now - (uint64_t)then); }

/* Returns true if clocks can be compared: not at the first two checked ticks, since a bus's first sample may be older
   than the loop. */
static bool compares(ethd__core *core) {
  ethd__clock *clock = &core->clock;
  const uint64_t tick = core->counters.ticks;
  if (tick != clock->next) {
    clock->begun = tick;
    clock->waits = 0;
  }
  clock->next = tick + 1;
  return tick - clock->begun >= 2;
}

/* Returns true unless the clock's step between two samples differs from the loop's time by more than a gap. The time of
   a repeated sample counts with the next new one. */
static bool steps_well(ethd__clock *clock, int64_t now, double expected, double gap) {
  const double waited = expected + clock->waits, passed = since(now, clock->now_ns);
  clock->waits = passed == 0 ? waited : 0;
  clock->now_ns = now;
  return passed == 0 || fabs(passed - waited) <= gap;
}

void ethd__clock_check(ethd__core *core, int64_t now, int64_t periods, double period, double gap) {
  if (isinf(gap)) return;
  ethd__clock *clock = &core->clock;
  const double expected = (double)periods * period;
  const bool compared = compares(core), in_time = expected <= gap, steps = steps_well(clock, now, expected, gap);
  /* if a device itself reports that its feedback is old, the clock isn't at fault */
  const bool told = core->met.rows.faults & ETHD_FAULT_BIT(ETHD_FAULT_FEEDBACK_OLD);
  clock->periods += periods;
  const double window = (double)clock->periods * period;
  /* the age of a sample may change by a gap, so a clock may differ by two */
  const bool runs = told || fabs(since(now, clock->from_ns) - window) <= 2 * gap;
  if (!(compared && in_time && !told && runs && window < WINDOW)) {
    clock->from_ns = now;
    clock->periods = 0;
  }
  if (!in_time || (compared && !(steps && runs))) ethd__note_grave(core, ETHD_FAULT_CLOCK);
}
