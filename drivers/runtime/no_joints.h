/* For drivers that stand beside one that moves the ring. */
#ifndef ETHD__NO_JOINTS_H
#define ETHD__NO_JOINTS_H

#include <stdint.h>

/* The `joints` of a driver that measures none. [any] */
static inline uint32_t ethd__no_joints(const void *device) {
  (void)device;
  return 0;
}

#endif
