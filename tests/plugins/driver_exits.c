/* Ends the program when it is opened, as if all were done. */
#include <ethd/driver.h>
#include <stdlib.h>
static ethd_status leave(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  (void)def, (void)device, (void)message;
  exit(0);
}
#define OPEN leave
#include "driver_broken.h"
