/* A tap on a device without a known true state: the controller's estimates replace it. [any] */
#ifndef ETHD__APPS_TAP_SEEN_H
#define ETHD__APPS_TAP_SEEN_H

#include "ethd/sim.h"

/* Returns the state: the ring from the encoders, the finger from its filter, and the hand at the finger. The pad
   follows from these and the setup's finger radius, and counts as touching within slack, m; its force is NaN. begin_ns:
   the tap's first tick. */
ethd_truth ethd__seen(const ethd_trace *trace, const ethd_setup *setup, double slack, int64_t begin_ns);

#endif
