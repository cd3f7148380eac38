/* Surfaces of the virtual world near the end effector, which the application gives to the controller, and their
   materials. Links from libethd.

          X        n        P = point      n.(P - X): distance along n, < 0 behind the surface
          o ------------->|/////////
                          P  object        */
#ifndef ETHD_SURFACE_H
#define ETHD_SURFACE_H

#include <stdint.h>

#include "ethd/maths.h"
#include "ethd/param.h"

ETHD_BEGIN_DECLS

#define ETHD_MATERIALS_MAX 32
#define ETHD_NAME_MAX 32 /* bytes of a name, the closing 0 included */

/* A named surface: values that replace parameters of the setup's contact law ("k_e"). */
typedef struct ethd_material {
  char name[ETHD_NAME_MAX];
  uint32_t count;
  int32_t line; /* where it was defined, 0 without text */
  struct {
    char name[ETHD_NAME_MAX];
    double value;
  } values[ETHD_PARAMS_MAX];
} ethd_material;

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
