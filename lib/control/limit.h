#ifndef ETHD__CONTROL_LIMIT_H
#define ETHD__CONTROL_LIMIT_H

#include "control/context.h"

/* Makes the commanded torque, trace->tau, from the laws' torque, trace->tau_raw, and sets trace->guard. [rt] */
void ethd__limit(ethd__tick *t) ETHD_RT;

#endif
