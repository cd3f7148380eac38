/* Joint speed from encoder positions, one estimator per joint. Links from libethd.

   Less noise costs more lag, and both bound the gains that stay stable: ethd-check prints these bounds. */
#ifndef ETHD_VELOCITY_H
#define ETHD_VELOCITY_H

#include "ethd/param.h"

ETHD_BEGIN_DECLS

typedef enum ethd_velocity_method {
  ETHD_VELOCITY_LOWPASS = 0, /* first-order low-pass of the difference: qd += a (raw - qd) with
                                a = 1 - exp(-2 pi cutoff dt), raw = (q - q_prev) / dt */
  ETHD_VELOCITY_DIFFERENCE,  /* raw */
  ETHD_VELOCITY_LSQ,         /* slope of the least-squares line through the last `window` samples */
  ETHD_VELOCITY_FOAW,        /* the same over a window that grows, up to `window`, while the line through
                                its end points passes within `noise` of every sample between:
                                first-order adaptive windowing (Janabi-Sharifi, Hayward and Chen 2000),
                                window by their end fit, slope by their best fit */
  ETHD_VELOCITY_KALMAN,      /* position and speed; known input torque / inertia, unknown one constant
                                within a tick, `acceleration` rms */
  ETHD_VELOCITY_COUNT
} ethd_velocity_method;

/* id, brief and parameters of each, by ethd_velocity_method. */
ETHD_API extern const ethd_method ethd_velocity_methods[ETHD_VELOCITY_COUNT];

#define ETHD_VELOCITY_WINDOW_MAX 32 /* samples, the newest included */

/* A checked estimator with its coefficients worked out. Plain value. */
typedef struct ethd_velocity {
  ethd_velocity_method method;
  uint32_t window; /* lsq, foaw: samples; else 0 */
  double period;
  double gain;               /* lowpass: a at dt = period; else 0 */
  double p[ETHD_PARAMS_MAX]; /* as posted */
} ethd_velocity;

/* State of one joint: numbers only. Zeroed: nothing known. */
typedef struct ethd_velocity_state {
  double q[ETHD_VELOCITY_WINDOW_MAX];  /* rad: last positions, a ring */
  double dt[ETHD_VELOCITY_WINDOW_MAX]; /* s: from the previous sample to each */
  double speed;                        /* rad/s: the last result */
  double position, cov[3];             /* kalman: rad; rad^2, rad^2/s, rad^2/s^2 */
  uint32_t count, head;                /* samples held, the newest's index */
} ethd_velocity_state;

/* Checks p against the method's table, and the period (1e-6 to 1 s), and works out the coefficients: ETHD_E_RANGE,
   ETHD_E_NOT_FINITE or, for the method, ETHD_E_UNKNOWN, with the name; out is untouched then. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_velocity_prepare(ethd_velocity_method method, const double *p, double period,
                                                           ethd_velocity *out, ethd_error *error);

/* Returns the next speed, rad/s. q: rad; torque: the joint's last commanded torque, Nm (kalman only); dt > 0: s
   since the last step, a whole number of periods when ticks were missed. After a zeroed state the first
   call gives 0 (no difference yet); a state with count = 0 but speed set starts from that speed. Errors don't
   accumulate over time, but a number that isn't finite stays until the state is zeroed. [rt] */
ETHD_API double ethd_velocity_step(const ethd_velocity *velocity, ethd_velocity_state *state, double q, double torque,
                                   double dt) ETHD_RT;

/* Returns by how much the speed lags under slow constant acceleration (kalman: all of it unknown), s:
   difference T/2, lowpass T/2 + T (1 - a) / a, lsq and, at its longest, foaw (window - 1) T/2. [any] */
ETHD_API double ethd_velocity_lag(const ethd_velocity *velocity);

ETHD_END_DECLS

#endif
