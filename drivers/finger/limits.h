/* How old readings of a finger may get. That depends on their rate, so no single number holds for all sensors. */
#ifndef ETHD__FINGER_LIMITS_H
#define ETHD__FINGER_LIMITS_H

#include "ethd/guard.h"

/* Three readings that don't come fade the tracking, nine stop the ring; an age counts from the sample's instant, so the
   latency is part of it. rate: Hz; latency: s. [any] */
static inline void ethd__finger_limits(double rate, double latency, ethd_limits *out) {
  out->finger_age = latency + 3 / rate;
  out->finger_lost = latency + 9 / rate;
}

#endif
