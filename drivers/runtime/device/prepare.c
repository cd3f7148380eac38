/* Makes a driver that gives its information without touching its device: its prepare replaces its open. */
#include <stddef.h>

#include "device/driver_file.h"

static ethd_status open_nothing(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  (void)def, (void)device, (void)message;
  return ETHD_OK;
}

static void close_nothing(void *device) { (void)device; }

static const char *says_nothing(const void *device, uint32_t i) {
  (void)device;
  return i ? NULL : "one of its drivers gives no information and checks no setting before it is open";
}

ethd_driver ethd__driver_prepared(const ethd_driver *driver) {
  ethd_driver out = ethd__driver_whole(driver);
  if (!out.prepare)
    return (ethd_driver){.size = sizeof(ethd_driver),
                         .abi = ETHD_DRIVER_ABI,
                         .id = driver->id,
                         .brief = driver->brief,
                         .open = open_nothing,
                         .close = close_nothing,
                         .remark = says_nothing};
  out.open = out.prepare;
  return out;
}
