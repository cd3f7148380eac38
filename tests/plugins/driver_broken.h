/* What the broken drivers share: a driver that does nothing, whose table a file may spoil. */
#ifndef ETHD_TESTS_DRIVER_BROKEN_H
#define ETHD_TESTS_DRIVER_BROKEN_H

#include <ethd/control.h>
#include <ethd/driver.h>
#include <stdlib.h>

/* For open and prepare. */
static inline ethd_status hang(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  (void)def, (void)device, (void)message;
  for (volatile int on = 1; on;) continue;
  return ETHD_OK;
}
static inline ethd_status leave(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  (void)def, (void)device, (void)message;
  exit(0);
}

#ifndef SIZE
#define SIZE ((uint32_t)sizeof(ethd_driver))
#endif
#ifndef ABI
#define ABI ETHD_DRIVER_ABI
#endif
#ifndef OPEN
static ethd_status open_broken(const ethd_device_def *def, void **device, char message[ETHD_MESSAGE_MAX]) {
  (void)def, (void)message;
  *device = calloc(1, 8);
  return *device ? ETHD_OK : ETHD_E_MEMORY;
}
#define OPEN open_broken
#endif
#ifndef MORE
#define MORE
#endif
#ifndef TABLE
#define TABLE ethd_driver_plugin
#endif
ETHD_API extern const ethd_driver TABLE;
const ethd_driver TABLE = {
    .size = SIZE, .abi = ABI, .id = "broken", .brief = "does nothing", .open = OPEN, .close = free, MORE};

#endif
