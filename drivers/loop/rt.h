/* The one difference between plain Linux and Xenomai 3: __RT(f) is the core's f, __STD(f) is libc's.

   Xenomai's own <boilerplate/wrappers.h> defines both on its two cores; here they are the same. */
#ifndef ETHD_LOOP_RT_H
#define ETHD_LOOP_RT_H

#include <pthread.h>
#include <time.h>

#if defined(__COBALT__) || defined(__MERCURY__)
#include <boilerplate/wrappers.h>
#endif
#ifndef __RT
#define __RT(f) f
#define __STD(f) f
#endif

#endif
