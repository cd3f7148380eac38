/* The bits of a double, and sums and products whose rounding error is kept (Dekker 1971, Knuth 4.2.2).
   Doubles are split by masks, not by fma(), so that machines with and without FMA give the same bits. */
#ifndef ETHD__MATHS_DOUBLE_H
#define ETHD__MATHS_DOUBLE_H

#include <float.h>
#include <stdint.h>
#include <string.h>

/* On CPUs with half-precision arithmetic FLT_EVAL_METHOD is 16, which for doubles means 0. */
_Static_assert(FLT_EVAL_METHOD == 0 || FLT_EVAL_METHOD == 16, "excess precision would change the bits");

/* The number hi + lo, kept as two; |lo| <= ulp(hi)/2 unless said otherwise. */
typedef struct double_pair {
  double hi, lo;
} double_pair;

static inline uint64_t to_bits(double x) {
  uint64_t u;
  memcpy(&u, &x, sizeof u);
  return u;
}

static inline double from_bits(uint64_t u) {
  double x;
  memcpy(&x, &u, sizeof x);
  return x;
}

/* 2^k, -1022 <= k <= 1023. */
static inline double power_of_two(int64_t k) { return from_bits((uint64_t)(k + 1023) << 52); }

/* The leading 53 - n bits of x. */
static inline double head(double x, unsigned n) { return from_bits(to_bits(x) & ~(((uint64_t)1 << n) - 1)); }

/* Nearest integer, ties to even, |x| < 2^51. */
static inline double nearest(double x) { return x + 0x1.8p52 - 0x1.8p52; }

/* a + b exactly, if |a| >= |b| or a = 0. */
static inline double_pair sum_ordered(double a, double b) {
  double s = a + b;
  return (double_pair){s, b - (s - a)};
}

/* a + b exactly. */
static inline double_pair sum(double a, double b) {
  double s = a + b, t = s - a;
  return (double_pair){s, (a - (s - t)) + (b - t)};
}

/* a b, within 2^-105 of it. */
static inline double_pair product(double a, double b) {
  double p = a * b, a1 = head(a, 27), b1 = head(b, 27), a2 = a - a1, b2 = b - b1;
  return (double_pair){p, (((a1 * b1 - p) + a1 * b2) + a2 * b1) + a2 * b2};
}

#endif
