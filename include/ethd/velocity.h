/* Joint speed from encoder positions, one estimator per joint.

   Lag against noise decides what a controller survives: control-law.md's table, ethd-check's bounds. */
#ifndef ETHD_VELOCITY_H
#define ETHD_VELOCITY_H

#include "ethd/param.h"

ETHD_BEGIN_DECLS

typedef enum ethd_velocity_method {
  ETHD_VELOCITY_LOWPASS = 0, /* first-order low-pass of the difference */
  ETHD_VELOCITY_DIFFERENCE,
  ETHD_VELOCITY_LSQ,    /* slope of the least-squares line over a window */
  ETHD_VELOCITY_FOAW,   /* first-order adaptive windowing (Janabi-Sharifi, Hayward and Chen 2000) */
  ETHD_VELOCITY_KALMAN, /* position and speed, the commanded torque as known input */
  ETHD_VELOCITY_COUNT
} ethd_velocity_method;

/* id, brief and parameters of each, by ethd_velocity_method. */
ETHD_API extern const ethd_method ethd_velocity_methods[ETHD_VELOCITY_COUNT];

#define ETHD_VELOCITY_WINDOW_MAX 32 /* samples that lsq and foaw may look back at */

/* A checked estimator with its coefficients worked out. Plain value. */
typedef struct ethd_velocity {
  ethd_velocity_method method;
  double period;
  double p[ETHD_PARAMS_MAX]; /* as posted */
  double c[8];               /* worked out from p and period */
} ethd_velocity;

/* State of one joint: numbers only. */
typedef struct ethd_velocity_state {
  double q[ETHD_VELOCITY_WINDOW_MAX]; /* last positions, a ring */
  double t[ETHD_VELOCITY_WINDOW_MAX]; /* and their times, s since reset */
  double now;
  double speed;
  double k[6]; /* kalman: position, speed, covariance (3), spare */
  uint32_t count, head;
} ethd_velocity_state;

/* Checks p against the method's table and the period (> 0, finite), works out the coefficients. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_velocity_prepare(ethd_velocity_method method, const double *p,
                                                           double period, ethd_velocity *out,
                                                           ethd_error *error);

/* Next speed, rad/s. q: rad; torque: the joint's last commanded torque, Nm (kalman only); dt: s since
   the last step, a whole number of periods when ticks were missed. After a zeroed state the first call
   gives 0 (no difference yet); a state with count = 0 but speed set starts from that speed. [rt] */
ETHD_API double ethd_velocity_step(const ethd_velocity *velocity, ethd_velocity_state *state, double q,
                                   double torque, double dt) ETHD_RT;

ETHD_END_DECLS

#endif
