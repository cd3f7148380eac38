/* Finds the finger's centre in a ring of on-off light barriers from the set of lit ones.

        .-1-.       Barrier k looks from the ring's inner circle at angle 2 pi k / n (x axis = 0,
       2 (o) 0      counter-clockwise) to its centre, and is lit while the finger's surface is nearer than
        `-3-'       `reach` along its ray.

   A finger of known radius lights a run of neighbours: their middle gives the direction of the centre, and their number
   the distance. Between two changes there is no information, so each number of lit barriers has its own error. This is
   the sensor of Yoshikawa and Nagura (1997, 1999), whose optical fibres are only on or off. */
#ifndef ETHD__FINGER_ZONES_H
#define ETHD__FINGER_ZONES_H

#include <stdbool.h>
#include <stdint.h>

#include "ethd/maths.h"

enum { ETHD__ZONES_MIN = 8, ETHD__ZONES_MAX = 16 };

typedef struct ethd__zones {
  uint32_t count;
  double ring_radius, reach; /* m */
  ethd_vec ray[ETHD__ZONES_MAX];
  /* for each number of lit barriers: the centre's distance towards their middle, and the standard deviation in each
     axis, m; NaN: no finger lights this number */
  double offset[ETHD__ZONES_MAX + 1], noise[ETHD__ZONES_MAX + 1];
} ethd__zones;

/* Computes the table, for equally likely centres of a finger within the ring. `switching`, m, is the standard deviation
   of the distance at which a barrier switches. [main] */
void ethd__zones_prepare(uint32_t count, double reach, double ring_radius, double finger_radius, double switching,
                         ethd__zones *out);

/* Returns the distance from the ring to the finger's surface along ray k, m; INFINITY: the ray misses it. [rt] */
double ethd__zones_distance(const ethd__zones *zones, double finger_radius, ethd_vec centre, uint32_t k) ETHD_RT;

/* Fills centre and noise; bit k of `lit` says that barrier k is lit. False if a barrier fails: the lit ones aren't
   neighbours, or are more than a finger can light. [rt] */
bool ethd__zones_centre(const ethd__zones *zones, uint32_t lit, ethd_vec *centre, double *noise) ETHD_RT;

#endif
