/* Sine and cosine of two angles side by side, with the operations of trig.c: the same bits as ethd_sin and ethd_cos, in
   half the time. */
#ifndef ETHD__MATHS_TWO_WAVES_H
#define ETHD__MATHS_TWO_WAVES_H

#include <math.h>
#include <stdbool.h>

#include "ethd/maths.h"
#include "maths/two.h"

typedef struct two_waves {
  two sine, cosine;
} two_waves;

/* The reduced angles: x - n pi/2 = r + rest, |r| <= pi/4. For |x| up to pi/4, n = 0 and r = x. */
typedef struct two_angles {
  two r, rest;
  two_bits n; /* in its last bits */
} two_angles;

static inline two_angles two_reduce(two x) {
  two shifted = x * 0x1.45f306dc9c883p-1 + 0x1.8p52, n = shifted - 0x1.8p52;
  two a = x - n * 0x1.921fb544p+0, b = n * -0x1.0b4611a6p-34;
  two s = a + b, t = s - a, d = ((a - (s - t)) + (b - t)) - n * 0x1.3198a2e037073p-69, r = s + d;
  return (two_angles){r, d - (r - s), (two_bits)shifted};
}

static inline two two_sine(two x, two rest) {
  two z = x * x, w = z * z;
  two p = (-0x1.5555555555549p-3 + z * 0x1.111111110f87ap-7) +
          w * ((-0x1.a01a019c1191dp-13 + z * 0x1.71de3577ba15bp-19) +
               w * (-0x1.ae5e6644349d5p-26 + z * 0x1.5d930594140b7p-33));
  return x + (x * z * p + rest * (1 - 0.5 * z));
}

static inline two two_cosine(two x, two rest) {
  two z = x * x, w = z * z;
  two p = (0x1.5555555555552p-5 + z * -0x1.6c16c16c15fc8p-10) +
          w * ((0x1.a01a019e155bbp-16 + z * -0x1.27e4f9083357fp-22) +
               w * (0x1.1eea9659172d2p-29 + z * -0x1.900572f8dbd04p-37));
  two m = -0.5 * z, a = 1 + m;
  return a + ((m - (a - 1)) + (w * p - x * rest));
}

/* Returns false, which is rare, for angles that are huge, tiny, near a multiple of pi/2, or NaN: trig.c does those. */
static inline bool two_is_plain(double x, double r) { return fabs(x) < 0x1p20 && fabs(r) >= 0x1p-36; }

/* The quadrant n exchanges sine and cosine and changes signs, by masks, since branches on n would be mispredicted. */
static inline two_waves two_sincos(two x) {
  two_angles a = two_reduce(x);
  if (!two_is_plain(x[0], a.r[0]) || !two_is_plain(x[1], a.r[1]))
    return (two_waves){{ethd_sin(x[0]), ethd_sin(x[1])}, {ethd_cos(x[0]), ethd_cos(x[1])}};
  two_bits s = (two_bits)two_sine(a.r, a.rest), c = (two_bits)two_cosine(a.r, a.rest);
  two_bits exchange = (s ^ c) & (0 - (a.n & 1));
  return (two_waves){(two)(s ^ exchange ^ (a.n & 2) << 62), (two)(c ^ exchange ^ ((a.n + 1) & 2) << 62)};
}

#endif
