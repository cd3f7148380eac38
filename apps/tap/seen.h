/* A tap on a device that nobody sees into: what the controller knew stands for the truth. [any] */
#ifndef ETHD__TAP_SEEN_H
#define ETHD__TAP_SEEN_H

#include "ethd/sim.h"

/* The ring as the encoders have it, the finger as its filter has it, hand and finger alike; the pad from
   both and the setup's finger radius, within slack, m, of which it counts as touching; its force is NaN.
   begin_ns: the tap's first tick. */
ethd_truth ethd__seen(const ethd_trace *trace, const ethd_setup *setup, double slack, int64_t begin_ns);

#endif
