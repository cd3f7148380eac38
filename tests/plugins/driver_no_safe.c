/* Takes torque and can't let go. */
#include <ethd/driver.h>
static ethd_status take_torque(void *device, int64_t now_ns, const ethd_command *command) ETHD_RT {
  return (void)device, (void)now_ns, (void)command, ETHD_OK;
}
#define MORE .write = take_torque
#include "driver_broken.h"
