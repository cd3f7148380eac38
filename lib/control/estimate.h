#ifndef ETHD__CONTROL_ESTIMATE_H
#define ETHD__CONTROL_ESTIMATE_H

#include "control/context.h"

/* Works out from the sense where ring and finger are: joint speeds, pose, ring, finger. [rt] */
void ethd__estimate(ethd__tick *t) ETHD_RT;

#endif
