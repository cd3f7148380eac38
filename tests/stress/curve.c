#include "stress/curve.h"

#include <complex.h>
#include <math.h>

const curve_estimator curve_estimators[CURVE_ESTIMATORS] = {{"difference", ETHD_VELOCITY_DIFFERENCE, 0},
                                                            {"lowpass 20 Hz", ETHD_VELOCITY_LOWPASS, 20},
                                                            {"lowpass 130 Hz", ETHD_VELOCITY_LOWPASS, 130},
                                                            {"lowpass 400 Hz", ETHD_VELOCITY_LOWPASS, 400},
                                                            {"lsq of 4", ETHD_VELOCITY_LSQ, 4},
                                                            {"lsq of 8", ETHD_VELOCITY_LSQ, 8}};

/* The slope of the least-squares line through n samples at times -i T. */
static double complex line(double T, int n, double complex back) {
  double complex sum = 0, power = 1;
  for (int i = 0; i < n; i++, power *= back) sum += ((n - 1) / 2.0 - i) * power;
  return sum * 12 / (n * ((double)n * n - 1) * T);
}

static double complex estimator(const ethd__curve *c, double th) {
  double complex back = cexp(-I * th), difference = (1 - back) / c->period;
  double keep = exp(-2 * M_PI * c->value * c->period);
  if (c->method == ETHD_VELOCITY_LSQ) return line(c->period, (int)c->value, back);
  if (c->method == ETHD_VELOCITY_LOWPASS) return (1 - keep) * difference / (1 - keep * back);
  return difference;
}

void ethd__curve_at(const ethd__curve *c, double th, double *stiffness, double *damping) {
  double t = tan(th / 2);
  double complex wanted = 4 * c->mass / (c->period * c->period) * t * t * cos(th / 2) * cexp(I * (c->delay + 0.5) * th);
  double complex h = estimator(c, th);
  *damping = cimag(wanted) / cimag(h);
  *stiffness = creal(wanted) - *damping * creal(h);
}

static double stiffness_at(const ethd__curve *c, double th) {
  double k, b;
  ethd__curve_at(c, th, &k, &b);
  return k;
}

double ethd__curve_end(const ethd__curve *c) {
  double low = 1e-3, high = low;
  while (stiffness_at(c, high) > 0) high += 1e-3;
  low = high - 1e-3;
  for (int i = 0; i < 50; i++) {
    double middle = (low + high) / 2;
    if (stiffness_at(c, middle) > 0)
      low = middle;
    else
      high = middle;
  }
  return low;
}
