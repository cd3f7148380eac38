/* exp, log and tanh from one table of the sixteenth roots of two.

     e^x = 2^(n/16) e^r,              n = nearest(16 x / ln 2),   |r| <= ln 2 / 32
     log x = n ln 2 / 16 + log(1+r),  1 + r = x 2^(-n/16),        n near 16 log2 x, and 0 near x = 1
     tanh x = (E - 1)/(E + 1),        E = e^(2x); a polynomial below 1/4

   Coefficients: (e^r - 1 - r)/r^2 on |r| <= ln 2 / 32, (log(1+r) - r)/r^2 on |r| <= 0.0235, interpolated
   with 80 digits at the zeros of a Chebyshev polynomial, then rounded; (tanh(x)/x - 1)/z, z = x^2, at
   those of one stretched so that its first zero lies on z = 0 and its range ends at 1/16. Relative error
   of the polynomials: 2^-64.4, 2^-58.8 and 2^-59.2. Largest error of a result, measured: exp 0.561 ulp
   (subnormal 0.760), log 0.544, tanh 0.580. */
#include "ethd/maths.h"

#include <math.h>

#include "maths/double.h"

/* 2^(j/16); only log needs the last row. */
static const double_pair root[17] = {
    {0x1.0000000000000p+0, 0},
    {0x1.0b5586cf9890fp+0, 0x1.8a62e4adc610bp-54},
    {0x1.172b83c7d517bp+0, -0x1.19041b9d78a76p-55},
    {0x1.2387a6e756238p+0, 0x1.9b07eb6c70573p-54},
    {0x1.306fe0a31b715p+0, 0x1.6f46ad23182e4p-55},
    {0x1.3dea64c123422p+0, 0x1.ada0911f09ebcp-55},
    {0x1.4bfdad5362a27p+0, 0x1.d4397afec42e2p-56},
    {0x1.5ab07dd485429p+0, 0x1.6324c054647adp-54},
    {0x1.6a09e667f3bcdp+0, -0x1.bdd3413b26456p-54},
    {0x1.7a11473eb0187p+0, -0x1.41577ee04992fp-55},
    {0x1.8ace5422aa0dbp+0, 0x1.6e9f156864b27p-54},
    {0x1.9c49182a3f090p+0, 0x1.c7c46b071f2bep-56},
    {0x1.ae89f995ad3adp+0, 0x1.7a1cd345dcc81p-54},
    {0x1.c199bdd85529cp+0, 0x1.11065895048ddp-55},
    {0x1.d5818dcfba487p+0, 0x1.2ed02d75b3707p-55},
    {0x1.ea4afa2a490dap+0, -0x1.e9c23179c2893p-54},
    {0x1.0000000000000p+1, 0},
};

/* ln 2 / 16; the first part has 37 bits, so that n times it is exact for every n in use. */
static const double_pair step = {0x1.62e42fefap-5, 0x1.cf79abc9e3b3ap-44};

/* e^x = (m.hi + m.lo) 2^k, 1 <= m.hi < 2, |m.lo| < 0.022 m.hi. */
typedef struct power {
  double_pair m;
  int64_t k;
} power;

/* floor(i/16) */
static int64_t floor_16(int64_t i) { return (i - (i & 15)) / 16; }

static power raise(double x) {
  double n = nearest(x * 0x1.71547652b82fep+4);
  int64_t i = (int64_t)n;
  double r = (x - n * step.hi) - n * step.lo, z = r * r;
  double p =
      (0x1.0000000000001p-1 + r * 0x1.5555555555556p-3) +
      z * ((0x1.55555554e93b7p-5 + r * 0x1.11111110e1059p-7) + z * (0x1.6c17ed5c1f49ep-10 + r * 0x1.a01b0c3c80bbcp-13));
  double_pair t = root[i & 15];
  return (power){{t.hi, t.lo + t.hi * (r + z * p)}, floor_16(i)};
}

