/* A device as far as it is known before anybody touches it: the drivers stand in a list in which each one's open is its
   prepare. */
#include <stdbool.h>
#include <stddef.h>

#include "ethd/driver.h"

#define DRIVERS_KNOWN_MAX 32

static ethd_status open_nothing(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  (void)def, (void)device, (void)message;
  return ETHD_OK;
}

static void close_nothing(void *device) { (void)device; }

static const char *says_nothing(const void *device, uint32_t i) {
  (void)device;
  return i ? NULL : "one of its drivers says nothing of itself, and checks no setting, before it is open";
}

static bool can_prepare(const ethd_driver *d) {
  return d->size >= offsetof(ethd_driver, prepare) + sizeof d->prepare && d->prepare;
}

static ethd_driver prepared(const ethd_driver *d) {
  if (!can_prepare(d))
    return (ethd_driver){.size = sizeof(ethd_driver),
                         .abi = ETHD_DRIVER_ABI,
                         .id = d->id,
                         .brief = d->brief,
                         .open = open_nothing,
                         .close = close_nothing,
                         .remark = says_nothing};
  ethd_driver own = *d;
  own.open = d->prepare;
  return own;
}

ethd_status ethd_device_prepare(const char *ids, const ethd_device_def *def, const ethd_driver **driver, void **device,
                                char message[ETHD_MESSAGE_MAX]) {
  static ethd_driver tables[DRIVERS_KNOWN_MAX];
  static const ethd_driver *known[DRIVERS_KNOWN_MAX + 1];
  for (uint32_t i = 0; i < DRIVERS_KNOWN_MAX && ethd_drivers[i]; i++) {
    tables[i] = prepared(ethd_drivers[i]);
    known[i] = &tables[i];
  }
  return ethd_device_open(ids, known, def, driver, device, message);
}
