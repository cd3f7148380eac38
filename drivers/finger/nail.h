/* A thin plate that the finger's nail pushes, and one optical distance to it: where the finger's centre is along one
   direction. Across it nothing is measured; the finger is taken for centred, as the plate's guide holds it.

        (sensor) <--- distance ---> |plate( finger )      centre = (rest - distance) u
                                                          u: from the ring's centre toward the sensor

   The sensor of the hand exoskeletons of Nakagawara et al. (2005) and Fang et al. (2009). */
#ifndef ETHD__FINGER_NAIL_H
#define ETHD__FINGER_NAIL_H

#include <math.h>
#include <stdbool.h>

#include "ethd/vec.h"

typedef struct ethd__nail {
  ethd_vec u;
  double rest;     /* m: the distance when the finger is centred */
  double furthest; /* m: what is read beyond it is no plate */
} ethd__nail;

/* False: out of range, NaN included. [rt] */
static inline bool ethd__nail_centre(const ethd__nail *nail, double distance, ethd_vec *centre) ETHD_RT {
  if (!(distance >= 0 && distance <= nail->furthest)) return false;
  *centre = ethd_vec_scale(nail->rest - distance, nail->u);
  return true;
}

/* The distance that a finger at `centre` gives. [any, rt-safe] */
static inline double ethd__nail_distance(const ethd__nail *nail, ethd_vec centre) ETHD_RT {
  return nail->rest - ethd_vec_dot(nail->u, centre);
}

#endif
