/* How old and how plausible the finger's readings are: the rows FINGER_OLD, FINGER_LOST and ESTIMATE. */
#include "control/control.h"

#define FADE 0.020        /* s in which tracking fades out and in */
#define IMPLAUSIBLE_MAX 5 /* in a row */

/* The age counts from the sample's instant: a reading's latency is part of it. */
void ethd__finger_watch(const ethd__plan *plan, ethd__state *state, const ethd_sense *sense, double dt) {
  const ethd_limits *limits = &plan->setup.limits;
  if (state->filter.used == 0) return; /* none was ever there */
  double age = 1e-9 * ((double)((uint64_t)sense->time_ns - (uint64_t)state->reading_ns) - 0.5);
  int old = !(age <= limits->finger_age);
  if (old) state->met.faults |= ETHD_FAULT_BIT(ETHD_FAULT_FINGER_OLD);
  if (!(age <= limits->finger_lost)) state->met.faults |= ETHD_FAULT_BIT(ETHD_FAULT_FINGER_LOST);
  state->absent = old ? fmin(state->absent + dt / FADE, 1) : fmax(state->absent - dt / FADE, 0);
}

void ethd__finger_doubt(ethd__state *state, int implausible) {
  state->implausible = implausible ? state->implausible + 1 : 0;
  if (!implausible) return;
  ethd__rows *met = &state->met;
  *(state->implausible < IMPLAUSIBLE_MAX ? &met->faults : &met->grave) |= ETHD_FAULT_BIT(ETHD_FAULT_ESTIMATE);
}
