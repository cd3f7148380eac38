/* Queries of a chain that use its tree. */
#ifndef ETHD__SCENE_STRIP_H
#define ETHD__SCENE_STRIP_H

#include "scene/tree.h"

/* A chain with a tree, and the query's point x. */
typedef struct ethd__strip {
  const ethd_scene *scene;
  const ethd__object *object;
  const ethd__probe *probe; /* of x */
  ethd_vec x;
} ethd__strip;

/* The edge nearest to x, the first if several are equally near; ETHD__NONE: none is within the limit. */
typedef struct ethd__nearest_edge {
  double squared; /* of the distance, m2 */
  uint32_t edge;
  bool inside; /* x is inside the polygon; only if requested */
} ethd__nearest_edge;

/* Finds the nearest among the edges nearer than the root of `limit` (m2). `first`: an edge that is likely to be near;
   ETHD__NONE: none is known. */
void ethd__strip_nearest(const ethd__strip *strip, uint32_t first, double limit, ethd__nearest_edge *out) ETHD_RT;

/* Finds the nearest edge of a polygon, at any distance, and whether x is inside. */
void ethd__strip_signed(const ethd__strip *strip, uint32_t first, ethd__nearest_edge *out) ETHD_RT;

/* The local minima of the distance from x to the chain whose points lie within `bound` of a centre, in no order. A box
   is left out if the distance from x only rises or only falls along all of its edges: then no edge of it, and no vertex
   between them, is a local minimum (Johnson and Cohen 2001). */
typedef struct ethd__minima {
  ethd__chain chain;
  const ethd__tree *tree;
  ethd__probe at_x, at_centre;
  ethd_vec x;
  float bound; /* see ethd__bound; may shrink between two calls of ethd__minima_next */
  const float *slopes;
  bool apart; /* x and the centre differ */
  bool end;   /* the end of an open chain is still to come */
  int count;
  struct {
    uint32_t level, index;
  } stack[(ETHD__WIDE - 1) * ETHD__LEVELS + 1];
} ethd__minima;

/* Starts without a bound. `at_centre`: the centre's probe, or strip->probe itself if x is the centre. */
void ethd__minima_start(ethd__minima *m, const ethd__strip *strip, const ethd__probe *at_centre) ETHD_RT;

/* Gives the next local minimum; returns false if there are no more. */
bool ethd__minima_next(ethd__minima *m, ethd_touch *out) ETHD_RT;

#endif
