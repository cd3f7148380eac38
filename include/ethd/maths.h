/* Vectors of plane and space, and elementary functions that give the same bits everywhere. Links from libethd. */
#ifndef ETHD_MATHS_H
#define ETHD_MATHS_H

#include "ethd/base.h"
#include <math.h>

/* ---- vectors ---- */

/* Vectors of the plane. Frame R_0: x right, y up, origin at the base joint; m, rad, s, N, Nm. */
typedef struct ethd_vec {
  double x, y;
} ethd_vec;

/* No function here changes a unit or a frame: the operands of a sum must have the same unit and frame. */

/* Returns two numbers in memory, x first, as a vector. [any, rt-safe] */
static inline ethd_vec ethd_vec_of(const double v[2]) ETHD_RT {
  ethd_vec r = {v[0], v[1]};
  return r;
}

/* Writes the vector as two numbers, x first. [any, rt-safe] */
static inline void ethd_vec_put(ethd_vec a, double out[2]) ETHD_RT {
  out[0] = a.x;
  out[1] = a.y;
}

/* Returns a + b. [any, rt-safe] */
static inline ethd_vec ethd_vec_add(ethd_vec a, ethd_vec b) ETHD_RT {
  ethd_vec r = {a.x + b.x, a.y + b.y};
  return r;
}

/* Returns a - b. [any, rt-safe] */
static inline ethd_vec ethd_vec_sub(ethd_vec a, ethd_vec b) ETHD_RT {
  ethd_vec r = {a.x - b.x, a.y - b.y};
  return r;
}

/* Returns s times a. [any, rt-safe] */
static inline ethd_vec ethd_vec_scale(double s, ethd_vec a) ETHD_RT {
  ethd_vec r = {s * a.x, s * a.y};
  return r;
}

/* Returns the scalar product. [any, rt-safe] */
static inline double ethd_vec_dot(ethd_vec a, ethd_vec b) ETHD_RT { return a.x * b.x + a.y * b.y; }

/* Returns the z component of a x b, > 0 where b lies counter-clockwise of a. [any, rt-safe] */
static inline double ethd_vec_cross(ethd_vec a, ethd_vec b) ETHD_RT { return a.x * b.y - a.y * b.x; }

/* Returns the length, >= 0. [any, rt-safe] */
static inline double ethd_vec_norm(ethd_vec a) ETHD_RT { return sqrt(a.x * a.x + a.y * a.y); }

/* ---- vectors of space ---- */

/* A vector of space, in a right-handed frame that its user names; m, rad, s, N. The plane's are x and y. */
typedef struct ethd_vec3 {
  double x, y, z;
} ethd_vec3;

/* Returns three numbers in memory, x first, as a vector. [any, rt-safe] */
static inline ethd_vec3 ethd_vec3_of(const double v[3]) ETHD_RT {
  ethd_vec3 r = {v[0], v[1], v[2]};
  return r;
}

/* Writes the vector as three numbers, x first. [any, rt-safe] */
static inline void ethd_vec3_put(ethd_vec3 a, double out[3]) ETHD_RT {
  out[0] = a.x;
  out[1] = a.y;
  out[2] = a.z;
}

/* Returns a + b. [any, rt-safe] */
static inline ethd_vec3 ethd_vec3_add(ethd_vec3 a, ethd_vec3 b) ETHD_RT {
  ethd_vec3 r = {a.x + b.x, a.y + b.y, a.z + b.z};
  return r;
}

/* Returns a - b. [any, rt-safe] */
static inline ethd_vec3 ethd_vec3_sub(ethd_vec3 a, ethd_vec3 b) ETHD_RT {
  ethd_vec3 r = {a.x - b.x, a.y - b.y, a.z - b.z};
  return r;
}

/* Returns s times a. [any, rt-safe] */
static inline ethd_vec3 ethd_vec3_scale(double s, ethd_vec3 a) ETHD_RT {
  ethd_vec3 r = {s * a.x, s * a.y, s * a.z};
  return r;
}

/* Returns the scalar product. [any, rt-safe] */
static inline double ethd_vec3_dot(ethd_vec3 a, ethd_vec3 b) ETHD_RT { return a.x * b.x + a.y * b.y + a.z * b.z; }

/* Returns a x b. [any, rt-safe] */
static inline ethd_vec3 ethd_vec3_cross(ethd_vec3 a, ethd_vec3 b) ETHD_RT {
  ethd_vec3 r = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  return r;
}

/* Returns the length, >= 0. [any, rt-safe] */
static inline double ethd_vec3_norm(ethd_vec3 a) ETHD_RT { return sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }

/* ---- functions ---- */

/* Elementary functions that give the same bits everywhere.

   A C library chooses its variant of sin or exp by the CPU (with or without FMA), so the same seed would give other
   bits on another machine. These functions use only + - * / and integers in a fixed order, and give equal bits for
   every compiler and CPU with IEEE 754 doubles, as long as they are built without contraction or value-changing
   optimisation (-ffp-contract=off, never -ffast-math).

   Common to all: angles in rad; NaN in, NaN out, always the same NaN; round to nearest is assumed; errno is never set
   and no floating-point flag is promised, but no argument causes an invalid operation, a division by zero or an
   overflow, for which an application may have set traps (feenableexcept). With FTZ and DAZ set, as on the control
   thread, subnormal arguments count as zeros and subnormal results may be zeros; all other results stay the same. ulp:
   a unit in the last place of the exact result. The bounds were measured at 6e8 points against 80-bit long double. */

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
