/* Changes the numbers of a sample as a broken sensor would. */
#ifndef ETHD__INJECT_VALUES_H
#define ETHD__INJECT_VALUES_H

#include "inject/script.h"

/* Applies one injection to *sense at t, ns since the first sample, if it is due and concerns a number. `joints` says
   whether the sample has new joint numbers. Returns true if something was changed. [rt] */
bool ethd__inject_values(ethd__injection *injection, int64_t t, bool joints, ethd_sense *sense) ETHD_RT;

#endif
