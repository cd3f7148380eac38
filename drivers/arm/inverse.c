#include "arm/inverse.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#define EPSILON 0x1p-52
#define NOTHING 1e-26 /* of the largest s^2: smaller values are rounding errors */

static double dot(const double *a, const double *b, uint32_t count) {
  double sum = 0;
  for (uint32_t i = 0; i < count; i++) sum += a[i] * b[i];
  return sum;
}

static void turn(double *a, double *b, uint32_t count, double sine, double cosine) {
  for (uint32_t i = 0; i < count; i++) {
    const double was = a[i];
    a[i] = cosine * was - sine * b[i];
    b[i] = sine * was + cosine * b[i];
  }
}

/* Rotates two rows until they are orthogonal; returns whether they already were. */
static bool part(ethd__inverse *o, uint32_t k, uint32_t l, double least) {
  const double a = dot(o->sv[k], o->sv[k], o->count), b = dot(o->sv[l], o->sv[l], o->count);
  const double both = dot(o->sv[k], o->sv[l], o->count);
  if (!(a > least && b > least) || both * both <= EPSILON * EPSILON * a * b) return true;
  const double zeta = (b - a) / (2 * both);
  const double tangent = copysign(1, zeta) / (fabs(zeta) + sqrt(1 + zeta * zeta));
  const double cosine = 1 / sqrt(1 + tangent * tangent), sine = cosine * tangent;
  turn(o->sv[k], o->sv[l], o->count, sine, cosine);
  turn(o->u[k], o->u[l], o->rows, sine, cosine);
  return false;
}

void ethd__inverse_make(double (*j)[ETHD_JOINTS_MAX], uint32_t rows, uint32_t count, double singular,
                        ethd__inverse *out) {
  double sum = 0;
  *out = (ethd__inverse){.rows = rows, .count = count, .singular = singular};
  for (uint32_t k = 0; k < rows; k++) {
    memcpy(out->sv[k], j[k], count * sizeof **j);
    out->u[k][k] = 1;
    sum += dot(j[k], j[k], count);
  }
  const double least = NOTHING * sum;
  bool apart = false;
  for (int sweep = 0; sweep < ETHD__INVERSE_SWEEPS && !apart; sweep++) {
    apart = true;
    for (uint32_t k = 0; k < rows; k++)
      for (uint32_t l = k + 1; l < rows; l++) apart &= part(out, k, l, least);
  }
  for (uint32_t k = 0; k < rows; k++) {
    const double square = dot(out->sv[k], out->sv[k], count);
    out->square[k] = square > least ? square : 0;
  }
}

static void add(double *to, double share, const double *v, uint32_t count) {
  for (uint32_t i = 0; i < count; i++) to[i] += share * v[i];
}

void ethd__inverse_solve(const ethd__inverse *inverse, const double *task, double *dq) {
  const double least = inverse->singular * inverse->singular;
  memset(dq, 0, inverse->count * sizeof *dq);
  for (uint32_t k = 0; k < inverse->rows; k++) {
    const double asked = dot(inverse->u[k], task, inverse->rows);
    add(dq, asked / fmax(inverse->square[k], least), inverse->sv[k], inverse->count);
  }
}

void ethd__inverse_free(const ethd__inverse *inverse, double *p) {
  for (uint32_t k = 0; k < inverse->rows; k++)
    if (inverse->square[k] > 0)
      add(p, -dot(inverse->sv[k], p, inverse->count) / inverse->square[k], inverse->sv[k], inverse->count);
}
