/* The properties of each shape: one row of a table. No other code in lib depends on a shape by name.

   A closed form (half-plane, circle ...) has a fixed count of numbers and a function for its nearest point. A chain
   (polygon, segment, polyline) is a list of points; chain.c works for all of them. */
#ifndef ETHD__SCENE_SHAPES_H
#define ETHD__SCENE_SHAPES_H

#include "scene/form.h"
#include "scene/scene.h"

#define ETHD__KEPT_MAX 7 /* the most numbers that a scene keeps of a closed form */

typedef struct ethd__disc {
  ethd_vec centre;
  double radius;
} ethd__disc;

typedef struct ethd__shape {
  ethd__form form;
  bool is_chain;
  bool is_closed; /* the chain is closed by an edge to its first point and bounds a solid */

  /* The following fields belong to closed forms. `kept` numbers are the given ones and those that `keep` adds. */

  /* Checks relations that the range of one number can't express; NULL: there are none. [main] */
  ethd_status (*check)(const ethd_object_def *def, ethd_error *error);
  /* Converts a copy of the given numbers into the kept ones; NULL: the copy is kept as it is. [main] */
  void (*keep)(double *kept);
  size_t added; /* numbers that `keep` appends to the given ones */
  /* The convex hull of the discs contains the object. It should fit closely, since bounds and reach are the hull's. 0
     discs: the object is endless, and in no tree. [main] */
  size_t discs;
  ethd__disc (*disc)(const double *kept, size_t k);
  /* Sets distance, point and n of the nearest point of the surface. */
  void (*nearest)(const double *kept, ethd_vec x, ethd_touch *out) ETHD_RT;
} ethd__shape;

extern const ethd__shape ethd__shapes[ETHD_SHAPE_COUNT];

/* Returns the number of kept numbers of an object: polygons repeat their first point. */
static inline size_t ethd__kept_count(const ethd_object_def *o) {
  const ethd__shape *s = &ethd__shapes[o->shape];
  return o->count + (s->is_closed ? 2 : s->added);
}

/* Writes the kept numbers, ethd__kept_count of them. [main] */
void ethd__keep(const ethd_object_def *o, double *kept);

static inline size_t ethd__disc_count(const ethd__object *o) {
  return o->edges ? o->edges + (size_t)1 : ethd__shapes[o->shape].discs;
}

/* Returns disc k of an object; a chain's discs are its points. */
static inline ethd__disc ethd__disc_at(const ethd__shape *s, const double *kept, size_t k) {
  if (s->is_chain) return (ethd__disc){{kept[2 * k], kept[2 * k + 1]}, 0};
  return s->disc(kept, k);
}

#endif
