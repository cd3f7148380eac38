/* The filters behind ethd_filter_update. */
#ifndef ETHD__ESTIMATE_FILTER_METHODS_H
#define ETHD__ESTIMATE_FILTER_METHODS_H

#include <stdbool.h>

#include "ethd/estimate.h"

/* Rows of the filters' tables; those that several filters share come first. */
enum { FILTER_REFERENCE, FILTER_COMPENSATION, FILTER_LATENCY, FILTER_COMMON };
enum { ALPHA_BETA_ALPHA = FILTER_COMMON, ALPHA_BETA_BETA };
enum { FILTER_NOISE = FILTER_COMMON, FILTER_GATE, FILTER_DRIVE, FILTER_MEMORY };

static inline bool ethd__filter_is_kalman(const ethd_filter *f) {
  return f->method == ETHD_FILTER_CV || f->method == ETHD_FILTER_CA;
}

/* The motion within t s: x += v t + a ax, v += a av, a = a aa. An acceleration decays, a' = -a / memory, integrated by
   the trapezoidal rule; for memory = inf it is constant, and ax, av, aa are exactly t^2 / 2, t and 1. */
typedef struct ethd__filter_motion {
  double t, ax, av, aa;
} ethd__filter_motion;

static inline ethd__filter_motion ethd__filter_motion_over(const ethd_filter *f, double t) {
  if (f->method != ETHD_FILTER_CA) return (ethd__filter_motion){.t = t, .ax = t * t / 2, .av = t, .aa = 1};
  double z = t / f->p[FILTER_MEMORY] / 2, av = t / (1 + z);
  return (ethd__filter_motion){.t = t, .ax = t * av / 2, .av = av, .aa = (1 - z) / (1 + z)};
}

/* Carries the covariance over t s and adds the process noise. [rt] */
void ethd__filter_spread(const ethd_filter *f, ethd_filter_state *s, ethd__filter_motion w) ETHD_RT;

/* Correct the covariance for a reading of position or velocity with a known noise, m or m/s, and give the gains of x, v
   and a. square: squared length of its innovation; false: it is over `gate` standard deviations, and nothing changes.
   [rt] */
bool ethd__filter_gains(ethd_filter_state *s, double square, double noise, double gate, double k[3]) ETHD_RT;
bool ethd__filter_v_gains(ethd_filter_state *s, double square, double noise, double gate, double k[3]) ETHD_RT;

/* ethd_filter_update for readings whose noise differs from one to the next: sd of each axis, m; 0: the filter's
   parameter. Filters of fixed gains ignore it. [rt] */
ethd_status ethd__filter_update(const ethd_filter *filter, ethd_filter_state *state, ethd_vec x, double age,
                                double noise) ETHD_RT;

/* ethd_filter_predict and ethd_filter_output in the library's floating-point mode. [rt] */
void ethd__filter_predict(const ethd_filter *filter, ethd_filter_state *state, double dt) ETHD_RT;
void ethd__filter_output(const ethd_filter *filter, const ethd_filter_state *state, ethd_vec *x, ethd_vec *v) ETHD_RT;

#endif
