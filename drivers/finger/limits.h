/* Limits of the age of a finger's readings. They depend on the rate, so each sensor has its own. */
#ifndef ETHD__FINGER_LIMITS_H
#define ETHD__FINGER_LIMITS_H

#include "ethd/guard.h"

/* After three missing readings tracking fades, after nine the ring is stopped; an age counts from the sample's instant,
   so it includes the latency. rate: Hz; latency: s. [any] */
static inline void ethd__finger_limits(double rate, double latency, ethd_limits *out) {
  out->finger_age = latency + 3 / rate;
  out->finger_lost = latency + 9 / rate;
}

#endif
