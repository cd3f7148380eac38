/* Makes the commanded torque from the laws': the guard, with the fades between its two halves (core/fade.h):

     tau_raw -> guard's stop, wall and limits -> fades -> guard's rate, and its limits again -> tau */
#include "control/limit.h"

#include "core/fade.h"
#include "guard/parts.h"

void ethd__limit(ethd__tick *t) {
  const ethd__plan *plan = t->plan;
  ethd_guard_state *guard = &t->state->guard;
  ethd__fade *fade = &t->state->core.fade;
  double *torque = t->trace->tau;
  const ethd_guard_motion motion = {.pose = &t->pose,
                                    .v = t->ring.v,
                                    .qd = {t->trace->qd[0], t->trace->qd[1]},
                                    .estimated = !(t->sense->have & ETHD_HAVE_DQ),
                                    .dt = t->dt};
  ethd__guard_faded faded;
  if (t->soft) memset(guard->last, 0, sizeof guard->last); /* from zero, even if a stop was still braking */
  memcpy(torque, t->trace->tau_raw, sizeof t->trace->tau);
  int32_t bits = ethd__guard_limit(&plan->setup.limits, &plan->device, guard, &motion, torque);
  const bool stops = ethd__guard_stops(guard, bits) || bits & ETHD_GUARD_FINITE;
  bool fades = ethd__fade_advance(fade, t->dt, t->soft, t->old);
  if (fades && stops) {
    ethd__fade_end(fade);
    fades = false;
  } else if (fades) {
    const ethd__fade_start start = {t->soft, t->old, plan->setup.swap_time};
    faded.share = ethd__fade_apply(fade, &start, 2, torque);
    memcpy(faded.from, fade->from, sizeof faded.from);
  }
  t->trace->guard = ethd__guard_finish(&plan->setup.limits, guard, fades ? &faded : NULL, t->dt, bits, torque);
}
