/* Limits that a recording's configuration doesn't know: the device's. [main] */
#ifndef ETHD_COMMON_LIMITS_EVENT_H
#define ETHD_COMMON_LIMITS_EVENT_H

#include "ethd/record.h"

/* An event "set limits.X ..." for every row in which `is` differs from `was`: a replay has no device. */
ETHD_MUST_CHECK ethd_status ethd__limits_event(ethd_recording *recording, const ethd_limits *was,
                                               const ethd_limits *is);

#endif
