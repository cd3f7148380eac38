/* What of the virtual world is near the end effector: points of surfaces, handed to the controller by whoever knows the
   world. Links from libethd.

          X        n        P = point      n.(P - X): distance along n, < 0 behind the surface
          o ------------->|/////////
                          P  object        */
#ifndef ETHD_SURFACE_H
#define ETHD_SURFACE_H

#include <stdint.h>

#include "ethd/maths.h"

ETHD_BEGIN_DECLS

/* A point at which an object is nearest to X: a local minimum of the distance. Frame: R_0. */
typedef struct ethd_surface {
  ethd_vec3 point;  /* m */
  ethd_vec3 n;      /* unit vector into the object, also when X is inside */
  ethd_vec3 v;      /* m/s, of the object at the point */
  int32_t id;       /* of the object; the same from tick to tick */
  int32_t material; /* index, -1: none */
} ethd_surface;

#define ETHD_SURFACES_MAX 64 /* in one tick */

ETHD_END_DECLS

#endif
