/* A scene in memory: one block without pointers, every array found by its offset.

     objects    shape, material and first number of each; in the order of the tree's leaves, endless ones last
     places     of the objects, in the order of their ids
     numbers    the given ones of each object, and those that its shape's row (shapes.h) adds; for a polygon the
                points, with the first one again at the end
     trees      of the chains with a tree of their own (tree.h)
     nodes      of those trees, then of the tree of all objects
     slopes     one for each box of a chain's tree */
#ifndef ETHD__SCENE_SCENE_H
#define ETHD__SCENE_SCENE_H

#include <stdbool.h>

#include "ethd/scene.h"

#define ETHD__TINY 1e-140 /* m: squares of smaller lengths lose digits */

typedef struct ethd__object {
  int32_t id; /* its number in the file */
  int32_t material;
  uint32_t first; /* its numbers start here */
  uint32_t edges; /* of a chain; 0: a closed form */
  uint32_t tree;  /* index of a chain's own tree */
  int8_t shape;
  int8_t turn; /* polygon: +1 counter-clockwise, -1 clockwise; thin walls: 0 */
  bool closed; /* the chain's last point is its first */
} ethd__object;

#define ETHD__LEVELS 12 /* 8^11 leaves are more than are possible */

/* The nodes of level l start at first[l]; see tree.h. */
typedef struct ethd__tree {
  uint32_t leaves, levels;
  uint32_t first[ETHD__LEVELS];
} ethd__tree;

struct ethd_scene {
  ethd_vec centre; /* the trees' frame: X = scale (x - centre), scale a power of two */
  double scale;
  double slack; /* bound on the rounding error of a distance, m */
  size_t nodes_at, objects_at, numbers_at, trees_at, places_at, slopes_at, materials_at;
  ethd__tree tree;
  uint32_t object_count, number_count, tree_count, node_count, material_count;
  uint32_t dropped;    /* objects left out because an arm can't reach them */
  double inner, outer; /* m: no object between these distances from the base is left out */
  size_t bytes;
  double x_min, x_max, y_min, y_max; /* extent of all but endless objects; min > max: there are none */
};

#define ETHD__ARRAY(scene, type, at) ((const type *)(const void *)((const char *)(scene) + (scene)->at))

/* Returns the object at `place`, its index in the order of the leaves. */
static inline const ethd__object *ethd__object_at(const ethd_scene *scene, uint32_t place) {
  return ETHD__ARRAY(scene, ethd__object, objects_at) + place;
}

static inline const double *ethd__numbers(const ethd_scene *scene, const ethd__object *o) {
  return ETHD__ARRAY(scene, double, numbers_at) + o->first;
}

/* A run of edges. */
typedef struct ethd__chain {
  const double *points; /* {x, y} of edges + 1 points */
  size_t edges;
  int turn;
  bool closed;
  double slack; /* the scene's */
} ethd__chain;

static inline ethd__chain ethd__chain_of(const ethd_scene *scene, const ethd__object *o) {
  ethd__chain chain = {ethd__numbers(scene, o), o->edges, o->turn, o->closed, scene->slack};
  return chain;
}

static inline ethd_vec ethd__chain_point(const ethd__chain *chain, size_t k) {
  return ethd_vec_of(chain->points + 2 * k);
}

/* Finds the nearest point of a chain; a polygon's distance is signed. Sets distance, point, n and feature; `side` is
   then undefined. */
void ethd__chain_nearest(const ethd__chain *chain, ethd_vec x, ethd_touch *out) ETHD_RT;

/* Does the same when edge k is known to be nearest and, for a polygon, whether x is inside. */
void ethd__chain_touch(const ethd__chain *chain, size_t k, ethd_vec x, bool inside, ethd_touch *out) ETHD_RT;

/* Finds the first local minimum of the distance at edge `from` or later; vertex k comes before edge k. Returns the edge
   at which to continue, 0 if there is no minimum. x is outside of a polygon; only its surfaces that face x count. */
size_t ethd__chain_minimum(const ethd__chain *chain, ethd_vec x, size_t from, ethd_touch *out) ETHD_RT;

/* Returns true if edge k, or vertex k before it, has a local minimum; k = edges is the chain's end. x is passed by its
   address because gcc 12 stores a pair in two halves, then loads it whole and waits for both. */
bool ethd__chain_minimum_at(const ethd__chain *chain, size_t k, const ethd_vec *x, ethd_touch *out) ETHD_RT;

/* Returns true if the ray from x to the right crosses the edge from a to b; exact. */
bool ethd__edge_crossed(ethd_vec a, ethd_vec b, ethd_vec x) ETHD_RT;

/* Sets the fields that all touches of this object share: its number and material, and 0 for the feature and the side if
   the contract says so. */
static inline void ethd__label(const ethd__object *o, ethd_touch *out) {
  out->object = o->id;
  out->material = o->material;
  if (o->shape == ETHD_SHAPE_SEGMENT) out->feature = 0;
  if (o->turn) out->side = 0;
}

/* Finds the nearest point of an object, by its closed form or edge by edge. The touch is complete except for a chain's
   side. */
void ethd__object_nearest(const ethd_scene *scene, const ethd__object *o, ethd_vec x, ethd_touch *out) ETHD_RT;

/* Builds a scene from a checked definition. `ids`: the objects' numbers, rising; NULL: 0, 1, ... [main] */
ethd_status ethd__scene_make(const ethd_scene_def *def, const int32_t *ids, ethd_scene **out, ethd_error *error);

/* Gives the distances from the base between which this arm can meet objects, m. */
void ethd__scene_annulus(const ethd_arm *arm, double radius, double *inner, double *outer);

/* Returns true if a part of the object lies between these distances from the base. */
bool ethd__object_is_within(const ethd_scene *scene, const ethd__object *o, double inner, double outer);

/* Returns the turn from a over b to c: +1 counter-clockwise, -1 clockwise, 0 on a line; exact. */
int ethd__orient(ethd_vec a, ethd_vec b, ethd_vec c) ETHD_RT;

#endif
