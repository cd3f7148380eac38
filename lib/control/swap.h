#ifndef ETHD__CONTROL_SWAP_H
#define ETHD__CONTROL_SWAP_H

#include "control/context.h"

/* The old plan's torque into trace->tau_raw, and the difference to the new plan's begins to fade. [rt] */
void ethd__swap(ethd__tick *t) ETHD_RT;

/* The state of the old plan becomes one of the new. What stays keeps its state; a new law adopts live contacts or
   starts from zero; contacts in a new scene go on where it has the same surface, as `old`, the old plan's state after
   this tick, says (NULL: not known, they end). [rt] */
void ethd__swap_state(const ethd__plan *from, const ethd__plan *to, ethd__state *state, const ethd__state *old) ETHD_RT;

/* `from` - `to`, Nm, fades from here on. [rt] */
void ethd__fade_start(ethd__state *state, const double from[2], const double to[2]) ETHD_RT;

/* Adds what is left of a fade to trace->tau_raw. [rt] */
void ethd__fade(ethd__tick *t) ETHD_RT;

#endif
