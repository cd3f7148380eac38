/* A device around a driver's table that nobody opens: a test's own, or one that is open already. */
#ifndef ETHD_TESTS_DEVICE_OF_H
#define ETHD_TESTS_DEVICE_OF_H

#include <unistd.h>

#include "device/device.h"

static inline void device_of(ethd_device *out, const ethd_driver *driver, void *state) {
  *out = (ethd_device){.count = 1, .process = getpid()};
  out->at[0].driver = driver;
  out->at[0].state = state;
  out->at[0].units = driver->units ? driver->units(state) : 0;
}

#endif
