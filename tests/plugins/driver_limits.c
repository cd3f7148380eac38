/* Limits that are no numbers. */
#include <ethd/driver.h>
#include <math.h>
static ethd_limits no_limits(const void *device) {
  ethd_limits limits = ethd_limits_none();
  (void)device;
  limits.speed = NAN;
  return limits;
}
#define MORE .limits = no_limits
#include "driver_broken.h"
