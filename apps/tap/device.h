/* Reads the simulated device from a configuration's section [device]. */
#ifndef ETHD__APPS_TAP_DEVICE_H
#define ETHD__APPS_TAP_DEVICE_H

#include "ethd/config.h"
#include "sim/settings.h"

/* Refuses a driver other than sim, and unknown keys. */
ETHD_MUST_CHECK ethd_status ethd__device_read(const ethd_config *config, ethd__sim_settings *out,
                                              char message[ETHD_MESSAGE_MAX]);

#endif
