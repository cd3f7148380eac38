/* Elementary functions that give the same bits everywhere. Links from libethd.

   A C library picks its variant of sin or exp by the CPU it finds (with or without FMA), so the same
   seed would give other bits on another machine. These functions use only + - * / and integers in a fixed order,
   and give equal bits for every compiler and CPU with IEEE 754 doubles, as long as they are built
   without contraction or value-changing optimisation (-ffp-contract=off, never -ffast-math).

   Common to all: angles in rad; NaN in, NaN out, always the same NaN; round to nearest is assumed; errno
   is never set and no floating-point flag is promised. With FTZ and DAZ set, as on the control thread,
   subnormal arguments count as zeros and subnormal results may be zeros; all other results stay the same.
   ulp: a unit in the last place of the exact result. The bounds are those of 6e8 points measured against
   80-bit long double. */
#ifndef ETHD_MATHS_H
#define ETHD_MATHS_H

#include "ethd/attributes.h"

ETHD_BEGIN_DECLS

/* Return the sine and the cosine of any finite x, however large: error < 0.86 ulp.
   sin(+-0) = +-0; NaN for infinite x. Odd and even to the bit. [any, rt-safe] */
ETHD_API double ethd_sin(double x) ETHD_RT;
ETHD_API double ethd_cos(double x) ETHD_RT;

/* Gives both of an angle x, rad, at once, with the same bits as ethd_sin and ethd_cos. [any, rt-safe] */
ETHD_API void ethd_sincos(double x, double *sine, double *cosine) ETHD_RT;

/* Returns the angle of the point (x, y) from the x axis, in [-pi, pi], with the sign of y: error < 0.51 ulp.
   Zeros and infinities as in C11 F.10.1.4: atan2(+-0, -0) = +-pi, atan2(+-0, +0) = +-0,
   atan2(+-inf, -inf) = +-3 pi/4, and so on. [any, rt-safe] */
ETHD_API double ethd_atan2(double y, double x) ETHD_RT;

/* Returns e^x: error < 0.57 ulp, < 0.78 ulp where the result is subnormal. exp(+-0) = 1, exp(-inf) = 0,
   +inf above 709.7827, 0 below -745.1332. [any, rt-safe] */
ETHD_API double ethd_exp(double x) ETHD_RT;

/* Returns the natural logarithm, of subnormal x too: error < 0.56 ulp. log(1) = +0, log(+-0) = -inf,
   log(+inf) = +inf, NaN for x < 0. [any, rt-safe] */
ETHD_API double ethd_log(double x) ETHD_RT;

/* Returns the hyperbolic tangent: error < 0.60 ulp, |tanh| <= 1, odd to the bit. tanh(+-0) = +-0,
   tanh(+-inf) = +-1. [any, rt-safe] */
ETHD_API double ethd_tanh(double x) ETHD_RT;

ETHD_END_DECLS

#endif
