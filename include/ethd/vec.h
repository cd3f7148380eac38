/* Vectors of the plane. Frame R_0: x right, y up, origin at the base joint; m, rad, s, N, Nm. Links from libethd. */
#ifndef ETHD_VEC_H
#define ETHD_VEC_H

#include <math.h>

#include "ethd/attributes.h"

typedef struct ethd_vec {
  double x, y;
} ethd_vec;

/* None of these changes a unit or a frame: vectors that are added have the same. */

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

#endif
