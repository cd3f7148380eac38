#ifndef ETHD__CONTROL_FINGER_WATCH_H
#define ETHD__CONTROL_FINGER_WATCH_H

#include "control/context.h"

/* Once a tick, where limits.finger_age is set: notes how old the last used reading is. [rt] */
void ethd__finger_watch(const ethd__tick *t) ETHD_RT;

/* A reading has come, where limits.finger_age is set; implausible ones aren't used. [rt] */
void ethd__finger_doubt(ethd__state *state, bool implausible) ETHD_RT;

#endif
