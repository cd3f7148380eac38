#ifndef ETHD__CONTROL_LIMIT_H
#define ETHD__CONTROL_LIMIT_H

#include "control/context.h"

/* Ends what fades. [rt] */
static inline void ethd__fade_end(ethd__state *state) ETHD_RT {
  state->soft = state->fade.elapsed = (double)INFINITY;
  state->fades = false;
}

/* Limits the laws' torque, trace->tau_raw, to what is commanded, trace->tau, and sets trace->guard. [rt] */
void ethd__limit(ethd__tick *t) ETHD_RT;

#endif
