/* A scene in memory: one block without pointers, every array found by its offset.

     objects    what each is and where its data starts
     boxes      bounds of each object, half-planes unbounded: first rejection
     numbers    halfplane {nx, ny, c}, circle {x, y, r}, capsule {x1, y1, x2, y2, r},
                box {x, y, half_w, half_h, cos, sin}
     points     chains: edge k of an object runs from point first + k to first + k + 1; closed ones
                repeat their first point */
#ifndef ETHD_LIB_SCENE_H
#define ETHD_LIB_SCENE_H

#include <stdbool.h>

#include "ethd/scene.h"

#define ETHD__COORDINATE_MAX 1e6 /* m */
#define ETHD__TINY 1e-140        /* m: the square of anything less may lose digits */

typedef struct ethd__object {
  int32_t shape;
  int32_t material;
  uint32_t first; /* number, or point */
  uint32_t edges; /* of a chain, else 0 */
  int32_t turn;   /* polygon: +1 counter-clockwise, -1 clockwise; thin walls: 0 */
  int32_t closed; /* chain: the last point is the first */
} ethd__object;

struct ethd_scene {
  size_t object_count, number_count, point_count, material_count;
  size_t bytes;
  size_t objects_at, x_min_at, x_max_at, y_min_at, y_max_at, numbers_at, x_at, y_at, materials_at;
  double slack; /* m: what rounding may do to a distance, and more */
};

#define ETHD__ARRAY(scene, type, at) ((const type *)(const void *)((const char *)(scene) + (scene)->at))

static inline const ethd__object *ethd__objects(const ethd_scene *scene) {
  return ETHD__ARRAY(scene, ethd__object, objects_at);
}

static inline const double *ethd__numbers(const ethd_scene *scene, size_t object) {
  return ETHD__ARRAY(scene, double, numbers_at) + ethd__objects(scene)[object].first;
}

/* Distance from x to an object's bounds, 0 inside of them. */
static inline double ethd__box_distance(const ethd_scene *scene, size_t object, ethd_vec x) {
  double left = ETHD__ARRAY(scene, double, x_min_at)[object] - x.x;
  double right = x.x - ETHD__ARRAY(scene, double, x_max_at)[object];
  double below = ETHD__ARRAY(scene, double, y_min_at)[object] - x.y;
  double above = x.y - ETHD__ARRAY(scene, double, y_max_at)[object];
  double dx = left > right ? left : right, dy = below > above ? below : above;
  dx = dx > 0 ? dx : 0;
  dy = dy > 0 ? dy : 0;
  return sqrt(dx * dx + dy * dy);
}

/* A run of edges. */
typedef struct ethd__chain {
  const double *x, *y; /* edges + 1 points */
  size_t edges;
  int turn;
  bool closed;
  double slack; /* the scene's */
} ethd__chain;

static inline bool ethd__is_chain(ethd_shape shape) {
  return shape == ETHD_POLYGON || shape == ETHD_SEGMENT || shape == ETHD_POLYLINE;
}

ethd__chain ethd__chain_of(const ethd_scene *scene, size_t object) ETHD_RT;

/* The nearest point of a chain; of a polygon the distance is signed, `side` means nothing. Sets distance,
   point, n, feature, side. */
void ethd__chain_nearest(const ethd__chain *chain, ethd_vec x, ethd_touch *out) ETHD_RT;

/* The first local minimum of the distance at edge `from` or later, vertex k standing before edge k; the
   place to go on from, 0 when there is none. Of a polygon only surfaces that face x, which stands
   outside. */
size_t ethd__chain_minimum(const ethd__chain *chain, ethd_vec x, size_t from, ethd_touch *out) ETHD_RT;

/* What a touch of this object has whatever its place: object, material, and no feature and side where the
   contract has none. */
static inline void ethd__label(const ethd_scene *scene, size_t object, ethd_touch *out) {
  const ethd__object *o = &ethd__objects(scene)[object];
  out->object = (int32_t)object;
  out->material = o->material;
  if (o->shape == ETHD_SEGMENT) out->feature = 0;
  if (o->turn) out->side = 0;
}

/* The nearest point of any object: a complete touch. */
void ethd__object_nearest(const ethd_scene *scene, size_t object, ethd_vec x, ethd_touch *out) ETHD_RT;

/* Sign of the area of a, b, c, exactly: +1 counter-clockwise, -1 clockwise, 0 on a line. */
int ethd__orient(ethd_vec a, ethd_vec b, ethd_vec c) ETHD_RT;

#endif
