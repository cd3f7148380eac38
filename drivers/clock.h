/* The clock that loop, I/O threads and drivers share when time isn't virtual. */
#ifndef ETHD__CLOCK_H
#define ETHD__CLOCK_H

#include <stdint.h>
#include <time.h>

/* Returns CLOCK_MONOTONIC's time, ns. [any, rt-safe] */
static inline int64_t ethd__clock_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

#endif
