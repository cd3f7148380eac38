#ifndef ETHD__CONTROL_SWAP_H
#define ETHD__CONTROL_SWAP_H

#include "control/context.h"

/* Works out the new plan's torque, and in `old`, Nm, what the old plan would have commanded; the tick's `old` is set to
   it unless a law failed. [rt] */
void ethd__swap(ethd__tick *t, double old[2]) ETHD_RT;

/* Turns the state of the old plan into one of the new. What both plans have keeps its state; a new law adopts live
   contacts or starts from zero. `old` is the old plan's state after this tick: by it contacts go on in a new scene that
   has the same surface. If it is NULL, they end. [rt] */
void ethd__swap_state(const ethd__plan *from, const ethd__plan *to, ethd__state *state, const ethd__state *old) ETHD_RT;

#endif
