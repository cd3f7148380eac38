/* Opens, and then never says what its limits are. */
#include <ethd/driver.h>
static ethd_limits hang_in_limits(const void *device) {
  (void)device;
  for (volatile int on = 1; on;) continue;
  return (ethd_limits){.torque = 1};
}
#define MORE .limits = hang_in_limits
#include "driver_broken.h"
