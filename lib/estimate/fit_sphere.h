/* Normal equations of a sphere's fit. */
#ifndef ETHD__ESTIMATE_FIT_SPHERE_H
#define ETHD__ESTIMATE_FIT_SPHERE_H

#include <stdbool.h>

#include "ethd/cap.h"

/* sum g g^T s = sum e g of n unknowns: the centre's three, and the radius. Above the diagonal `h` is not used. */
typedef struct ethd__normal {
  double h[4][4], b[4];
  int n;
} ethd__normal;

/* Adds a row g with its residual e. [any, rt-safe] */
void ethd__normal_add(ethd__normal *m, const double g[4], double e) ETHD_RT;

/* Factorises h = L D L^T in place; false: a pivot is too small, so the rows don't determine the unknowns.
   [any, rt-safe] */
bool ethd__normal_factorise(ethd__normal *m) ETHD_RT;

#endif
