/* The contents of an ethd_device: its drivers, and the faults that a script injects. */
#ifndef ETHD__DEVICE_DEVICE_H
#define ETHD__DEVICE_DEVICE_H

#include <stdbool.h>
#include <sys/types.h>

#include "ethd/driver.h"
#include "inject/inject.h"

struct ethd_device {
  uint32_t count;
  pid_t process;        /* that opened the drivers */
  bool in_space;        /* opened for space.h, else for the plane */
  bool takes;           /* one of its drivers takes commands in space */
  bool only_prepares;   /* no device is touched: each driver's prepare replaces its open */
  unsigned hang_time;   /* s within which a file's code must return */
  char doing[96];       /* the present call of a file's code, for messages */
  ethd__inject *inject; /* NULL: nothing is injected */
  struct {
    const ethd_driver *driver;
    ethd_driver own; /* our table: a complete copy of a file's, or one whose open is a prepare */
    bool is_foreign; /* the driver comes from a file */
    void *state;     /* NULL: not open */
    uint32_t units;
  } at[ETHD_DRIVERS_MAX];
};

/* Announces that code of driver i's file runs from here on, or no longer (`doing` NULL). A program that watches plugins
   ends if that code doesn't return. Does nothing for built-in drivers. [main] */
void ethd__device_foreign(ethd_device *device, uint32_t i, const char *doing);

#endif
