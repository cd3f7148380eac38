/* Solids in memory: one block, which all pointers point into. Those with bounds come first, half-spaces last. */
#ifndef ETHD__SOLIDS_SOLIDS_H
#define ETHD__SOLIDS_SOLIDS_H

#include "ethd/solids.h"
#include "scene/form.h"

/* A box along the axes: |p - centre| <= half in each of them. */
typedef struct ethd__bounds {
  ethd_vec3 centre, half;
} ethd__bounds;

/* The nearest point of a solid's surface. */
typedef struct ethd__foot {
  double distance;
  ethd_vec3 point, n;
} ethd__foot;

/* The properties of a shape: one row of a table. */
typedef struct ethd__solid_shape {
  ethd__form form;
  size_t kept; /* kept numbers of one solid */

  /* Checks relations that the range of one number can't express; NULL: there are none. The error has no line. [main] */
  ethd_status (*check)(const double *given, ethd_error *error);
  /* Writes the kept numbers. [main] */
  void (*keep)(const double *given, size_t count, double *kept);
  /* Returns the bounds; NULL: it has none. [main] */
  ethd__bounds (*bounds)(const double *kept);
  void (*nearest)(const double *kept, ethd_vec3 x, ethd__foot *out) ETHD_RT;
} ethd__solid_shape;

#define ETHD__SOLID_SHAPES 4

extern const ethd__solid_shape ethd__solid_shapes[ETHD__SOLID_SHAPES];

typedef struct ethd__solid {
  size_t first; /* its numbers start here */
  int32_t id, material;
  uint32_t shape;
} ethd__solid;

struct ethd_solids {
  const ethd__bounds *bounds; /* of each solid that has some, wider than rounding errors */
  const ethd__solid *solids;
  const double *numbers;
  const ethd_material *materials;
  size_t bounded, count, material_count, bytes;
  ethd_vec3 min, max; /* extent of those with bounds */
  ethd__bounds all;   /* of those with bounds */
};

#endif
