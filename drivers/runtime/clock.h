/* The clock that loop, I/O threads and drivers share when time isn't virtual. */
#ifndef ETHD__CLOCK_H
#define ETHD__CLOCK_H

#include <stdbool.h>
#include <stdint.h>
#include <time.h>

/* Returns CLOCK_MONOTONIC's time, ns. [any, rt-safe] */
static inline int64_t ethd__clock_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

/* Returns t_ns, or the instant just after last_ns where that is later. Readings come in their order, though the clock
   by which they are placed is placed better with each quick arrival, and so may move back. last_ns 0: there was none.
   [any, rt-safe] */
static inline int64_t ethd__clock_after(int64_t last_ns, int64_t t_ns) {
  return last_ns && t_ns <= last_ns ? last_ns + 1 : t_ns;
}

/* Returns true at the first call, and after 0.1 s without one; *heard_ns is 0 at first. A sensor's reader
   calls it before each read. After such a pause the arrival time of data is unknown; it must not be taken as now. */
static inline bool ethd__clock_was_deaf(int64_t *heard_ns, int64_t now_ns) {
  const int64_t before = *heard_ns;
  *heard_ns = now_ns;
  return !before || now_ns - before > 100000000;
}

#endif
