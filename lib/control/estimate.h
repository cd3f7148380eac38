#ifndef ETHD__CONTROL_ESTIMATE_H
#define ETHD__CONTROL_ESTIMATE_H

#include "control/context.h"

/* Estimates joint speeds, pose, ring and finger from the sense. [rt] */
void ethd__estimate(ethd__tick *t) ETHD_RT;

#endif
