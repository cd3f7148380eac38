/* Records what the configuration doesn't know: the device's limits and dynamics, and the date. [main] */
#ifndef ETHD__RECORD_LIMITS_EVENT_H
#define ETHD__RECORD_LIMITS_EVENT_H

#include "ethd/record.h"

/* Writes an event "set limits.X ..." for every limit in which `is` differs from `was`, because a replay has no device
   to ask. */
ETHD_MUST_CHECK ethd_status ethd__limits_event(ethd_recording *recording, const ethd_setup *was, const ethd_setup *is);

/* Does the same for the dynamics, "set arm.X ...", if a law that looks ahead rules or may be swapped in. */
ETHD_MUST_CHECK ethd_status ethd__dynamics_event(ethd_recording *recording, const ethd_setup *was,
                                                 const ethd_setup *is);

/* Writes the event `clock`: the date at the instant of a tick that has just come, by the monotonic clock if the
   device's instants are that clock's. */
ETHD_MUST_CHECK ethd_status ethd__clock_event(ethd_recording *recording, int64_t instant);

#endif
