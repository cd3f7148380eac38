/* The clock that loop, I/O threads and drivers share where time isn't virtual. */
#ifndef ETHD_CLOCK_H
#define ETHD_CLOCK_H

#include <stdint.h>
#include <time.h>

/* CLOCK_MONOTONIC, ns. [any, rt-safe] */
static inline int64_t ethd__clock_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

#endif
