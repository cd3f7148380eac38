/* The one difference between plain Linux and Xenomai 3: __RT(f) is the core's f, everywhere else f itself. A plain f is
   always libc's: xeno-config's skin "cobalt" wraps no name, and libcobalt has no __real_f of each.

   Xenomai's own <boilerplate/wrappers.h> defines __RT on its two cores. */
#ifndef ETHD__LOOP_RT_H
#define ETHD__LOOP_RT_H

#include <pthread.h>
#include <time.h>

#include "ethd/base.h"

#if defined(__COBALT__) || defined(__MERCURY__)
#include <boilerplate/wrappers.h>
#endif
#ifndef __RT
#define __RT(f) f
#endif

/* Only the loop makes these two calls, to sleep and to read the clock. */
#if defined(__clang__) && __clang_major__ >= 20
int clock_gettime(clockid_t clock, struct timespec *out) ETHD_RT;
int clock_nanosleep(clockid_t clock, int flags, const struct timespec *until, struct timespec *left) ETHD_RT;
#endif

#endif
