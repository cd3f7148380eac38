#include "maths/double.h"
#include "scene/scene.h"

/* Splits a, |a| < 1e292, into its leading and trailing 26 bits (Veltkamp 1968). */
static double_pair halves(double a) {
  double c = 134217729 * a, hi = c - (c - a);
  return (double_pair){hi, a - hi};
}

/* Returns a b exactly (Dekker 1971). */
static double_pair exact_product(double a, double b) {
  double_pair u = halves(a), v = halves(b);
  double p = a * b;
  return (double_pair){p, u.lo * v.lo - (((p - u.hi * v.hi) - u.lo * v.hi) - u.hi * v.lo)};
}

/* Adds b to the sum e[0] + ... + e[n-1] of parts that don't overlap, smallest first (Shewchuk 1997). */
static void grow(double *e, int n, double b) {
  for (int i = 0; i < n; i++) {
    double_pair s = sum(b, e[i]);
    e[i] = s.lo;
    b = s.hi;
  }
  e[n] = b;
}

static int sign(double v) { return (v > 0) - (v < 0); }

/* Returns the sign of ax by - ay bx + bx cy - by cx + cx ay - cy ax: six products of two parts each, none rounded. */
static int orient_exactly(ethd_vec a, ethd_vec b, ethd_vec c) {
  const double f[6][2] = {{a.x, b.y}, {-a.y, b.x}, {b.x, c.y}, {-b.y, c.x}, {c.x, a.y}, {-c.y, a.x}};
  double e[13];
  int n = 0;
  for (int i = 0; i < 6; i++) {
    double_pair p = exact_product(f[i][0], f[i][1]);
    grow(e, n++, p.lo);
    grow(e, n++, p.hi);
  }
  while (n > 1 && e[n - 1] == 0) n--;
  return sign(e[n - 1]);
}

int ethd__orient(ethd_vec a, ethd_vec b, ethd_vec c) {
  double l = (b.x - a.x) * (c.y - a.y), r = (b.y - a.y) * (c.x - a.x);
  double det = l - r, bound = 4e-16 * (fabs(l) + fabs(r));
  return fabs(det) > bound ? sign(det) : orient_exactly(a, b, c);
}
