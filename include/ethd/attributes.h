/* Attributes that say, and let the compiler check, what a function promises. Links from libethd.

   Thread tags close every contract in these headers:
     [main]  the thread that created the object; may allocate and block
     [rt]    the control thread: bounded work, no heap, lock, system call, errno or stdio
     [any]   any thread, as said there
   ETHD_RT marks prototypes and function-pointer types of the [rt] side; clang 20 and later
   checks it with -Wfunction-effects. */
#ifndef ETHD_ATTRIBUTES_H
#define ETHD_ATTRIBUTES_H

#include <stddef.h>

#ifdef __cplusplus
#define ETHD_BEGIN_DECLS extern "C" {
#define ETHD_END_DECLS }
#else
#define ETHD_BEGIN_DECLS
#define ETHD_END_DECLS
#endif

#define ETHD_API __attribute__((visibility("default")))
#define ETHD_MUST_CHECK __attribute__((warn_unused_result))

#if defined(__clang__) && __clang_major__ >= 20
#define ETHD_RT __attribute__((nonblocking))
#else
#define ETHD_RT
#endif

#endif
