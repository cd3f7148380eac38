#include "statistics/distribution.h"

#include <math.h>

#define TINY 1e-300
#define TERMS 2000

double ethd__normal_below(double z) { return erfc(-z / sqrt(2)) / 2; }

/* The incomplete beta function's continued fraction, by Lentz's method (Thompson and Barnett 1986). */
static double beta_fraction(double a, double b, double x) {
  double c = 1, d = 1 - (a + b) * x / (a + 1), h;
  d = 1 / (fabs(d) < TINY ? TINY : d);
  h = d;
  for (int m = 1; m < TERMS; m++) {
    double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    for (int k = 0; k < 2; k++) {
      double term = k ? odd : even;
      d = 1 + term * d;
      c = 1 + term / c;
      d = 1 / (fabs(d) < TINY ? TINY : d);
      if (fabs(c) < TINY) c = TINY;
      h *= c * d;
    }
    if (fabs(c * d - 1) < 1e-16) break;
  }
  return h;
}

/* The regularised incomplete beta function I_x(a, b); y = 1 - x is given too, so that neither loses digits. */
static double beta_share(double a, double b, double x, double y) {
  if (x <= 0 || y <= 0) return x <= 0 ? 0 : 1;
  double front = exp(lgamma(a + b) - lgamma(a) - lgamma(b) + a * log(x) + b * log(y));
  return x < (a + 1) / (a + b + 2) ? front * beta_fraction(a, b, x) / a : 1 - front * beta_fraction(b, a, y) / b;
}

double ethd__student_below(double t, double freedom) {
  if (isnan(t) || !(freedom > 0)) return NAN;
  if (isinf(t)) return t > 0;
  double all = freedom + t * t, tail = beta_share(freedom / 2, 0.5, freedom / all, t * t / all) / 2;
  return t > 0 ? 1 - tail : tail;
}

double ethd__student_quantile(double p, double freedom) {
  if (!(p > 0 && p < 1) || !(freedom > 0)) return NAN;
  if (p > 0.5) return -ethd__student_quantile(1 - p, freedom);
  double low = -1, high = 0;
  while (ethd__student_below(low, freedom) > p) low *= 2;
  for (int i = 0; i < 200 && high - low > 1e-15 * -low; i++) {
    double middle = (low + high) / 2;
    *(ethd__student_below(middle, freedom) > p ? &high : &low) = middle;
  }
  return (low + high) / 2;
}

/* The mean of P(Z <= t s - shift) over s = sqrt(chi2/freedom), by Simpson's rule over the range in which s has
   density. */
double ethd__noncentral_below(double t, double freedom, double shift) {
  if (isnan(t) || isnan(shift) || !(freedom >= 1)) return NAN;
  double spread = 1 / sqrt(2 * freedom), from = fmax(0, 1 - 12 * spread), to = 1 + (freedom < 3 ? 16 : 12) * spread;
  const int panels = freedom < 10 ? 2000 : 400; /* even; a density with a kink at 0 needs more */
  double front = log(2) + freedom / 2 * log(freedom / 2) - lgamma(freedom / 2), sum = 0, step = (to - from) / panels;
  for (int i = 0; i <= panels; i++) {
    double s = from + step * i;
    double density = s > 0 ? exp(front + (freedom - 1) * log(s) - freedom * s * s / 2) : freedom > 1 ? 0 : exp(front);
    sum += (i == 0 || i == panels ? 1 : i % 2 ? 4 : 2) * density * ethd__normal_below(t * s - shift);
  }
  return sum * step / 3;
}

/* The incomplete gamma function: its series below a + 1, its continued fraction above. */
double ethd__chi_square_above(double x, double freedom) {
  double a = freedom / 2, z = x / 2;
  if (isnan(x) || !(freedom > 0)) return NAN;
  if (z <= 0) return 1;
  double front = exp(a * log(z) - z - lgamma(a));
  if (z < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < TERMS && term > sum * 1e-17; n++) sum += term *= z / (a + n);
    return 1 - front * sum;
  }
  double b = z + 1 - a, c = 1 / TINY, d = 1 / b, h = d;
  for (int i = 1; i < TERMS; i++) {
    double term = -i * (i - a);
    b += 2;
    d = term * d + b;
    c = b + term / c;
    d = 1 / (fabs(d) < TINY ? TINY : d);
    if (fabs(c) < TINY) c = TINY;
    h *= c * d;
    if (fabs(c * d - 1) < 1e-16) break;
  }
  return front * h;
}
