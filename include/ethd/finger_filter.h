/* The finger at 1 kHz from readings at 300 Hz: position and velocity per axis.

   Every tick predicts; a reading corrects at the tick at which it has arrived. With compensation =
   stamp the state stands at the last reading's sample instant and the output is extrapolated from
   there to now; with none a reading counts as if it had been taken now. */
#ifndef ETHD_FINGER_FILTER_H
#define ETHD_FINGER_FILTER_H

#include "ethd/param.h"
#include "ethd/vec.h"

ETHD_BEGIN_DECLS

typedef enum ethd_filter_method {
  ETHD_FILTER_CA = 0,     /* Kalman, constant acceleration */
  ETHD_FILTER_HOLD,       /* the last reading, at rest */
  ETHD_FILTER_ALPHA_BETA, /* fixed gains */
  ETHD_FILTER_CV,         /* Kalman, constant velocity */
  ETHD_FILTER_COUNT
} ethd_filter_method;

ETHD_API extern const ethd_method ethd_filter_methods[ETHD_FILTER_COUNT];

/* Where the ring stood for a reading that is relative to it ([finger_filter] reference). */
enum { ETHD_REFERENCE_SAMPLE = 0, ETHD_REFERENCE_TICK = 1 };

typedef struct ethd_filter {
  ethd_filter_method method;
  double period;
  int reference;
  double p[ETHD_PARAMS_MAX];
  double c[16];
} ethd_filter;

/* Numbers only. Per axis: x, v, a and the upper triangle of the covariance. */
typedef struct ethd_filter_state {
  double m[2][3];
  double cov[6]; /* shared by both axes: xx xv xa vv va aa */
  double age;    /* s, of the state against now */
  double last_stamp_age; /* s, of the last reading used against now */
  uint32_t started;
  uint32_t used, late, gated; /* readings counted */
} ethd_filter_state;

/* [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_filter_prepare(ethd_filter_method method, const double *p,
                                                         double period, ethd_filter *out,
                                                         ethd_error *error);

/* Starts at x with speed v and the method's initial covariance. [rt] */
ETHD_API void ethd_filter_start(const ethd_filter *filter, ethd_filter_state *state, ethd_vec x,
                                ethd_vec v) ETHD_RT;

/* One tick of dt s passes. [rt] */
ETHD_API void ethd_filter_predict(const ethd_filter *filter, ethd_filter_state *state, double dt) ETHD_RT;

/* A reading of the finger's position in R_0, taken `age` s ago. Starts the filter when it hasn't been.
   ETHD_STALE: older than the last one used, or outside of the innovation gate; not used, counted. [rt] */
ETHD_API ethd_status ethd_filter_update(const ethd_filter *filter, ethd_filter_state *state, ethd_vec x,
                                        double age) ETHD_RT;

/* Where the finger is now. [rt] */
ETHD_API void ethd_filter_output(const ethd_filter *filter, const ethd_filter_state *state, ethd_vec *x,
                                 ethd_vec *v) ETHD_RT;

ETHD_END_DECLS

#endif
