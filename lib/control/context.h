/* The context of one tick, which all its stages share. It starts with the device's measurements, each stage adds its
   results, and the trace shows them all. */
#ifndef ETHD__CONTROL_CONTEXT_H
#define ETHD__CONTROL_CONTEXT_H

#include "control/state.h"
#include "core/tick.h"

typedef struct ethd__motion {
  ethd_vec x, v; /* m, m/s, in R_0 */
} ethd__motion;

typedef struct ethd__tick {
  /* inputs */
  const ethd__plan *plan; /* the plan in force */
  const ethd__plan *from; /* the plan replaced at this tick, NULL: none */
  ethd__state *state;
  ethd__state *scratch; /* a copy of the state for the old plan's run; needed if `from` is set */
  const ethd_sense *sense;
  bool soft;         /* a fault was acknowledged: the torque starts from zero */
  const double *old; /* Nm: at a swap, the old plan's torque; NULL: no fade begins */
  /* results */
  int64_t periods; /* since the last tick, missed ones included */
  double dt;       /* s since the last tick that had a measurement */
  ethd_pose pose;  /* of the arm; unknown at a tick without measurement, which doesn't need it */
  ethd__motion ring, finger;
  ethd__core_tick core; /* the core's view of the tick, and the results of the contacts */
  ethd_trace *trace;
} ethd__tick;

#endif
