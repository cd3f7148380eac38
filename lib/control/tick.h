#ifndef ETHD__CONTROL_TICK_H
#define ETHD__CONTROL_TICK_H

#include "control/context.h"

/* Runs a whole tick: changes the state and fills the trace. [rt] */
void ethd__tick_run(ethd__tick *t) ETHD_RT;

/* Clears an acknowledged fault, and with it the fade, the contacts and the tracking law's state, which begin anew; the
   estimators keep their state. [rt] */
void ethd__resume(const ethd__plan *plan, ethd__state *state) ETHD_RT;

#endif
