/* A tick in the making: the one context that every stage works on. It starts with what the device measured, each
   stage adds what it worked out, and the trace shows it all. */
#ifndef ETHD__CONTROL_CONTEXT_H
#define ETHD__CONTROL_CONTEXT_H

#include "control/state.h"

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
  double near;    /* m: contacts with d_re below this count: d_beta, or as far as the law looks ahead */
  ethd_vec shift; /* m: of the tracking's reference, from the contact with the smallest beta */
  ethd_trace *trace;
} ethd__tick;

#endif
