/* A scene in memory: one block without pointers, every array found by its offset.

     objects    what each is and where its numbers are; in the order of the tree's leaves, endless ones last
     places     of the objects, in the order of their ids
     numbers    as the object was given, and what its shape's row (shapes.h) adds; of a polygon the points, the
                first of them once more at the end
     trees      of the chains with a tree of their own (tree.h)
     nodes      of those, then of the tree of all objects
     slopes     one for each box of a chain's tree */
#ifndef ETHD_LIB_SCENE_H
#define ETHD_LIB_SCENE_H

#include <stdbool.h>

#include "ethd/scene.h"

#define ETHD__COORDINATE_MAX 1e6 /* m */
#define ETHD__TINY 1e-140        /* m: the square of anything less may lose digits */

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

#define ETHD__LEVELS 12 /* 8^11 leaves are more than there can be */

/* Level l's nodes start at first[l]. */
typedef struct ethd__tree {
  uint32_t leaves, levels;
  uint32_t first[ETHD__LEVELS];
} ethd__tree;

struct ethd_scene {
  ethd_vec centre; /* the trees' frame: X = scale (x - centre), scale a power of two */
  double scale;
  double slack; /* m: what rounding may do to a distance, and more */
  size_t nodes_at, objects_at, numbers_at, trees_at, places_at, slopes_at, materials_at;
  ethd__tree tree;
  uint32_t object_count, number_count, tree_count, node_count, material_count;
  uint32_t dropped;    /* objects that aren't here, for an arm can't reach them */
  double inner, outer; /* m from the base: between them nothing is missing */
  size_t bytes;
  double x_min, x_max, y_min, y_max; /* of all but half-planes; min > max: nothing */
};

#define ETHD__ARRAY(scene, type, at) ((const type *)(const void *)((const char *)(scene) + (scene)->at))

/* An object is meant by its place. */
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

/* The nearest point of a chain; of a polygon the distance is signed. Sets distance, point, n, feature;
   `side` means nothing. */
void ethd__chain_nearest(const ethd__chain *chain, ethd_vec x, ethd_touch *out) ETHD_RT;

/* The same when edge k is known to be the nearest, and, of a polygon, whether x is inside. */
void ethd__chain_touch(const ethd__chain *chain, size_t k, ethd_vec x, bool inside, ethd_touch *out) ETHD_RT;

/* The first local minimum of the distance at edge `from` or later, vertex k standing before edge k; the
   place to go on from, 0 when there is none. Of a polygon only surfaces that face x, which stands
   outside. */
size_t ethd__chain_minimum(const ethd__chain *chain, ethd_vec x, size_t from, ethd_touch *out) ETHD_RT;

/* The one at edge k or at vertex k before it; k = edges: at the end. x comes by its address: gcc 12 stores a
   pair in two halves, loads it whole and waits. */
bool ethd__chain_minimum_at(const ethd__chain *chain, size_t k, const ethd_vec *x, ethd_touch *out) ETHD_RT;

/* Whether an edge is crossed by the ray from x to the right, exactly. */
bool ethd__edge_crossed(ethd_vec a, ethd_vec b, ethd_vec x) ETHD_RT;

/* What a touch of this object has whatever its place: object, material, and no feature and side where the
   contract has none. */
static inline void ethd__label(const ethd__object *o, ethd_touch *out) {
  out->object = o->id;
  out->material = o->material;
  if (o->shape == ETHD_SEGMENT) out->feature = 0;
  if (o->turn) out->side = 0;
}

/* The nearest point of an object, by its closed form or edge by edge: a complete touch but for a chain's
   side. */
void ethd__object_nearest(const ethd_scene *scene, const ethd__object *o, ethd_vec x, ethd_touch *out) ETHD_RT;

/* Builds from what is known to be right. ids: their numbers, rising; NULL: 0, 1, ... [main] */
ethd_status ethd__scene_make(const ethd_scene_def *def, const int32_t *ids, ethd_scene **out, ethd_error *error);

/* Where things count for this arm, m from the base. */
void ethd__scene_annulus(const ethd_arm *arm, double radius, double *inner, double *outer);
bool ethd__object_is_within(const ethd_scene *scene, const ethd__object *o, double inner, double outer);

/* Sign of the area of a, b, c, exactly: +1 counter-clockwise, -1 clockwise, 0 on a line. */
int ethd__orient(ethd_vec a, ethd_vec b, ethd_vec c) ETHD_RT;

#endif
