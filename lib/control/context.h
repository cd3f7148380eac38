/* A tick in the making: the one context that every stage works on. It starts with what the device measured, each
   stage adds what it worked out, and the trace shows it all. */
#ifndef ETHD__CONTROL_CONTEXT_H
#define ETHD__CONTROL_CONTEXT_H

#include "control/state.h"
#include "core/tick.h"

typedef struct ethd__motion {
  ethd_vec x, v; /* m, m/s, in R_0 */
} ethd__motion;

typedef struct ethd__tick {
  /* what it starts from */
  const ethd__plan *plan; /* the one that rules */
  const ethd__plan *from; /* the one that was replaced at this tick, NULL: none */
  ethd__state *state;
  ethd__state *scratch; /* a copy of the state for the old plan's run; needed where `from` is set */
  const ethd_sense *sense;
  bool soft;         /* a fault was acknowledged: the torque starts from zero */
  const double *old; /* Nm: at a swap, what the old plan would have commanded; NULL: nothing to fade from */
  /* what it works out */
  int64_t periods; /* since the last tick, missed ones included */
  double dt;       /* s since the last tick that had a measurement */
  ethd_pose pose;  /* of the arm; unknown on a tick without measurement, where nothing needs it */
  ethd__motion ring, finger;
  ethd__core_tick core; /* the same, as the core sees it, and what the contacts lead to */
  ethd_trace *trace;
} ethd__tick;

#endif
