/* Drivers in a row as one driver, which has all functions, whatever one or several have. */
#ifndef ETHD_DEVICE_STACK_H
#define ETHD_DEVICE_STACK_H

#include "ethd/driver.h"

/* Its device is an ethd__stack; its open opens no driver: ethd_device_open fills the stack. */
extern const ethd_driver ethd__driver_stack;

typedef struct ethd__stack {
  uint32_t count;
  struct {
    const ethd_driver *driver;
    void *device; /* NULL: not open */
  } at[ETHD_DRIVERS_MAX];
} ethd__stack;

#endif
