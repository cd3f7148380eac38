/* What a configuration's [device] section says of the simulated device. */
#ifndef ETHD_TAP_DEVICE_H
#define ETHD_TAP_DEVICE_H

#include "ethd/config.h"

typedef struct ethd__device {
  const char *plant; /* as the section names it, NULL: it doesn't */
  int rays;          /* -1: as the plant says */
} ethd__device;

/* Refuses another driver than sim, and keys that it doesn't know. */
ETHD_MUST_CHECK ethd_status ethd__device_read(const ethd_config *config, ethd__device *out,
                                              char message[ETHD_MESSAGE_MAX]);

#endif
