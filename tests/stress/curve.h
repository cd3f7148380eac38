/* The boundary of stability of the sampled loop, in closed form.

   Mass m under zero-order hold: G(z) = T^2/(2m) (z + 1)/(z - 1)^2. Force -(K + B H(z)) x, n ticks late,
   H the velocity estimator. On the boundary a mode stands on the unit circle, z = e^(j th):

       K + B H = -z^n / G = 4m/T^2 tan^2(th/2) cos(th/2) e^(j (n + 1/2) th)

   whose real and imaginary parts give K and B. With H = (1 - 1/z)/T it is the backward difference's
       K T^2/m = 4 tan^2(th/2) cos((n+1) th),  B T/m = 2 tan(th/2) sin((n+1) th) - K T^2/(2m). */
#ifndef ETHD_TESTS_STRESS_CURVE_H
#define ETHD_TESTS_STRESS_CURVE_H

#include "ethd/estimate.h"

typedef struct ethd__curve {
  double mass, period;         /* kg, s */
  int delay;                   /* n */
  ethd_velocity_method method; /* difference, lowpass or lsq */
  double value;                /* cutoff, Hz, or window, samples */
} ethd__curve;

/* The estimators that the tests of the boundary try. */
enum { CURVE_ESTIMATORS = 6 };
typedef struct curve_estimator {
  const char *name;
  ethd_velocity_method method;
  double value; /* as in ethd__curve */
} curve_estimator;
extern const curve_estimator curve_estimators[CURVE_ESTIMATORS];

/* Gives K, N/m, and B, Ns/m, on the boundary at 0 < th, rad. */
void ethd__curve_at(const ethd__curve *curve, double th, double *stiffness, double *damping);

/* Returns the curve's end: the smallest th > 0 with K = 0, where a free ring's damping is at its largest. */
double ethd__curve_end(const ethd__curve *curve);

#endif
