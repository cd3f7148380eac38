#ifndef ETHD__CONTROL_EVALUATE_H
#define ETHD__CONTROL_EVALUATE_H

#include "control/context.h"

/* Computes the torque of the laws, trace->tau_raw, from estimates, contacts and tracking. Returns false if a law
   failed, which is noted. [rt] */
bool ethd__evaluate(ethd__tick *t) ETHD_RT;

#endif
