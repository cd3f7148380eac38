#include "fp_mode.h"
#include "scene/shapes.h"
#include "scene/tree.h"

void ethd_scene_describe(const ethd_scene *scene, ethd_scene_info *out) {
  *out = (ethd_scene_info){.objects = scene->object_count,
                           .materials = scene->material_count,
                           .dropped = scene->dropped,
                           .boxes = ETHD__WIDE * (size_t)scene->node_count,
                           .bytes = scene->bytes,
                           .x_min = scene->x_min,
                           .x_max = scene->x_max,
                           .y_min = scene->y_min,
                           .y_max = scene->y_max};
  for (uint32_t i = 0; i < scene->object_count; i++) {
    const ethd__object *o = ethd__object_at(scene, i);
    out->by_shape[o->shape]++;
    out->segments += o->edges;
  }
}

/* Returns the largest distance of an object's points from the base joint: no point of a hull is farther than its
   discs. */
static double farthest(const ethd_scene *scene, const ethd__object *o) {
  const ethd__shape *s = &ethd__shapes[o->shape];
  const double *kept = ethd__numbers(scene, o);
  size_t discs = ethd__disc_count(o);
  double most = discs ? 0 : INFINITY;
  for (size_t k = 0; k < discs; k++) {
    ethd__disc d = ethd__disc_at(s, kept, k);
    most = fmax(most, ethd_vec_norm(d.centre) + d.radius);
  }
  return most;
}

/* An object is in one piece, so if its nearest point lies within the outer circle and its farthest beyond the inner
   one, a part of it lies between the two. No point lies beyond a circle that is NaN. */
bool ethd__object_is_within(const ethd_scene *scene, const ethd__object *o, double inner, double outer) {
  ethd_touch nearest;
  ethd__object_nearest(scene, o, (ethd_vec){0, 0}, &nearest);
  return !(nearest.distance > outer) && !(farthest(scene, o) < inner);
}

void ethd__scene_annulus(const ethd_arm *arm, double radius, double *inner, double *outer) {
  ethd_arm_reach(arm, inner, outer);
  *inner -= radius;
  *outer += radius;
}

ETHD__FP_APART static size_t out_of_reach(const ethd_scene *scene, const ethd_arm *arm, double radius) {
  double inner, outer;
  size_t count = 0;
  ethd__scene_annulus(arm, radius, &inner, &outer);
  for (uint32_t i = 0; i < scene->object_count; i++)
    count += !ethd__object_is_within(scene, ethd__object_at(scene, i), inner, outer);
  return count;
}

size_t ethd_scene_out_of_reach(const ethd_scene *scene, const ethd_arm *arm, double radius) {
  ETHD__FP_RETURN(size_t, out_of_reach(scene, arm, radius));
}

/* ---- its contents ---- */

static size_t given_count(const ethd__object *o) {
  const ethd__shape *s = &ethd__shapes[o->shape];
  return o->edges ? 2 * (o->edges + (s->is_closed ? 0 : (size_t)1)) : s->form.count;
}

int32_t ethd_scene_object(const ethd_scene *scene, size_t i, ethd_object_def *out) {
  if (i >= scene->object_count) return -1;
  const ethd__object *o = ethd__object_at(scene, ETHD__ARRAY(scene, uint32_t, places_at)[i]);
  *out = (ethd_object_def){(ethd_shape)o->shape, o->material, ethd__numbers(scene, o), given_count(o), 0};
  return o->id;
}

/* ---- its trees ---- */

/* Finds the tree of a node by bisection: trees are in the order of their nodes. */
static const ethd__tree *tree_of(const ethd_scene *scene, uint32_t node) {
  const ethd__tree *trees = ETHD__ARRAY(scene, ethd__tree, trees_at);
  uint32_t low = 0, high = scene->tree_count;
  if (scene->tree.levels && node >= scene->tree.first[1]) return &scene->tree;
  while (high - low > 1) {
    uint32_t middle = low + (high - low) / 2;
    *(trees[middle].first[1] <= node ? &low : &high) = middle;
  }
  return &trees[low];
}

ethd_status ethd_scene_box_at(const ethd_scene *scene, size_t i, ethd_scene_box *out) {
  uint32_t node = (uint32_t)(i / ETHD__WIDE), lane = (uint32_t)(i % ETHD__WIDE), level = 1;
  if (i / ETHD__WIDE >= scene->node_count) return ETHD_STATUS_EMPTY;
  const ethd__node *n = ETHD__ARRAY(scene, ethd__node, nodes_at) + node;
  const ethd__tree *tree = tree_of(scene, node);
  double c = (double)n->c[lane], s = (double)n->s[lane], u = (double)n->u[lane], v = (double)n->v[lane],
         k = 1 / scene->scale;
  if (!isfinite(u)) return ETHD_STATUS_EMPTY;
  while (level < tree->levels && node >= tree->first[level + 1]) level++;
  *out = (ethd_scene_box){{scene->centre.x + k * (c * u - s * v), scene->centre.y + k * (s * u + c * v)},
                          c,
                          s,
                          k * (double)n->w[lane],
                          k * (double)n->h[lane],
                          (int32_t)level,
                          tree != &scene->tree};
  return ETHD_OK;
}

const ethd_material *ethd_scene_material(const ethd_scene *scene, size_t i) {
  return i < scene->material_count ? ETHD__ARRAY(scene, ethd_material, materials_at) + i : NULL;
}
