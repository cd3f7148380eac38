/* A tap for the controller: what a device would sense while finger and ring tap a wall at x = 0.238 m
   once every 1.024 s, and scenes to tap on. */
#ifndef ETHD_APPS_BENCH_TAP_TRACK_H
#define ETHD_APPS_BENCH_TAP_TRACK_H

#include "ethd/ethd.h"

enum { ETHD__TAP_TICKS = 1024 }; /* the last leads on to the first */

/* How the finger is known. */
typedef enum ethd__tap_finger {
  ETHD__TAP_KNOWN,   /* position and velocity, and joint speeds: no estimator works */
  ETHD__TAP_ENCODER, /* the same without joint speeds */
  ETHD__TAP_CENTRE,  /* readings of the centre at 300 Hz, 2 ms late */
  ETHD__TAP_RAYS,    /* frames of 16 rays at 300 Hz, 2 ms late */
} ethd__tap_finger;

void ethd__tap_senses(const ethd_setup *setup, ethd__tap_finger how, ethd_sense senses[ETHD__TAP_TICKS]);

/* What to tap on: segments < 0 nothing (NULL), 0 a half-plane, else a closed wavy outline about the
   arm's workspace of so many segments, which the ring meets at the same place. */
ethd_scene *ethd__tap_scene(long segments);

/* A controller with default values but for the transition law and the scene. */
ethd_control *ethd__tap_control(const ethd_transition_law *law, const ethd_scene *scene);

#endif
