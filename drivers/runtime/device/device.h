/* What stands behind an ethd_device: its drivers, and the faults that a script injects. */
#ifndef ETHD__DEVICE_DEVICE_H
#define ETHD__DEVICE_DEVICE_H

#include <stdbool.h>
#include <sys/types.h>

#include "ethd/driver.h"
#include "inject/inject.h"

struct ethd_device {
  uint32_t count;
  pid_t process;        /* that opened the drivers */
  bool in_space;        /* it has the front of space.h, else the plane's */
  bool takes;           /* one of its drivers takes commands in space */
  bool only_prepares;   /* nothing is touched: each driver's prepare takes the place of its open */
  unsigned hang_time;   /* s within which a file's code must return */
  char doing[96];       /* what a file's code does, for people */
  ethd__inject *inject; /* NULL: nothing is injected */
  struct {
    const ethd_driver *driver;
    ethd_driver own; /* a table of ours: a copy of a file's, whole, or one whose open is a prepare */
    bool is_foreign; /* the driver comes from a file */
    void *state;     /* NULL: not open */
    uint32_t units;
  } at[ETHD_DRIVERS_MAX];
};

/* Says that code of driver i's file runs from here on, or no longer (`doing` NULL). A program that watches over
   plugins ends when that code doesn't return. Does nothing for built-in drivers. [main] */
void ethd__device_foreign(ethd_device *device, uint32_t i, const char *doing);

#endif
