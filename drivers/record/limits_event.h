/* What a recording's configuration doesn't know: the device's limits and dynamics. [main] */
#ifndef ETHD_COMMON_LIMITS_EVENT_H
#define ETHD_COMMON_LIMITS_EVENT_H

#include "ethd/record.h"

/* An event "set limits.X ..." or "set arm.X ..." for every limit and, where the law looks ahead, for what moves the
   ring, in which `is` differs from `was`: a replay has no device. */
ETHD_MUST_CHECK ethd_status ethd__device_event(ethd_recording *recording, const ethd_setup *was, const ethd_setup *is);

#endif
