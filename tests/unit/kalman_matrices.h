/* The Kalman filters of one axis as matrices in long double. */
#ifndef ETHD_TESTS_KALMAN_MATRICES_H
#define ETHD_TESTS_KALMAN_MATRICES_H

#include <check.h>
#include <math.h>
#include <string.h>

#include "ethd/estimate.h"

typedef long double matrix[3][3];

typedef struct reference {
  int n; /* 2: cv, 3: ca */
  long double noise, drive, memory;
  long double x[3];
  matrix p;
} reference;

static inline void ref_move(reference *r, long double t) {
  long double z = r->n == 3 ? t / (2 * r->memory) : 0, fade = (1 - z) / (1 + z), av = t / (1 + z);
  matrix f = {{1, t, t * av / 2}, {0, 1, av}, {0, 0, fade}}, fp = {{0}}, out = {{0}};
  long double g3[3] = {t * t * t / 6, t * t / 2, t}, g2[3] = {t * t / 2, t, 0}, *g = r->n == 3 ? g3 : g2, x[3] = {0};
  for (int i = 0; i < r->n; i++)
    for (int j = 0; j < r->n; j++) {
      x[i] += f[i][j] * r->x[j];
      for (int k = 0; k < r->n; k++) fp[i][j] += f[i][k] * r->p[k][j];
    }
  for (int i = 0; i < r->n; i++)
    for (int j = 0; j < r->n; j++) {
      for (int k = 0; k < r->n; k++) out[i][j] += fp[i][k] * f[j][k];
      out[i][j] += r->drive * r->drive * g[i] * g[j];
    }
  memcpy(r->x, x, sizeof x);
  memcpy(r->p, out, sizeof out);
}

/* A reading z of the state `o`: 0 is the position, 1 the velocity. */
static inline void ref_correct(reference *r, int o, long double z, long double noise) {
  long double s = r->p[o][o] + noise * noise, gain[3], top[3], innovation = z - r->x[o];
  for (int i = 0; i < r->n; i++) gain[i] = r->p[i][o] / s, top[i] = r->p[o][i];
  for (int i = 0; i < r->n; i++) {
    r->x[i] += gain[i] * innovation;
    for (int j = 0; j < r->n; j++) r->p[i][j] -= gain[i] * top[j];
  }
}

/* Of one axis. */
static inline void ref_equal(const reference *r, const ethd_filter_state *s, int axis) {
  const int at[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  const double state[3] = {s->x[axis], s->v[axis], s->a[axis]}, size[3] = {1, 10, 100};
  for (int i = 0; i < r->n; i++) {
    ck_assert_double_le(fabs((double)(state[i] - r->x[i])), 1e-12 * size[i]);
    for (int j = 0; j < r->n; j++) {
      double scale = sqrt((double)(r->p[i][i] * r->p[j][j]));
      ck_assert_double_le(fabs((double)(s->cov[at[i][j]] - r->p[i][j])), 1e-9 * scale);
    }
  }
}

#endif
