#ifndef ETHD__CONTROL_LIMIT_H
#define ETHD__CONTROL_LIMIT_H

#include "control/context.h"

/* Limits the laws' torque, trace->tau_raw, to what is commanded, trace->tau, and sets trace->guard. [rt] */
void ethd__limit(ethd__tick *t) ETHD_RT;

#endif
