/* I2t: a motor's winding is modelled as a body of one temperature. Its rise over the surroundings is h, as a share of
   the rise that the nominal torque leads to:

        h' = ((tau / nominal)^2 - h) / heat_time        solved exactly for a torque that is held

   The motor's torque is unbounded up to h = FOLD. Above FOLD the bound falls and reaches the nominal torque at h = 1,
   where h no longer rises. */
#include "fp_mode.h"
#include "guard/parts.h"

#define FOLD 0.9     /* the last tenth of the heat is where the torque folds back */
#define LOAD_MAX 1e3 /* times the nominal torque: no motor survives more, and the model's heat stays finite */

ETHD__FP_APART static double heat(const ethd_limits *limits, ethd_guard_state *s, double dt) {
  double share = 1 - ethd_exp(-dt / limits->heat_time);
  for (int i = 0; i < 2; i++) {
    double load = fmin(fabs(s->last[i]) / limits->nominal_torque, LOAD_MAX);
    s->heat[i] += share * (load * load - s->heat[i]);
  }
  return fmax(s->heat[0], s->heat[1]);
}

double ethd_guard_heat(const ethd_limits *limits, ethd_guard_state *s, double dt) {
  ETHD__FP_RETURN(double, heat(limits, s, dt));
}

double ethd__guard_cool(const ethd_limits *limits, double heat) {
  return heat > FOLD ? limits->nominal_torque * ((1 - FOLD) / (heat - FOLD)) : (double)INFINITY;
}
