#include "core/finger.h"

#include "core/rows.h"

/* s: duration of tracking's fade, the default of a swap's (transition.swap_time). */
#define FADE 0.020

/* Implausible readings in a row that stop the device: the number that restarts the filter (ETHD_FILTER_GATED_MAX). At
   the proximity ring's 300 Hz they take 17 ms. */
#define IMPLAUSIBLE_MAX 5

double ethd__finger_age(ethd__core *core, double age, const double limits[2], double absent, double dt) {
  bool old = !(age <= limits[0]);
  if (old) ethd__note(core, ETHD_FAULT_FINGER_OLD);
  if (!(age <= limits[1])) ethd__note(core, ETHD_FAULT_FINGER_LOST);
  return old ? fmin(absent + dt / FADE, 1) : fmax(absent - dt / FADE, 0);
}

void ethd__finger_doubt(ethd__core *core, int64_t *in_a_row, bool implausible) {
  *in_a_row = implausible ? *in_a_row + 1 : 0;
  if (!implausible) return;
  if (*in_a_row < IMPLAUSIBLE_MAX)
    ethd__note(core, ETHD_FAULT_ESTIMATE);
  else
    ethd__note_grave(core, ETHD_FAULT_ESTIMATE);
}
