/* Records data that the configuration lacks: the device's limits and dynamics, and the date. [main] */
#ifndef ETHD__RECORD_LIMITS_EVENT_H
#define ETHD__RECORD_LIMITS_EVENT_H

#include "ethd/record.h"
#include "settings/front.h"

/* Writes an event "set SECTION.KEY ..." for every number of this section of a setup (front.h) in which `is` differs
   from `was` and is known, because a replay has no device. */
ETHD_MUST_CHECK ethd_status ethd__section_events(ethd_recording *recording, const ethd__config_front *front,
                                                 const char *section, const void *was, const void *is);

/* Writes the event `clock`: the date at the instant of the newest tick, by the monotonic clock if the device's instants
   are of that clock. */
ETHD_MUST_CHECK ethd_status ethd__clock_event(ethd_recording *recording, int64_t instant);

#endif
