#include "bounds/motion.h"

#include <math.h>
#include <string.h>

/* The force is the last coordinate, which is constant. */
enum { FORCE = ETHD_MOTION_STATE, SIZE };

typedef double square[SIZE][SIZE];

static void multiply(square a, square b, square out) {
  for (int i = 0; i < SIZE; i++)
    for (int j = 0; j < SIZE; j++) {
      out[i][j] = 0;
      for (int k = 0; k < SIZE; k++) out[i][j] += a[i][k] * b[k][j];
    }
}

/* Writes the equations times `span`, in units that make the entries pure numbers: speeds in metres per span, forces in
   multiples of the one that moves the mass by 1 m. */
static void write_equations(const ethd__sampled_loop *l, double span, square a) {
  bool gives = ethd__sampled_gives_way(l);
  double driven = gives ? l->motor_mass : l->mass, rest = l->mass - l->motor_mass;
  double k = gives ? l->spring * span * span : 0, c = gives ? l->damper * span : 0;
  memset(a, 0, sizeof(square));
  a[ETHD_MOTION_X][ETHD_MOTION_V] = 1;
  a[ETHD_MOTION_V][ETHD_MOTION_V] = -l->viscous * span / driven;
  a[ETHD_MOTION_V][ETHD_MOTION_LEAD] = k / driven;
  a[ETHD_MOTION_V][ETHD_MOTION_LEAD_V] = c / driven;
  a[ETHD_MOTION_V][FORCE] = l->mass / driven;
  if (!gives) return;
  a[ETHD_MOTION_LEAD][ETHD_MOTION_LEAD_V] = 1;
  for (int i = 0; i < SIZE; i++) a[ETHD_MOTION_LEAD_V][i] = -a[ETHD_MOTION_V][i];
  a[ETHD_MOTION_LEAD_V][ETHD_MOTION_LEAD] -= k / rest;
  a[ETHD_MOTION_LEAD_V][ETHD_MOTION_LEAD_V] -= c / rest;
}

static double norm(square a) {
  double most = 0;
  for (int i = 0; i < SIZE; i++) {
    double sum = 0;
    for (int j = 0; j < SIZE; j++) sum += fabs(a[i][j]);
    most = fmax(most, sum);
  }
  return most;
}

#define TERMS 16 /* of the exponential's series: the remainder is below 1e-18 for a norm of 1/2 */

/* Computes the exponential of a by the series for a / 2^n, squared n times (Moler and Van Loan 2003, method 3). */
static void exponential(square a, square out) {
  square term, next;
  int halvings = 0;
  while (ldexp(norm(a), -halvings) > 0.5) halvings++;
  for (int i = 0; i < SIZE; i++)
    for (int j = 0; j < SIZE; j++) {
      a[i][j] = ldexp(a[i][j], -halvings);
      out[i][j] = term[i][j] = i == j;
    }
  for (int n = 1; n <= TERMS; n++) {
    multiply(term, a, next);
    for (int i = 0; i < SIZE; i++)
      for (int j = 0; j < SIZE; j++) out[i][j] += term[i][j] = next[i][j] / n;
  }
  for (; halvings > 0; halvings--) {
    multiply(out, out, next);
    memcpy(out, next, sizeof next);
  }
}

void ethd__bounds_motion_over(const ethd__sampled_loop *loop, double span, ethd__bounds_motion *out) {
  square a, e;
  if (!(span > 0)) {
    *out = (ethd__bounds_motion){{{0}}, {0}};
    for (int i = 0; i < ETHD_MOTION_STATE; i++) out->of_state[i][i] = 1;
    return;
  }
  const double unit[SIZE] = {1, 1 / span, 1, 1 / span, loop->mass / (span * span)};
  write_equations(loop, span, a);
  exponential(a, e);
  for (int i = 0; i < ETHD_MOTION_STATE; i++) {
    for (int j = 0; j < ETHD_MOTION_STATE; j++) out->of_state[i][j] = e[i][j] * unit[i] / unit[j];
    out->of_force[i] = e[i][FORCE] * unit[i] / unit[FORCE];
  }
}

void ethd__bounds_motion_apply(const ethd__bounds_motion *m, double force, double state[ETHD_MOTION_STATE]) {
  double next[ETHD_MOTION_STATE];
  for (int i = 0; i < ETHD_MOTION_STATE; i++) {
    next[i] = m->of_force[i] * force;
    for (int j = 0; j < ETHD_MOTION_STATE; j++) next[i] += m->of_state[i][j] * state[j];
  }
  memcpy(state, next, sizeof next);
}
