/* Speed from which a ring can still stop at a distance d (Workman 1987, proximate time-optimal servomechanism).

   With the constant deceleration a it is sqrt(2 a d). A sampled loop can't follow its end: the slope a/v of the speed
   over the distance grows without bound. Below d_l the curve is a straight line of slope `rate`, the loop's bandwidth.
   Value and slope are those of a root that is moved by d_l/2:

     f(d) = rate d             d <= d_l          rate d_l = sqrt(2 a (d_l - d_l/2))     and
            sqrt(2 a (d - d_l/2))  d > d_l       rate = a / sqrt(2 a (d_l - d_l/2))     both say  d_l = a / rate^2

   Along it the acceleration is -f f': -a on the root, -rate v on the line. A ring on the curve at speed v stops after
   v^2/(2a) + d_l/2.                                                                                    [rt] */
#ifndef ETHD__LAW_BRAKE_CURVE_H
#define ETHD__LAW_BRAKE_CURVE_H

#include <math.h>

#include "ethd/base.h"

typedef struct ethd__brake_curve {
  double a, rate; /* m/s^2, 1/s */
  double linear;  /* d_l, m */
} ethd__brake_curve;

/* Returns the curve. A loop of this period can settle at most half of its distance in a tick. */
static inline ethd__brake_curve ethd__brake_curve_of(double a, double rate, double period) ETHD_RT {
  double r = rate * period > 0.5 ? 0.5 / period : rate;
  return (ethd__brake_curve){a, r, a / (r * r)};
}

static inline double ethd__brake_curve_speed(const ethd__brake_curve *c, double d) ETHD_RT {
  return d <= c->linear ? c->rate * d : sqrt(2 * c->a * (d - c->linear / 2));
}

/* Returns the distance at which the curve has speed v, m: the stopping distance of a ring at this speed. */
static inline double ethd__brake_curve_way(const ethd__brake_curve *c, double v) ETHD_RT {
  return v <= c->rate * c->linear ? v / c->rate : v * v / (2 * c->a) + c->linear / 2;
}

/* Returns the acceleration, m/s^2, of a ring that is on the curve at d with speed v. */
static inline double ethd__brake_curve_slope(const ethd__brake_curve *c, double d, double v) ETHD_RT {
  return d > c->linear ? -c->a : -c->rate * v;
}

#endif
