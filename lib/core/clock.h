/* The device's clock: row CLOCK. */
#ifndef ETHD__CORE_CLOCK_H
#define ETHD__CORE_CLOCK_H

#include "core/state.h"

/* Notes a clock that jumps, stands still or has another rate than the loop, and a step that comes later than `gap` s
   after the last; gap = INFINITY: no check. now: the stamp of this tick's sample, ns; periods: of `period` s since the
   last tick. [rt] */
void ethd__clock_check(ethd__core *core, int64_t now, int64_t periods, double period, double gap) ETHD_RT;

#endif
