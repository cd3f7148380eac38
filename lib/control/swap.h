#ifndef ETHD__CONTROL_SWAP_H
#define ETHD__CONTROL_SWAP_H

#include "control/context.h"

/* Computes the new plan's torque, and in `old`, Nm, the torque that the old plan would command; the tick's `old` points
   to it unless a law failed. [rt] */
void ethd__swap(ethd__tick *t, double old[2]) ETHD_RT;

/* Converts the state of the old plan into a state of the new one. Parts that both plans have keep their state; a new
   law adopts the contacts or starts from zero. `old` is the old plan's state after this tick, with which contacts go on
   in a new scene that has the same surface. If it is NULL, they end. [rt] */
void ethd__swap_state(const ethd__plan *from, const ethd__plan *to, ethd__state *state, const ethd__state *old) ETHD_RT;

#endif
