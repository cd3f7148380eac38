/* Its prepare, which a check calls without touching the device, never returns. */
#include <ethd/driver.h>
static ethd_status hang(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  (void)def, (void)device, (void)message;
  for (volatile int on = 1; on;) continue;
  return ETHD_OK;
}
#define MORE .prepare = hang
#include "driver_broken.h"
