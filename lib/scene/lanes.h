/* Four floats at a time. Arithmetic is the compiler's own on vector types, so every machine gets the same
   bits; -DETHD_NO_SIMD leaves out the two instructions that compilers don't find by themselves. */
#ifndef ETHD__SCENE_LANES_H
#define ETHD__SCENE_LANES_H

#include <stdint.h>

#if defined(__SSE2__) && !defined(ETHD_NO_SIMD)
#include <emmintrin.h>
#define ETHD__SSE2 1
#else
#define ETHD__SSE2 0
#endif

#define ETHD__INLINE static inline __attribute__((always_inline))

typedef float ethd__floats __attribute__((vector_size(16), may_alias));
typedef int32_t ethd__ints __attribute__((vector_size(16)));

/* `at` is aligned to 16 bytes. */
ETHD__INLINE ethd__floats ethd__load(const float *at) { return *(const ethd__floats *)(const void *)at; }
ETHD__INLINE void ethd__store(float *at, ethd__floats v) { *(ethd__floats *)(void *)at = v; }

ETHD__INLINE ethd__floats ethd__all(float v) { return (ethd__floats){v, v, v, v}; }

ETHD__INLINE ethd__floats ethd__abs(ethd__floats v) {
  return (ethd__floats)((ethd__ints)v & (ethd__ints){INT32_MAX, INT32_MAX, INT32_MAX, INT32_MAX});
}

/* a > b ? a : b */
ETHD__INLINE ethd__floats ethd__max(ethd__floats a, ethd__floats b) {
#if ETHD__SSE2
  return (ethd__floats)_mm_max_ps((__m128)a, (__m128)b);
#else
  ethd__ints over = a > b;
  return (ethd__floats)((over & (ethd__ints)a) | (~over & (ethd__ints)b));
#endif
}

/* a < b ? a : b */
ETHD__INLINE ethd__floats ethd__min(ethd__floats a, ethd__floats b) {
#if ETHD__SSE2
  return (ethd__floats)_mm_min_ps((__m128)a, (__m128)b);
#else
  ethd__ints under = a < b;
  return (ethd__floats)((under & (ethd__ints)a) | (~under & (ethd__ints)b));
#endif
}

/* Sets all lanes to the least of the four. */
ETHD__INLINE ethd__floats ethd__least(ethd__floats v) {
#if ETHD__SSE2
  v = ethd__min(v, (ethd__floats)_mm_shuffle_ps((__m128)v, (__m128)v, _MM_SHUFFLE(1, 0, 3, 2)));
  return ethd__min(v, (ethd__floats)_mm_shuffle_ps((__m128)v, (__m128)v, _MM_SHUFFLE(2, 3, 0, 1)));
#else
  float a = v[0] < v[1] ? v[0] : v[1], b = v[2] < v[3] ? v[2] : v[3];
  return ethd__all(a < b ? a : b);
#endif
}

/* Returns bit k set if lane k is true. */
ETHD__INLINE unsigned ethd__bits(ethd__ints m) {
#if ETHD__SSE2
  return (unsigned)_mm_movemask_ps((__m128)m);
#else
  return (unsigned)((m[0] & 1) | (m[1] & 2) | (m[2] & 4) | (m[3] & 8));
#endif
}

#endif
