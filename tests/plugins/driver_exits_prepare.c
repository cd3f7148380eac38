/* Ends the program when it is asked what it knows before it is opened. */
#include <ethd/driver.h>
#include <stdlib.h>
static ethd_status leave(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  (void)def, (void)device, (void)message;
  exit(0);
}
#define MORE .prepare = leave
#include "driver_broken.h"
