/* sin and cos: x = n pi/2 + r with |r| <= pi/4, then a polynomial in r and its rounding error.

   Coefficients: (sin(r)/r - 1)/z and (cos(r) - 1 + z/2)/z^2, z = r^2, interpolated with 80 digits at the
   zeros of a Chebyshev polynomial stretched so that its first zero lies on z = 0 (where the leading terms
   are exact) and its range ends at (pi/4)^2, then rounded. Relative error of the polynomials: 2^-57.1
   and 2^-59.8. Largest error of a result, measured: 0.82 ulp (sin), 0.84 ulp (cos). */
#include "ethd/maths.h"

#include <math.h>
#include <stdbool.h>

#include "maths/double.h"

/* r.hi + r.lo = x - (quadrant + 4 k) pi/2. */
typedef struct angle {
  double_pair r;
  unsigned quadrant;
} angle;

static const double_pair half_pi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};

/* The first 1184 bits of 2/pi. */
static const uint32_t two_over_pi[37] = {
    0xa2f9836e, 0x4e441529, 0xfc2757d1, 0xf534ddc0, 0xdb629599, 0x3c439041, 0xfe5163ab, 0xdebbc561,
    0xb7246e3a, 0x424dd2e0, 0x06492eea, 0x09d1921c, 0xfe1deb1c, 0xb129a73e, 0xe88235f5, 0x2ebb4484,
    0xe99c7026, 0xb45f7e41, 0x3991d639, 0x835339f4, 0x9c845f8b, 0xbdf9283b, 0x1ff897ff, 0xde05980f,
    0xef2f118b, 0x5a0a6d1f, 0x6d367ecf, 0x27cb09b7, 0x4f463f66, 0x9e5fea2d, 0x7527bac7, 0xebe5f17b,
    0x3d0739f7, 0x8a5292ea, 0x6bfb5fb1, 0x1f8d5d08, 0x56033046,
};

enum { WORDS = 7, LIMBS = WORDS + 4 };

/* p = m W, W the WORDS words of 2/pi from `first` on; least significant limb first. */
static void multiply(uint64_t m, int first, uint32_t p[LIMBS]) {
  uint64_t m0 = m & UINT32_MAX, m1 = m >> 32, carry = 0, before = 0;

  for (int i = 0; i < LIMBS; i++) {
    uint64_t w = i < WORDS ? two_over_pi[first + WORDS - 1 - i] : 0;
    uint64_t low = m0 * w, high = m1 * before;
    uint64_t t = (low & UINT32_MAX) + (high & UINT32_MAX) + (carry & UINT32_MAX);
    p[i] = (uint32_t)t;
    carry = (low >> 32) + (high >> 32) + (carry >> 32) + (t >> 32);
    before = w;
  }
}

/* The 64 bits of p from bit b upwards. */
static uint64_t window(const uint32_t p[LIMBS], int b) {
  const uint32_t *q = p + b / 32;
  int s = b % 32;
  uint64_t low = q[0] | (uint64_t)q[1] << 32;
  return s ? low >> s | (uint64_t)q[2] << (64 - s) : low;
}

/* (f1 + f0 2^-64) 2^-64 pi/2. */
static double_pair turn(uint64_t f1, uint64_t f0) {
  double_pair f = sum_ordered((double)(f1 >> 32) * 0x1p-32, (double)(f1 & UINT32_MAX) * 0x1p-64);
  f = sum_ordered(f.hi, f.lo + (double)f0 * 0x1p-128);
  double_pair r = product(f.hi, half_pi.hi);
  return sum_ordered(r.hi, r.lo + (f.hi * half_pi.lo + f.lo * half_pi.hi));
}

/* Payne and Hanek 1983: of x 2/pi = m 2^e 2/pi only the words of 2/pi matter that give the last two bits
   before the point and 128 behind it. No double is nearer than 2^-62 to a multiple of pi/2. */
static angle reduce_exactly(double x) {
  uint32_t p[LIMBS];
  uint64_t u = to_bits(x);
  int e = (int)(u >> 52 & 0x7ff) - 1075;
  int first = e > 2 ? (e - 2) / 32 : 0;
  int point = 32 * (first + WORDS) - e;

  multiply((u & 0x000fffffffffffff) | 0x0010000000000000, first, p);
  unsigned n = (unsigned)window(p, point) & 3;
  uint64_t f1 = window(p, point - 64), f0 = window(p, point - 128);
  bool above = f1 >> 63;
  if (above) { /* more than half a quadrant: count down from the next multiple */
    f0 = ~f0 + 1;
    f1 = ~f1 + (f0 == 0);
    n++;
  }
  double_pair r = turn(f1, f0);
  bool negative = u >> 63;
  if (negative != above) r = (double_pair){-r.hi, -r.lo};
  return (angle){r, negative ? 0 - n : n};
}

/* Cody and Waite 1980: n times each of the first two parts of pi/2 (33 bits each) is exact. The error of the rest is
   2^-98 at most, too much only if r is tiny. */
static angle reduce(double x) {
  if (islessequal(fabs(x), 0x1.921fb54442d18p-1)) return (angle){{x, 0}, 0};
  if (!isless(fabs(x), 0x1p20)) return isfinite(x) ? reduce_exactly(x) : (angle){{NAN, 0}, 0};

  double n = nearest(x * 0x1.45f306dc9c883p-1);
  double_pair a = sum(x - n * 0x1.921fb544p+0, n * -0x1.0b4611a6p-34);
  double_pair r = sum_ordered(a.hi, a.lo - n * 0x1.3198a2e037073p-69);
  if (fabs(r.hi) < 0x1p-36) return reduce_exactly(x);
  return (angle){r, (unsigned)(int)n};
}

static double sine(double_pair r) {
  double x = r.hi, z = x * x, w = z * z;
  double p = (-0x1.5555555555549p-3 + z * 0x1.111111110f87ap-7) +
             w * ((-0x1.a01a019c1191dp-13 + z * 0x1.71de3577ba15bp-19) +
                  w * (-0x1.ae5e6644349d5p-26 + z * 0x1.5d930594140b7p-33));
  return x + (x * z * p + r.lo * (1 - 0.5 * z));
}

static double cosine(double_pair r) {
  double x = r.hi, z = x * x, w = z * z;
  double p = (0x1.5555555555552p-5 + z * -0x1.6c16c16c15fc8p-10) +
             w * ((0x1.a01a019e155bbp-16 + z * -0x1.27e4f9083357fp-22) +
                  w * (0x1.1eea9659172d2p-29 + z * -0x1.900572f8dbd04p-37));
  double_pair a = sum_ordered(1, -0.5 * z);
  return a.hi + (a.lo + (w * p - x * r.lo));
}

static double sine_of(angle a) {
  double y = a.quadrant & 1 ? cosine(a.r) : sine(a.r);
  return a.quadrant & 2 ? -y : y;
}

double ethd_sin(double x) {
  if (x == 0) return x;
  return sine_of(reduce(x));
}

double ethd_cos(double x) {
  angle a = reduce(x);
  a.quadrant++;
  return sine_of(a);
}

void ethd_sincos(double x, double *sine_out, double *cosine_out) {
  angle a = reduce(x);
  double s = x == 0 ? x : sine(a.r), c = cosine(a.r);
  double y = a.quadrant & 1 ? c : s, v = a.quadrant & 1 ? -s : c;
  *sine_out = a.quadrant & 2 ? -y : y;
  *cosine_out = a.quadrant & 2 ? -v : v;
}
