/* The estimators behind ethd_velocity_step. */
#ifndef ETHD__ESTIMATE_VELOCITY_METHODS_H
#define ETHD__ESTIMATE_VELOCITY_METHODS_H

#include "ethd/estimate.h"

/* Rows of the methods' tables; the last are kalman's. */
enum { LOWPASS_CUTOFF };
enum { LSQ_WINDOW };
enum { FOAW_WINDOW, FOAW_NOISE };
enum { VELOCITY_NOISE, VELOCITY_ACCELERATION, VELOCITY_INERTIA };

/* Returns the index of the i-th sample before the newest, i < count. */
static inline uint32_t ethd__velocity_back(const ethd_velocity_state *s, uint32_t i) {
  return (s->head - i) & (ETHD_VELOCITY_WINDOW_MAX - 1);
}

/* Returns a = 1 - exp(-2 pi cutoff dt). [any, rt-safe] */
double ethd__velocity_gain(double cutoff, double dt) ETHD_RT;

/* Each returns the speed once the newest sample is in the ring; count >= 2, for kalman >= 1. [rt] */
double ethd__velocity_lsq(const ethd_velocity *v, const ethd_velocity_state *s) ETHD_RT;
double ethd__velocity_foaw(const ethd_velocity *v, const ethd_velocity_state *s) ETHD_RT;
double ethd__velocity_kalman(const ethd_velocity *v, ethd_velocity_state *s, double torque) ETHD_RT;

/* ethd_velocity_step in the library's floating-point mode. [rt] */
double ethd__velocity_step(const ethd_velocity *v, ethd_velocity_state *s, double q, double torque, double dt) ETHD_RT;

#endif