#define OVERFLOWS 0x1.62e42fefa39efp+9 /* ln of the largest double; the next x gives 512 ulp more than that */

double ethd_exp(double x) {
  if (isnan(x)) return NAN;
  if (x > OVERFLOWS) return HUGE_VAL;
  if (x < -746) return 0;
  power e = raise(x);
  double y = e.m.hi + e.m.lo;
  if (e.k > 1000) return y * power_of_two(e.k - 100) * 0x1p100;
  if (e.k < -1000) return y * power_of_two(e.k + 100) * 0x1p-100;
  return y * power_of_two(e.k);
}

/* log(1+r) - r */
static double log_tail(double r) {
  double z = r * r, w = z * z;
  double p =
      ((-0x1.fffffffffffffp-2 + r * 0x1.5555555555554p-2) + z * (-0x1.0000000012891p-2 + r * 0x1.99999999bb4d1p-3)) +
      w * ((-0x1.555550365e420p-3 + r * 0x1.2492447cc50e2p-3) + z * (-0x1.0039f1bbe4769p-3 + r * 0x1.c785cc773eb3bp-4));
  return z * p;
}

/* log(2^k x), x normal. */
static double log_scaled(double x, int64_t k) {
  uint64_t u = to_bits(x);
  int64_t e = (int64_t)(u - 0x3fe6a09e667f3bcd) >> 52; /* x 2^-e in [sqrt(1/2), sqrt(2)) */
  double f = from_bits(u - ((uint64_t)e << 52)) - 1;
  int64_t i = 16 * e + (int64_t)nearest(f * (23.1121 + f * (-12.0037 + f * 7.09835)));
  double half = from_bits(u - ((uint64_t)(floor_16(i) + 1) << 52)), n = (double)(i + 16 * k);

  double_pair t = root[16 - (i & 15)], m = product(half, t.hi);
  double_pair r = sum(m.hi - 1, m.lo + half * t.lo);
  double_pair a = sum_ordered(n * step.hi, r.hi);
  return a.hi + (a.lo + (n * step.lo + (r.lo + log_tail(r.hi))));
}

double ethd_log(double x) {
  if (x == 0) return -HUGE_VAL;
  if (isnan(x) || x < 0) return NAN;
  if (x > DBL_MAX) return x;
  return x < DBL_MIN ? log_scaled(x * 0x1p54, -54) : log_scaled(x, 0);
}

static double tanh_small(double x) {
  double z = x * x, w = z * z;
  double p =
      ((-0x1.5555555555555p-2 + z * 0x1.1111111110e03p-3) + w * (-0x1.ba1ba1b99400ep-5 + z * 0x1.664f4827b41efp-6)) +
      w * w *
          ((-0x1.226e1381eda6cp-7 + z * 0x1.d6c51b22c6c4bp-9) +
           w * (-0x1.7bc6cb8fc7ba0p-10 + z * 0x1.148da283151a7p-11));
  return x + x * z * p;
}

/* The product of the quotient's and the denominator's first 26 bits is exact; the remainder gives the rest. */
static double tanh_large(double x) {
  power e = raise(2 * x);
  double scale = power_of_two(e.k), h = e.m.hi * scale, l = e.m.lo * scale;
  double_pair a = sum_ordered(h, -1), b = sum_ordered(h, 1);
  double b1 = head(b.hi, 27), b2 = (b.hi - b1) + (b.lo + l), inverse = 1 / (b.hi + l);
  a = sum_ordered(a.hi, a.lo + l);
  double q = head(a.hi * inverse, 27);
  return q + (((a.hi - q * b1) - q * b2) + a.lo) * inverse;
}

double ethd_tanh(double x) {
  double a = fabs(x);
  if (isnan(x)) return NAN;
  if (a < 0.25) return copysign(tanh_small(a), x);
  if (a < 20) return copysign(tanh_large(a), x);
  return copysign(1, x);
}
