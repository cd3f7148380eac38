/* The controller's state: one flat block, so that a tick can run on a copy, and a reset is one memset. */
#ifndef ETHD__CONTROL_STATE_H
#define ETHD__CONTROL_STATE_H

#include "control/plan.h"
#include "core/state.h"

/* A body's frame in R_0 and its motion, in the layout of the sense's six numbers of a body. */
typedef struct ethd__body_pose {
  ethd_vec x;   /* origin, m */
  double angle; /* rad */
  ethd_vec v;   /* m/s */
  double rate;  /* rad/s */
} ethd__body_pose;

/* A place, and the known distance of the ring to it. */
typedef struct ethd__place {
  ethd__body_pose pose; /* zero for the scene that stands still */
  ethd_vec at;          /* the ring's centre in the place's frame when the clearance was last found */
  double clearance;     /* distance from there to the nearest object, m; negative: not known */
  ethd_scene_hint hint;
  bool there; /* false: a body that has no pose yet */
} ethd__place;

#define ETHD__HISTORY 32 /* ticks of ring positions, for readings that are late */

typedef struct ethd__state {
  ethd__core core;
  ethd__place places[ETHD__PLACES];
  ethd_guard_state guard;
  int64_t blind; /* periods since the last tick with a possible measurement */
  /* estimates */
  ethd_velocity_state velocity[2];
  int64_t velocity_ns; /* instant of their last sample */
  double age[2];       /* s: age of each joint's sample at that instant */
  ethd_filter_state filter;
  int64_t reading_ns;   /* stamp of the reading that was used last */
  double reading_age;   /* s: how old it was when it was used */
  double finger_radius; /* of the last fit, NaN: none */
  double absent;        /* 0 to 1: how far tracking has faded because the finger isn't seen */
  int64_t implausible;  /* readings in a row */
  struct {
    int64_t time_ns;
    ethd_vec x;
  } history[ETHD__HISTORY];
  uint64_t remembered; /* number of positions ever stored there; a tick without measurement adds none */
} ethd__state;

#endif
