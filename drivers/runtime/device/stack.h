/* Several drivers as one driver, which has every function, whichever of them have it. */
#ifndef ETHD__DEVICE_STACK_H
#define ETHD__DEVICE_STACK_H

#include <stdbool.h>
#include <sys/types.h>

#include "ethd/driver.h"

/* Its device is an ethd__stack. Its open opens no driver, because ethd_device_open fills the stack. */
extern const ethd_driver ethd__driver_stack;

typedef struct ethd__stack {
  uint32_t count;
  pid_t process;      /* that opened the drivers */
  bool only_prepares; /* nothing is touched: each driver's prepare takes the place of its open */
  unsigned hang_time; /* s within which a file's code must return */
  char doing[96];     /* what a file's code does, for people */
  struct {
    const ethd_driver *driver;
    ethd_driver own; /* a table of ours: a copy of a file's, whole, or one whose open is a prepare */
    bool is_foreign; /* the driver comes from a file */
    void *device;    /* NULL: not open */
    uint32_t units;
  } at[ETHD_DRIVERS_MAX];
} ethd__stack;

/* Says that code of driver i's file runs from here on, or no longer (`doing` NULL). A program that watches over
   plugins ends when that code doesn't return. Does nothing for built-in drivers. [main] */
void ethd__stack_foreign(ethd__stack *stack, uint32_t i, const char *doing);

#endif
