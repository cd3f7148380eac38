/* A simulated cap for the fingertip: a half sphere with rays to its centre, whose distances are measured with noise. */
#ifndef ETHD_TESTS_CAP_RIG_H
#define ETHD_TESTS_CAP_RIG_H

#include "ethd/cap.h"

typedef struct cap_rig {
  ethd_cap cap;
  ethd_vec3 axis; /* from the rim to the top */
  double noise;   /* m: sd of a distance */
  uint64_t drawn;
} cap_rig;

/* A cap of this inner radius, m, for fingers of finger_radius, with 32 rays, `rim` m from its centre against the axis. */
cap_rig cap_rig_of(double radius, double finger_radius, ethd_vec3 axis, double rim);

/* Measures a finger whose centre is at `finger` from the cap's centre, and fits it. */
ethd_status cap_rig_read(cap_rig *rig, ethd_vec3 finger, ethd_cap_finger *out);

#endif
