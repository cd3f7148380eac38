/* The processor's floating-point mode: the library computes rounded to nearest, with subnormal numbers as 0 (FTZ, DAZ)
   and without traps, in any mode of the caller's thread. A function that promises this sets the mode when it begins and
   restores the caller's when it ends. [any, rt-safe]

   x87, from which strtod reads the rounding mode and which a law may use, has its own word. It is set only if the other
   word differs, since the C library sets rounding and traps of both. */
#ifndef ETHD__FP_MODE_H
#define ETHD__FP_MODE_H

#include <stdbool.h>
#include <stdint.h>

#include "ethd/base.h"

#if defined(__SSE__)
#include <xmmintrin.h>
#define ETHD__FP_BITS 0xffc0u /* of MXCSR; the others are flags that any operation may raise */
#define ETHD__FP_MODE 0x9fc0u
static inline uint64_t ethd__fp_now(void) ETHD_RT { return _mm_getcsr(); }
static inline void ethd__fp_set(uint64_t word) ETHD_RT { _mm_setcsr((uint32_t)word); }
static inline uint16_t ethd__x87_now(void) ETHD_RT {
  uint16_t word;
  __asm__ volatile("fnstcw %0" : "=m"(word));
  return word;
}
static inline void ethd__x87_set(uint16_t word) ETHD_RT {
  __asm__ volatile("fnclex\n\tfldcw %0" : : "m"(word) : "memory"); /* a pending trap would be taken at the load */
}
#elif defined(__aarch64__)
#define ETHD__FP_BITS UINT64_MAX /* of FPCR */
#define ETHD__FP_MODE ((uint64_t)1 << 24)
static inline uint64_t ethd__fp_now(void) ETHD_RT {
  uint64_t word;
  __asm__ volatile("mrs %0, fpcr" : "=r"(word));
  return word;
}
static inline void ethd__fp_set(uint64_t word) ETHD_RT { __asm__ volatile("msr fpcr, %0" : : "r"(word)); }
#elif defined(__riscv_flen)
#define ETHD__FP_BITS 7u /* frm, which is rounding alone: there are no traps, and nothing is flushed */
#define ETHD__FP_MODE 0u
static inline uint64_t ethd__fp_now(void) ETHD_RT {
  uint64_t word;
  __asm__ volatile("csrr %0, frm" : "=r"(word));
  return word;
}
static inline void ethd__fp_set(uint64_t word) ETHD_RT { __asm__ volatile("csrw frm, %0" : : "r"(word)); }
#else
/* This processor's mode isn't known, so it isn't watched. */
#define ETHD__FP_BITS 0u
#define ETHD__FP_MODE 0u
static inline uint64_t ethd__fp_now(void) ETHD_RT { return 0; }
static inline void ethd__fp_set(uint64_t word) ETHD_RT { (void)word; }
#endif

/* Returns true if the thread is in the library's mode, as in all of our programs. */
static inline bool ethd__fp_is_own(void) ETHD_RT {
  return __builtin_expect((ethd__fp_now() & ETHD__FP_BITS) == ETHD__FP_MODE, 1);
}

#ifndef __SSE__
static inline uint16_t ethd__x87_now(void) ETHD_RT { return 0; }
static inline void ethd__x87_set(uint16_t word) ETHD_RT { __asm__ volatile("" : : "r"(word) : "memory"); }
#endif

#define ETHD__FP_OTHER ((uint64_t)1 << 63) /* no processor's mode uses this bit, nor those from */
#define ETHD__X87_AT 32                    /* on, where it has an x87 */
#define ETHD__X87_MODE 0x37f               /* to nearest, to 64 bits, without traps */

/* Sets the library's mode and returns the argument of ethd__fp_give. The code in between must be a function that isn't
   inline, so that no arithmetic moves out; setting the x87's word keeps calls that only read from moving. */
static inline uint64_t ethd__fp_take(void) ETHD_RT {
  if (ethd__fp_is_own()) return 0;
  const uint64_t callers = ethd__fp_now() | (uint64_t)ethd__x87_now() << ETHD__X87_AT;
  ethd__fp_set(ETHD__FP_MODE);
  ethd__x87_set(ETHD__X87_MODE);
  return callers | ETHD__FP_OTHER;
}

static inline void ethd__fp_give(uint64_t callers) ETHD_RT {
  if (!callers) return;
  ethd__x87_set((uint16_t)(callers >> ETHD__X87_AT));
  ethd__fp_set(callers & ~ETHD__FP_OTHER);
}

#define ETHD__FP_APART __attribute__((noinline))

/* The body of a function that makes this call in the library's mode, and returns what it gives. */
#define ETHD__FP_RETURN(type, call)           \
  do {                                        \
    const uint64_t callers = ethd__fp_take(); \
    const type given = call;                  \
    ethd__fp_give(callers);                   \
    return given;                             \
  } while (0)
#define ETHD__FP_DO(call)                     \
  do {                                        \
    const uint64_t callers = ethd__fp_take(); \
    call;                                     \
    ethd__fp_give(callers);                   \
  } while (0)

#endif
