/* Between drivers that look at their settings further than their tables can say. */
#ifndef ETHD__DEVICE_SETTINGS_H
#define ETHD__DEVICE_SETTINGS_H

#include "ethd/driver.h"

/* "file:line: device.key: found X, `allowed` is allowed", of a key that the configuration has. [main] */
ETHD_MUST_CHECK ethd_status ethd__setting_refuse(const ethd_device_def *def, const char *key, const char *allowed,
                                                 char message[ETHD_MESSAGE_MAX]);

#endif
