#include "core/fade.h"

/* Returns the share of swap_time that has passed, 1 at its end. Periods add up to swap_time only within rounding. */
static double passed(double elapsed, double swap_time) {
  return elapsed < swap_time * (1 - 1e-9) ? elapsed / swap_time : 1;
}

double ethd__fade_apply(ethd__fade *fade, const ethd__fade_start *start, int count, double *command) {
  const double *old = start->old;
  const double soft = start->soft ? 0 : passed(fade->soft, start->swap_time);
  const double share = old ? 1 : 1 - passed(fade->elapsed, start->swap_time);
  for (int i = 0; i < count; i++) {
    const double g = soft * command[i];
    if (old) fade->delta[i] = old[i] - g;
    if (old) fade->from[i] = fabs(old[i]);
    command[i] = old ? old[i] : share > 0 ? g + share * fade->delta[i] : g;
  }
  if (soft == 1) fade->soft = (double)INFINITY;
  if (share == 0) fade->elapsed = (double)INFINITY;
  fade->active = soft < 1 || share > 0;
  return share;
}
