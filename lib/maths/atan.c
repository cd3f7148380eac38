/* atan2: swap and mirror to q = low/high in [0, 1], rotate by the angle of the nearest c = j/8, and

     atan q = atan c + atan t,  t = (low - c high)/(high + c low),  |t| <= 1/16.

   t is accurate to about 70 bits. Numerator and denominator are exact, since c has three bits. The quotient is a short
   one, whose product with the denominator is exact, plus the quotient of the remainder.

   Coefficients: (atan(t)/t - 1)/z, z = t^2, interpolated with 80 digits at the zeros of a Chebyshev
   polynomial stretched so that its first zero lies on z = 0 and its range ends at 1/16^2, then rounded.
   Relative error of the polynomial: 2^-61.9. Largest error of a result, measured: 0.505 ulp. */
#include "ethd/maths.h"

#include <math.h>
#include <stdbool.h>

#include "maths/double.h"

static const double_pair pi = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
static const double_pair half_pi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};

/* atan(j/8) */
static const double_pair atan_eighths[9] = {
    {0, 0},
    {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
    {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
    {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
    {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
    {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
    {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
    {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
    {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
};

/* t = hi + lo, where hi has 16 bits. */
static double_pair quotient(double low, double high, double c) {
  double l1 = head(low, 27), l2 = low - l1, h1 = head(high, 27), h2 = high - h1;
  double_pair a = sum(low - c * h1, -c * h2);
  double d1 = h1 + c * l1, d2 = h2 + c * l2;
  double inverse = 1 / (d1 + d2);
  double t = head(a.hi * inverse, 37);
  return (double_pair){t, (((a.hi - t * d1) - t * d2) + a.lo) * inverse};
}

/* atan(low/high), 2^-60 high < low <= high, or low = 0. */
static double_pair first_octant(double low, double high) {
  int j = (int)(8 * (low / high) + 0.5);
  double_pair t = quotient(low, high, 0.125 * j);
  double x = t.hi + t.lo, z = x * x, w = z * z;
  double p = -0x1.5555555555536p-2 + (z * (0x1.9999999962d43p-3 + z * -0x1.249248289836ap-3) +
                                      z * w * (0x1.c7187d83e3f22p-4 + z * -0x1.70c11e1b6c468p-4));
  double_pair c = atan_eighths[j], a = sum_ordered(c.hi, t.hi);
  return (double_pair){a.hi, a.lo + (t.lo + (c.lo + x * z * p))};
}

/* base + sign a, rounded. */
static double add(double_pair base, double sign, double_pair a) {
  double_pair s = sum_ordered(base.hi, sign * a.hi);
  return s.hi + (sign * a.lo + (base.lo + s.lo));
}

/* Angle of (x, y), y > 0 in effect, from low = min(|x|, y), high = max(|x|, y). */
static double upper_half(double low, double high, bool steep, bool left) {
  if (low < high * 0x1p-60) {
    if (!steep && !left) return low / high;
    low = 0;
  }
  double_pair a = first_octant(low, high);
  if (steep) return add(half_pi, left ? 1 : -1, a);
  return left ? add(pi, -1, a) : a.hi + a.lo;
}

double ethd_atan2(double y, double x) {
  if (isnan(x) || isnan(y)) return NAN;
  double ax = fabs(x), ay = fabs(y);
  bool steep = ay > ax;
  double low = steep ? ax : ay, high = steep ? ay : ax;

  if (isinf(high)) {
    low = isinf(low) ? 1 : 0;
    high = 1;
  } else if (high > 0x1p1000) { /* room for high + c low */
    low *= 0x1p-60;
    high *= 0x1p-60;
  } else if (high < 0x1p-800) { /* room for the remainder */
    low *= 0x1p200;
    high *= 0x1p200;
  }
  if (high == 0) high = 1;
  return copysign(upper_half(low, high, steep, signbit(x) != 0), y);
}
