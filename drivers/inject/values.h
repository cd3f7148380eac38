/* Numbers of a sample, as a broken sensor gives them. */
#ifndef ETHD_INJECT_VALUES_H
#define ETHD_INJECT_VALUES_H

#include "inject/script.h"

/* Does one injection to *sense at t, ns since the first sample, if it is of a number and due; joints false: the
   sample has no new joint numbers. True if something was changed. [rt] */
bool ethd__inject_values(ethd__injection *injection, int64_t t, bool joints, ethd_sense *sense) ETHD_RT;

#endif
