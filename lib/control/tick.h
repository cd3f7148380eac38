#ifndef ETHD__CONTROL_TICK_H
#define ETHD__CONTROL_TICK_H

#include "control/context.h"

/* A whole tick: changes the state, fills the trace. [rt] */
void ethd__tick_run(ethd__tick *t) ETHD_RT;

/* Forgets contacts, fade and fault; the estimators stay. [rt] */
void ethd__resume(const ethd__plan *plan, ethd__state *state) ETHD_RT;

#endif
