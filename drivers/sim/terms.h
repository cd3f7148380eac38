/* Terms of products of power series: term k of x y is sum x_i y_(k-i). */
#ifndef ETHD__SIM_TERMS_H
#define ETHD__SIM_TERMS_H

#include "sim/body.h"

/* All is inline: sums have constant lengths, and the compiler removes the terms that a plant lacks. */
#define ETHD__INLINE static inline __attribute__((always_inline))

/* 1 / k for k > 0 */
static const double ETHD__INVERSE[ETHD__ORDER_MAX + 3] = {0,        1.0,      1.0 / 2,  1.0 / 3,  1.0 / 4,  1.0 / 5,
                                                          1.0 / 6,  1.0 / 7,  1.0 / 8,  1.0 / 9,  1.0 / 10, 1.0 / 11,
                                                          1.0 / 12, 1.0 / 13, 1.0 / 14, 1.0 / 15, 1.0 / 16};

/* Converts the links' absolute angles, or their derivatives, to the joints'. */
static inline ethd__two ethd__joint(bool serial, ethd__two link) {
  return serial ? (ethd__two){link[0], link[1] - link[0]} : link;
}

/* The series' value at h. */
static inline ethd__two ethd__series_at(const ethd__two *term, int order, double h) {
  ethd__two y = term[order];
  for (int k = order - 1; k >= 0; k--) y = y * h + term[k];
  return y;
}

/* x_1 y_(k-1) + ... + x_(k-1) y_1 */
ETHD__INLINE ethd__two ethd__middle(const ethd__two *x, const ethd__two *y, int k) {
  if (k <= 1) return ethd__both(0);
  ethd__two s = x[1] * y[k - 1];
  if (k > 2) s += x[2] * y[k - 2];
  if (k > 3) s += x[3] * y[k - 3];
  for (int i = 4; i < k; i++) s += x[i] * y[k - i];
  return s;
}

/* Term k of x y. Term k of x is ready last and is added last, so that the processor sums the others meanwhile. */
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
