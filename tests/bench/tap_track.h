/* A tap for the controller: what a device would sense while finger and ring tap a wall at x = 0.238 m
   once every 1.024 s, and scenes to tap on. */
#ifndef ETHD_TESTS_BENCH_TAP_TRACK_H
#define ETHD_TESTS_BENCH_TAP_TRACK_H

#include "ethd/ethd.h"

enum { ETHD__TAP_TICKS = 1024 }; /* the first follows the last */

/* How the finger is known. */
typedef enum ethd__tap_finger {
  ETHD__TAP_KNOWN,   /* position, velocity and joint speeds are given: no estimator works */
  ETHD__TAP_ENCODER, /* the same without joint speeds */
  ETHD__TAP_CENTRE,  /* readings of the centre at 300 Hz, 2 ms late */
  ETHD__TAP_RAYS,    /* frames of 16 rays at 300 Hz, 2 ms late */
} ethd__tap_finger;

void ethd__tap_senses(const ethd_setup *setup, ethd__tap_finger how, ethd_sense senses[ETHD__TAP_TICKS]);

/* What to tap on. Outlines are closed and wavy, and surround the finger's path. */
typedef enum ethd__tap_wall {
  ETHD__TAP_NOTHING, /* no scene: NULL */
  ETHD__TAP_PLANE,   /* a half-plane */
  ETHD__TAP_BESIDE,  /* the half-plane, and an outline of `segments` that is near, but never met */
  ETHD__TAP_OUTLINE, /* an outline of `segments` alone, met where the half-plane was */
} ethd__tap_wall;

ethd_scene *ethd__tap_scene(ethd__tap_wall wall, size_t segments);

/* Creates a controller with default values but for the transition law and the scene. */
ethd_control *ethd__tap_control(const ethd_transition_law *law, const ethd_scene *scene);

#endif
