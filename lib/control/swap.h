#ifndef ETHD__CONTROL_SWAP_H
#define ETHD__CONTROL_SWAP_H

#include "control/context.h"

/* Writes the old plan's torque to trace->tau_raw, and begins to fade its difference to the new plan's. [rt] */
void ethd__swap(ethd__tick *t) ETHD_RT;

/* Turns the state of the old plan into one of the new. What both plans have keeps its state; a new law adopts live
   contacts or starts from zero. `old` is the old plan's state after this tick: by it contacts go on in a new scene that
   has the same surface. If it is NULL, they end. [rt] */
void ethd__swap_state(const ethd__plan *from, const ethd__plan *to, ethd__state *state, const ethd__state *old) ETHD_RT;

/* Sets the tick's torque in trace->tau_raw to `from`, Nm; the difference fades from here on. [rt] */
void ethd__fade_start(ethd__tick *t, const double from[2]) ETHD_RT;

/* Adds what is left of a fade to trace->tau_raw. [rt] */
void ethd__fade(ethd__tick *t) ETHD_RT;

#endif
