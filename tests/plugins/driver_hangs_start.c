/* Its start never returns. */
#include <ethd/driver.h>
static ethd_status hang_in_start(void *device) {
  (void)device;
  for (volatile int on = 1; on;) continue;
  return ETHD_OK;
}
#define MORE .start = hang_in_start
#include "driver_broken.h"
