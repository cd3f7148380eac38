/* Its start never returns. */
#include <ethd/driver.h>
static ethd_status hang(void *device) {
  (void)device;
  for (volatile int on = 1; on;) continue;
  return ETHD_OK;
}
#define MORE .start = hang
#include "driver_broken.h"
