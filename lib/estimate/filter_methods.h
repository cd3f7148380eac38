/* The filters behind ethd_filter_update. */
#ifndef ETHD_LIB_FILTER_METHODS_H
#define ETHD_LIB_FILTER_METHODS_H

#include "ethd/finger_filter.h"

/* Rows of the tables; the common ones come first. */
enum { FILTER_REFERENCE, FILTER_COMPENSATION, FILTER_LATENCY, FILTER_COMMON };
enum { ALPHA_BETA_ALPHA = FILTER_COMMON, ALPHA_BETA_BETA };
enum { KALMAN_NOISE = FILTER_COMMON, KALMAN_GATE, KALMAN_DRIVE, CA_MEMORY };

static inline int ethd__filter_is_kalman(const ethd_filter *f) {
  return f->method == ETHD_FILTER_CV || f->method == ETHD_FILTER_CA;
}

/* What an acceleration a does within t s: x += ax a, v += av a, a = aa a. It fades, a' = -a / memory, by
   the trapezoidal rule: exact for memory = inf, where all that is left is t^2 / 2, t and 1. */
typedef struct ethd__way {
  double t, ax, av, aa;
} ethd__way;

static inline ethd__way ethd__filter_way(const ethd_filter *f, double t) {
  if (f->method != ETHD_FILTER_CA) return (ethd__way){.t = t, .ax = t * t / 2, .av = t, .aa = 1};
  double z = t / f->p[CA_MEMORY] / 2, av = t / (1 + z);
  return (ethd__way){.t = t, .ax = t * av / 2, .av = av, .aa = (1 - z) / (1 + z)};
}

/* Covariance over a way, process noise included. [rt] */
void ethd__filter_spread(const ethd_filter *f, ethd_filter_state *s, ethd__way way) ETHD_RT;

/* Corrects with the innovation r; 0: gated, nothing done. [rt] */
int ethd__filter_correct(const ethd_filter *f, ethd_filter_state *s, ethd_vec r) ETHD_RT;

#endif
