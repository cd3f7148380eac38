/* How old and how plausible the finger's readings are: the rows FINGER_OLD, FINGER_LOST and ESTIMATE. */
#include "control/finger_watch.h"

#include "core/rows.h"

/* s in which tracking fades out or in, as long as a swap takes by default (transition.swap_time). */
#define FADE 0.020

/* Implausible readings in a row that stop the device: as many as make the filter start anew (ETHD_FILTER_GATED_MAX).
   The proximity ring, at 300 Hz, takes 17 ms for them. */
#define IMPLAUSIBLE_MAX 5

/* The age counts from the sample's instant, so it includes the reading's latency. The half nanosecond makes a reading
   that is exactly as old as the limit count as young enough. */
void ethd__finger_watch(const ethd__tick *t) {
  const ethd_limits *limits = &t->plan->setup.limits;
  ethd__state *state = t->state;
  if (state->filter.used == 0) return; /* no finger was seen yet, so none can be lost */
  double age = 1e-9 * ((double)((uint64_t)t->sense->time_ns - (uint64_t)state->reading_ns) - 0.5);
  bool old = !(age <= limits->finger_age);
  if (old) ethd__note(&state->core, ETHD_FAULT_FINGER_OLD);
  if (!(age <= limits->finger_lost)) ethd__note(&state->core, ETHD_FAULT_FINGER_LOST);
  state->absent = old ? fmin(state->absent + t->dt / FADE, 1) : fmax(state->absent - t->dt / FADE, 0);
}

void ethd__finger_doubt(ethd__state *state, bool implausible) {
  state->implausible = implausible ? state->implausible + 1 : 0;
  if (!implausible) return;
  if (state->implausible < IMPLAUSIBLE_MAX)
    ethd__note(&state->core, ETHD_FAULT_ESTIMATE);
  else
    ethd__note_grave(&state->core, ETHD_FAULT_ESTIMATE);
}
