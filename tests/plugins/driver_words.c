/* Its message has two lines and no end. */
#include <ethd/driver.h>
#include <string.h>
static ethd_status shout(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  (void)def, (void)device;
  memset(message, 0x41, ETHD_MESSAGE_MAX);
  message[3] = 10;
  return ETHD_E_DEVICE;
}
#define OPEN shout
#include "driver_broken.h"
