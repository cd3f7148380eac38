#ifndef ETHD__CONTROL_FINGER_WATCH_H
#define ETHD__CONTROL_FINGER_WATCH_H

#include "control/context.h"

/* Notes when the last used reading is too old, and fades tracking. To be called once a tick where limits.finger_age is
   set. [rt] */
void ethd__finger_watch(const ethd__tick *t) ETHD_RT;

/* Counts implausible readings in a row and notes them. To be called for each reading where limits.finger_age is set.
   [rt] */
void ethd__finger_doubt(ethd__state *state, bool implausible) ETHD_RT;

#endif
