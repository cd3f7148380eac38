/* From the laws' torque to the commanded one: the guard, and between its two halves the fades.

     tau_raw -> guard's stop, wall and limits -> g -> soft g + left delta -> guard's rate, and its limits again -> tau

   soft    after an acknowledged fault rises from 0 to 1 over swap_time, so the torque rises from zero whatever the laws
           ask for meanwhile
   left    from a swap on falls from 1 to 0 over swap_time
   delta   old - soft g at the tick of the swap, where `old` is the torque that the old plan would have commanded under
           its own limits: so the swap doesn't jump, whatever it changes
   A stop isn't faded. */
#include "control/limit.h"

#include "guard/parts.h"

/* Returns the share of swap_time that has passed, 1 at its end. Periods add up to swap_time only within rounding. */
static double passed(double elapsed, double swap_time) {
  return elapsed < swap_time * (1 - 1e-9) ? elapsed / swap_time : 1;
}

/* Advances both fades by this tick and returns whether there is one. */
static bool advance(ethd__tick *t) {
  ethd__state *state = t->state;
  if (!state->fades && !t->soft && !t->old) return false;
  if (t->soft) state->soft = -t->dt;
  if (t->old) state->fade.elapsed = -t->dt;
  state->fades = true;
  state->soft += t->dt;
  state->fade.elapsed += t->dt;
  return true;
}

static void fade(ethd__tick *t, double torque[2], ethd__guard_faded *faded) {
  ethd__state *state = t->state;
  const double swap_time = t->plan->setup.swap_time;
  const double soft = t->soft ? 0 : passed(state->soft, swap_time);
  faded->share = t->old ? 1 : 1 - passed(state->fade.elapsed, swap_time);
  for (int i = 0; i < 2; i++) {
    const double g = soft * torque[i];
    if (t->old) state->fade.delta[i] = t->old[i] - g;
    if (t->old) state->fade.from[i] = fabs(t->old[i]);
    torque[i] = t->old ? t->old[i] : faded->share > 0 ? g + faded->share * state->fade.delta[i] : g;
    faded->from[i] = state->fade.from[i];
  }
  if (soft == 1) state->soft = (double)INFINITY;
  if (faded->share == 0) state->fade.elapsed = (double)INFINITY;
  state->fades = soft < 1 || faded->share > 0;
}

void ethd__limit(ethd__tick *t) {
  const ethd__plan *plan = t->plan;
  ethd_guard_state *guard = &t->state->guard;
  double *torque = t->trace->tau;
  const ethd_guard_motion motion = {.pose = &t->pose,
                                    .v = t->ring.v,
                                    .qd = {t->trace->qd[0], t->trace->qd[1]},
                                    .estimated = !(t->sense->have & ETHD_HAVE_DQ),
                                    .dt = t->dt};
  ethd__guard_faded faded;
  if (t->soft) memset(guard->last, 0, sizeof guard->last); /* from zero, also where a stop still braked */
  memcpy(torque, t->trace->tau_raw, sizeof t->trace->tau);
  int32_t bits = ethd__guard_limit(&plan->setup.limits, &plan->device, guard, &motion, torque);
  const bool fades = advance(t), stops = ethd__guard_stops(guard, bits) || bits & ETHD_GUARD_FINITE;
  if (fades && stops) ethd__fade_end(t->state);
  if (fades && !stops) fade(t, torque, &faded);
  t->trace->guard =
      ethd__guard_finish(&plan->setup.limits, guard, fades && !stops ? &faded : NULL, t->dt, bits, torque);
}
