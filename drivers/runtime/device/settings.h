/* For drivers that check more of their settings than their tables can say. */
#ifndef ETHD__DEVICE_SETTINGS_H
#define ETHD__DEVICE_SETTINGS_H

#include "ethd/driver.h"
#include "text/key.h"

/* A setting as a key of [device]. */
ethd__key ethd__setting_key(const ethd_device_def *def, const ethd_setting *s, char message[ETHD_MESSAGE_MAX]);

#endif
