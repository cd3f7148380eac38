/* A simulated hand in space, and its headset: a planar path (sim.h) in a plane through a wall's normal. The headset
   reads it at a rate, with latency, noise and bias. All [any, rt-safe].

        path's x           wall                 P = meet - x n + y across
     <-----|---------------|/////  n -->        meet: the finger's centre as it touches the wall, path's (0, 0) */
#ifndef ETHD__ARM_FINGER_H
#define ETHD__ARM_FINGER_H

#include "ethd/sim.h"
#include "ethd/space.h"

typedef struct ethd__arm_finger {
  ethd_path path;
  ethd_path rise;          /* if it has samples: its y is the motion along `up`, at the times of the path's */
  double begin;            /* s: the instant of the path's t = 0 */
  ethd_vec3 meet;          /* m */
  ethd_vec3 n, across, up; /* unit vectors at right angles */
  double rate;             /* Hz; 0: no readings */
  double latency;          /* s, >= 0, from a reading's instant to its arrival */
  double noise;            /* m, sd of each axis */
  double bias;             /* m along n */
  uint64_t seed, tap;      /* keys of the noise */
  int64_t given;           /* readings that have arrived */
} ethd__arm_finger;

/* Returns a finger at a wall with the normal n, of any length above 0, without readings and without a path: it rests at
   `meet`. `across` is horizontal; z is up, and `up` is as near to z as n allows. */
ethd__arm_finger ethd__arm_finger_at(ethd_vec3 meet, ethd_vec3 n) ETHD_RT;

/* Gives the true place, m, and velocity, m/s, at t, s. */
void ethd__arm_finger_true(const ethd__arm_finger *finger, double t, ethd_vec3 *x, ethd_vec3 *v) ETHD_RT;

/* Adds the newest reading that has arrived by `time_ns` and wasn't given before. */
void ethd__arm_finger_read(ethd__arm_finger *finger, int64_t time_ns, ethd_space_sense *out) ETHD_RT;

#endif
