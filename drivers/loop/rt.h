/* The one difference between plain Linux and Xenomai 3: __RT(f) is the core's f, everywhere else f itself. A plain f is
   always libc's: xeno-config's skin "cobalt" wraps no name, and libcobalt has no __real_f of each.

   Xenomai's own <boilerplate/wrappers.h> defines __RT on its two cores. */
#ifndef ETHD__LOOP_RT_H
#define ETHD__LOOP_RT_H

#include <pthread.h>
#include <time.h>

#if defined(__COBALT__) || defined(__MERCURY__)
#include <boilerplate/wrappers.h>
#endif
#ifndef __RT
#define __RT(f) f
#endif

#endif
