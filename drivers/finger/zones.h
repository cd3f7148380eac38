/* Finds the finger's centre in a ring of on-off light barriers from the set of lit ones.

        .-1-.       Barrier k looks from the ring's inner circle at angle 2 pi k / n (x axis = 0,
       2 (o) 0      counter-clockwise) to its centre, and is lit while the finger's surface is nearer than
        `-3-'       `reach` along its ray.

   A finger of known radius lights a run of neighbours: their middle says in which direction the centre is, and their
   number how far. Between two changes nothing is known, so each number of lit barriers has an error of its own. This is
   the sensor of Yoshikawa and Nagura (1997, 1999), whose optical fibres only say on or off. */
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
  /* for each number of lit barriers: how far the centre is toward their middle, and the standard deviation of that in
     each axis, m; NaN: no finger lights as many */
  double offset[ETHD__ZONES_MAX + 1], noise[ETHD__ZONES_MAX + 1];
} ethd__zones;

/* Works the table out, with every centre at which the finger is within the ring equally likely. `switching`, m, is the
   standard deviation of the distance at which a barrier switches. [main] */
void ethd__zones_prepare(uint32_t count, double reach, double ring_radius, double finger_radius, double switching,
                         ethd__zones *out);

/* Returns how far the finger's surface is from the ring along ray k, m; INFINITY: the ray misses it. [rt] */
double ethd__zones_distance(const ethd__zones *zones, double finger_radius, ethd_vec centre, uint32_t k) ETHD_RT;

/* Fills centre and noise; bit k of `lit` says that barrier k is lit. False if the lit ones aren't neighbours or are
   more than a finger lights, because a barrier fails. [rt] */
bool ethd__zones_centre(const ethd__zones *zones, uint32_t lit, ethd_vec *centre, double *noise) ETHD_RT;

#endif
