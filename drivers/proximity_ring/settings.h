/* Reads the ring's keys of [device]. */
#ifndef ETHD__PROXIMITY_RING_SETTINGS_H
#define ETHD__PROXIMITY_RING_SETTINGS_H

#include "ethd/driver.h"

enum {
  ETHD__RING_BAUD,
  ETHD__RING_DELAY,
  ETHD__RING_GATE,
  ETHD__RING_SPEED,
  ETHD__RING_SLACK,
  ETHD__RING_PATIENCE,
  ETHD__RING_EMPTY,
  ETHD__RING_PARAMS
};

extern const ethd_param ethd__ring_params[ETHD__RING_PARAMS];
extern const char *const ethd__ring_keys[]; /* ends with NULL */

typedef struct ethd__ring_settings {
  const ethd_setting *port, *calibration; /* calibration NULL: level none */
  double p[ETHD__RING_PARAMS];
} ethd__ring_settings;

ETHD_MUST_CHECK ethd_status ethd__ring_settings_read(const ethd_device_def *def, ethd__ring_settings *out,
                                                     char message[ETHD_MESSAGE_MAX]);

#endif
