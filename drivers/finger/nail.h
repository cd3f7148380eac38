/* The finger's nail pushes a thin plate, and an optical sensor measures the distance to it. The distance gives the
   position of the finger's centre along one direction. Across that direction there is no measurement; the finger counts
   as centred, since the plate's guide holds it.

        (sensor) <--- distance ---> |plate( finger )      centre = (rest - distance) u
                                                          u: from the ring's centre toward the sensor

   The sensor of the hand exoskeletons of Nakagawara et al. (2005) and Fang et al. (2009). */
#ifndef ETHD__FINGER_NAIL_H
#define ETHD__FINGER_NAIL_H

#include <math.h>
#include <stdbool.h>

#include "ethd/maths.h"

typedef struct ethd__nail {
  ethd_vec u;
  double rest;     /* m: the distance when the finger is centred */
  double furthest; /* m: a larger distance isn't to the plate */
} ethd__nail;

/* Fills the finger's centre. False: the distance is out of range, or NaN. [rt] */
static inline bool ethd__nail_centre(const ethd__nail *nail, double distance, ethd_vec *centre) ETHD_RT {
  if (!(distance >= 0 && distance <= nail->furthest)) return false;
  *centre = ethd_vec_scale(nail->rest - distance, nail->u);
  return true;
}

/* Returns the distance that a finger at `centre` gives. [any, rt-safe] */
static inline double ethd__nail_distance(const ethd__nail *nail, ethd_vec centre) ETHD_RT {
  return nail->rest - ethd_vec_dot(nail->u, centre);
}

#endif
