/* Terms of products of power series: term k of x y is sum x_i y_(k-i). */
#ifndef ETHD__SIM_TERMS_H
#define ETHD__SIM_TERMS_H

#include "sim/two.h"

/* All is inlined: sums have lengths known at compile time, and terms that a plant doesn't have disappear. */
#define ETHD__INLINE static inline __attribute__((always_inline))

/* x_1 y_(k-1) + ... + x_(k-1) y_1 */
ETHD__INLINE ethd__two ethd__middle(const ethd__two *x, const ethd__two *y, int k) {
  if (k <= 1) return ethd__both(0);
  ethd__two s = x[1] * y[k - 1];
  if (k > 2) s += x[2] * y[k - 2];
  if (k > 3) s += x[3] * y[k - 3];
  for (int i = 4; i < k; i++) s += x[i] * y[k - i];
  return s;
}

/* Term k of x y. Term k of x, which is ready last, is added last, so that the processor sums the others meanwhile. */
ETHD__INLINE ethd__two ethd__product(const ethd__two *x, const ethd__two *y, int k) {
  if (k == 0) return x[0] * y[0];
  return (ethd__middle(x, y, k) + x[0] * y[k]) + x[k] * y[0];
}

/* Half of (x_1 x_(k-1) + ... + x_(k-1) x_1). */
ETHD__INLINE ethd__two ethd__half_middle(const ethd__two *x, int k) {
  ethd__two s = k & 1 || k == 0 ? ethd__both(0) : x[k / 2] * x[k / 2] / 2;
  if (k > 2) s += x[1] * x[k - 1];
  if (k > 4) s += x[2] * x[k - 2];
  for (int i = 3; 2 * i < k; i++) s += x[i] * x[k - i];
  return s;
}

/* Half of term k of x x. */
ETHD__INLINE ethd__two ethd__half_square(const ethd__two *x, int k) {
  if (k == 0) return x[0] * x[0] / 2;
  return ethd__half_middle(x, k) + x[0] * x[k];
}

#endif
