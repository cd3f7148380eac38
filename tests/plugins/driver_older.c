/* Compiled with the first header of this ABI: what stands behind its last field isn't its own. */
#include <ethd/driver.h>
#include <stdlib.h>
static const char *not_mine(const void *device, uint32_t i) {
  (void)device, (void)i;
  abort();
}
#define SIZE ((uint32_t)ETHD_DRIVER_MIN)
#define MORE .remark = not_mine
#include "driver_broken.h"
