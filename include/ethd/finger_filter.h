/* The finger at 1 kHz from readings at 300 Hz: position and velocity per axis. Links from libethd.

   Every tick predicts; a reading corrects at the tick at which it has arrived.

     compensation = stamp   the state is that of the last reading's sample instant, `latency` before its
                            stamp; the next reading moves it on to its own instant; the output is
                            extrapolated from the state to now. A lost frame only makes that interval longer
     compensation = none    the state is that of now and moves on with every tick; a reading counts as if
                            it had been taken now

   Both axes have the same noise, so they share the covariance. */
#ifndef ETHD_FINGER_FILTER_H
#define ETHD_FINGER_FILTER_H

#include "ethd/param.h"
#include "ethd/vec.h"

ETHD_BEGIN_DECLS

typedef enum ethd_filter_method {
  ETHD_FILTER_CA = 0,     /* Kalman, constant acceleration: Q = jerk^2 g g^T, g = (T^3/6, T^2/2, T) for
                             each step of T s, a tick's (none) or a reading's (stamp). The acceleration
                             fades with the time constant `memory` (Singer 1970); inf: it doesn't */
  ETHD_FILTER_HOLD,       /* the last reading, at rest */
  ETHD_FILTER_ALPHA_BETA, /* fixed gains: x += alpha r, v += beta r / (time since the last reading) */
  ETHD_FILTER_CV,         /* Kalman, constant velocity: Q = acceleration^2 g g^T, g = (T^2/2, T) */
  ETHD_FILTER_COUNT
} ethd_filter_method;

ETHD_API extern const ethd_method ethd_filter_methods[ETHD_FILTER_COUNT];

/* Which of the ring's positions a relative reading is added to ([finger_filter] reference): the one at the sample's
   instant, or that of the tick. */
enum { ETHD_REFERENCE_SAMPLE = 0, ETHD_REFERENCE_TICK = 1 };

/* [finger_filter] compensation. */
enum { ETHD_COMPENSATION_STAMP = 0, ETHD_COMPENSATION_NONE = 1 };

/* A checked filter. Plain value. */
typedef struct ethd_filter {
  ethd_filter_method method;
  int reference, compensation;
  int reserved;
  double period;
  double p[ETHD_PARAMS_MAX]; /* as posted */
} ethd_filter;

/* State of the filter: numbers only. Zeroed: not started. */
typedef struct ethd_filter_state {
  double x[2], v[2], a[2]; /* m, m/s, m/s^2 */
  double cov[6];           /* of one axis: xx xv xa vv va aa */
  double age;              /* s from the last used reading's stamp to now. After a start: -latency (stamp: so that
                              older readings are late), inf (none) */
  uint32_t started;
  uint32_t used, late, gated, restarts; /* readings counted */
  uint32_t gated_in_a_row;
} ethd_filter_state;

#define ETHD_FILTER_GATED_MAX 5

/* Checks p against the method's table, and the period (1e-6 to 1 s): ETHD_E_RANGE, ETHD_E_NOT_FINITE or,
   for the method, ETHD_E_UNKNOWN, with the name; out is untouched then. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_filter_prepare(ethd_filter_method method, const double *p, double period,
                                                         ethd_filter *out, ethd_error *error);

/* Starts the filter now at x, m, with velocity v, m/s, both in R_0, and the covariance diag(1e-6 m^2, 1e-4 m^2/s^2, 1
   m^2/s^4). Counters stay. [rt] */
ETHD_API void ethd_filter_start(const ethd_filter *filter, ethd_filter_state *state, ethd_vec x, ethd_vec v) ETHD_RT;

/* Lets dt s pass. [rt] */
ETHD_API void ethd_filter_predict(const ethd_filter *filter, ethd_filter_state *state, double dt) ETHD_RT;

/* Takes a reading of the finger's position, m in R_0, stamped `age` s ago. A filter that isn't started starts there, at
   rest, with standard deviations of 1 m/s and 10 m/s^2. ETHD_STALE: the reading is counted but not used, because it is
   not newer than the last used one (late), not finite, or over `gate` standard deviations from where it was expected,
   by the innovation of both axes together against sqrt(P_xx + noise^2) (gated). The ETHD_FILTER_GATED_MAX-th gated
   reading in a row starts the filter anew, since then the filter is wrong, not the readings. [rt] */
ETHD_API ethd_status ethd_filter_update(const ethd_filter *filter, ethd_filter_state *state, ethd_vec x,
                                        double age) ETHD_RT;

/* Gives where the finger is now, m, and its velocity, m/s, in R_0. [rt] */
ETHD_API void ethd_filter_output(const ethd_filter *filter, const ethd_filter_state *state, ethd_vec *x,
                                 ethd_vec *v) ETHD_RT;

ETHD_END_DECLS

#endif
