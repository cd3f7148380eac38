/* The motion as a power series in time. Terms follow from one another, so a step has any order. */
#ifndef ETHD_SIM_SERIES_H
#define ETHD_SIM_SERIES_H

#include "sim/body.h"

enum { ETHD__ORDER_MAX = 14, ETHD__TERMS = ETHD__ORDER_MAX + 2 };

/* Term k belongs to (t' - t)^k. Speeds have terms 0 to order, positions one more. */
typedef struct ethd__series {
  int order;
  double step; /* s: how long it holds to the tolerance */
  int watched; /* order of those below; 0: pad and ring stay apart */
  ethd__two link[ETHD__TERMS], link_v[ETHD__TERMS];
  ethd__two motor[ETHD__TERMS], motor_v[ETHD__TERMS];
  ethd__two aside[ETHD__TERMS], aside_v[ETHD__TERMS]; /* of the finger from its path */
  ethd__two hand[ETHD__TERMS];
  double beyond[ETHD__TERMS];  /* apart: distance^2 - gap^2; touching: p */
  double leaving[ETHD__TERMS]; /* touching: 1 + c p_dot */
} ethd__series;

/* The motion from this state on, for `step` or as much of it as the tolerance allows. */
void ethd__series_expand(const ethd__body *body, const ethd__piece *piece, double t, double step,
                         const ethd__state *state, ethd__series *out) ETHD_RT;

#endif
