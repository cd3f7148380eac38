/* FTZ and DAZ: subnormal numbers count as 0, which keeps every step equally quick. flush sets them for this thread,
   rounds to nearest and takes no trap, whatever an application has set; keep clears FTZ and DAZ; hold takes no trap and
   leaves the rest. All return what was set before, for restore. What is computed in between stands in a function that
   isn't inline. [any] */
#ifndef ETHD__DENORMALS_H
#define ETHD__DENORMALS_H

#include <stdint.h>

#if defined(__SSE__)
#include <xmmintrin.h>
static inline uint64_t ethd__denormals_flush(void) {
  unsigned before = _mm_getcsr();
  _mm_setcsr(0x9fc0u);
  return before;
}
static inline uint64_t ethd__denormals_keep(void) {
  unsigned before = _mm_getcsr();
  _mm_setcsr(before & ~0x8040u);
  return before;
}
static inline uint64_t ethd__traps_hold(void) {
  unsigned before = _mm_getcsr();
  _mm_setcsr(before | 0x1f80u);
  return before;
}
static inline void ethd__denormals_restore(uint64_t before) { _mm_setcsr((unsigned)before); }
#elif defined(__aarch64__)
static inline uint64_t ethd__denormals_flush(void) {
  uint64_t before;
  __asm__ volatile("mrs %0, fpcr" : "=r"(before));
  __asm__ volatile("msr fpcr, %0" : : "r"((uint64_t)1 << 24));
  return before;
}
static inline uint64_t ethd__denormals_keep(void) {
  uint64_t before;
  __asm__ volatile("mrs %0, fpcr" : "=r"(before));
  __asm__ volatile("msr fpcr, %0" : : "r"(before & ~((uint64_t)1 << 24)));
  return before;
}
static inline uint64_t ethd__traps_hold(void) {
  uint64_t before;
  __asm__ volatile("mrs %0, fpcr" : "=r"(before));
  __asm__ volatile("msr fpcr, %0" : : "r"(before & ~(uint64_t)0x9f00));
  return before;
}
static inline void ethd__denormals_restore(uint64_t before) { __asm__ volatile("msr fpcr, %0" : : "r"(before)); }
#else
static inline uint64_t ethd__denormals_flush(void) { return 0; }
static inline uint64_t ethd__denormals_keep(void) { return 0; }
static inline uint64_t ethd__traps_hold(void) { return 0; }
static inline void ethd__denormals_restore(uint64_t before) { (void)before; }
#endif

#endif
