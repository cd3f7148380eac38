/* A ring of on-off light barriers: where the finger's centre is, by which of them are lit.

        .-1-.       Barrier k looks from the ring's inner circle at angle 2 pi k / n (x axis = 0, counter-clockwise) to its
       2 (o) 0      centre, and is lit while the finger's surface is nearer than `reach` along its ray. A finger of known
        `-3-'       radius lights a row of neighbours: their middle says in which direction the centre is, their number how
                    far. Between two changes nothing is known, so each number of lit barriers has an error of its own.

   The sensor of Yoshikawa and Nagura (1997, 1999), whose optical fibres only say on or off. */
#ifndef ETHD__FINGER_ZONES_H
#define ETHD__FINGER_ZONES_H

#include <stdbool.h>
#include <stdint.h>

#include "ethd/vec.h"

enum { ETHD__ZONES_MIN = 8, ETHD__ZONES_MAX = 16 };

typedef struct ethd__zones {
  uint32_t count;
  double ring_radius, reach; /* m */
  ethd_vec ray[ETHD__ZONES_MAX];
  /* by how many are lit: how far the centre is toward their middle, and the sd of that, each axis, m; NaN: no such
     number can be */
  double offset[ETHD__ZONES_MAX + 1], noise[ETHD__ZONES_MAX + 1];
} ethd__zones;

/* Works the table out: every centre at which the finger is within the ring is equally likely. `switching`, m: sd of
   the distance at which a barrier switches. [main] */
void ethd__zones_prepare(uint32_t count, double reach, double ring_radius, double finger_radius, double switching,
                         ethd__zones *out);

/* How far the finger's surface is from the ring along ray k, m; INFINITY: the ray passes it. [rt] */
double ethd__zones_distance(const ethd__zones *zones, double finger_radius, ethd_vec centre, uint32_t k) ETHD_RT;

/* Bit k of `lit`: barrier k is lit. False when they aren't neighbours, or so many that no finger lights them: a barrier
   fails. [rt] */
bool ethd__zones_centre(const ethd__zones *zones, uint32_t lit, ethd_vec *centre, double *noise) ETHD_RT;

#endif
