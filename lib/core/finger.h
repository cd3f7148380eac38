/* Age and plausibility of the finger's readings: the rows FINGER_OLD, FINGER_LOST and ESTIMATE. Both functions are
   called only if a limit of the readings' age is set. [rt] */
#ifndef ETHD__CORE_FINGER_H
#define ETHD__CORE_FINGER_H

#include "core/state.h"

/* Notes a reading that was used `age` s ago, if that is over a limit, s. Returns how far tracking has faded, 0 to 1;
   `absent`: the result of the last tick. To be called once a tick, from the first reading on. */
double ethd__finger_age(ethd__core *core, double age, const double limits[2], double absent, double dt) ETHD_RT;

/* Counts implausible readings in a row and notes them. To be called for each reading. */
void ethd__finger_doubt(ethd__core *core, int64_t *in_a_row, bool implausible) ETHD_RT;

#endif
