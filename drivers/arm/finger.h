/* A hand in space, and the headset that sees it: a planar path (sim.h) laid into a plane through a wall's normal, read at
   a rate, late, with noise and a bias. All [any, rt-safe].

        path's x           wall                 P = meet - x n + y across
     <-----|---------------|/////  n -->        meet: the finger's centre as it touches the wall, path's (0, 0) */
#ifndef ETHD__ARM_FINGER_H
#define ETHD__ARM_FINGER_H

#include "ethd/sim.h"
#include "ethd/space.h"

typedef struct ethd__arm_finger {
  ethd_path path;
  ethd_path rise;          /* if it has samples: its y is the way along `up`, at the times of the path's */
  double begin;            /* s: the instant of the path's t = 0 */
  ethd_vec3 meet;          /* m */
  ethd_vec3 n, across, up; /* unit vectors at right angles */
  double rate;             /* Hz; 0: nobody sees it */
  double latency;          /* s, >= 0, from a reading's instant to its arrival */
  double noise;            /* m, sd of each axis */
  double bias;             /* m along n */
  uint64_t seed, tap;      /* on which the noise depends */
  int64_t given;           /* readings that have arrived */
} ethd__arm_finger;

/* Returns a finger at a wall whose normal, of any length above 0, is n, with nobody who sees it and no path: it rests at
   `meet`. Across it moves horizontally; z is up, and so, as far as n lets it, is `up`. */
ethd__arm_finger ethd__arm_finger_at(ethd_vec3 meet, ethd_vec3 n) ETHD_RT;

/* Gives the true place, m, and velocity, m/s, at t, s. */
void ethd__arm_finger_true(const ethd__arm_finger *finger, double t, ethd_vec3 *x, ethd_vec3 *v) ETHD_RT;

/* Adds the newest reading that has arrived by `time_ns` and wasn't given before. */
void ethd__arm_finger_read(ethd__arm_finger *finger, int64_t time_ns, ethd_space_sense *out) ETHD_RT;

#endif
