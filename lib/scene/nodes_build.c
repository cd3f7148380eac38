#include <float.h>

#include "scene/build.h"
#include "scene/shapes.h"

typedef struct build {
  ethd_scene *scene;
  ethd__node *nodes;
  float *slopes;
  ethd_vec *points; /* centres of the discs that span the objects, in the order of the leaves */
  double *radii;
  size_t *start; /* the object at place i has the discs from start[i] on */
} build;

static size_t disc_count(const ethd_scene *s) {
  size_t count = 0;
  for (uint32_t i = 0; i < s->tree.leaves; i++) count += ethd__disc_count(ethd__object_at(s, i));
  return count;
}

size_t ethd__nodes_room(const ethd_scene *s) {
  return disc_count(s) * (sizeof(ethd_vec) + sizeof(double)) + (s->object_count + (size_t)1) * sizeof(size_t);
}

/* ---- the discs of the objects ---- */

static size_t put_object(build *b, size_t n, const ethd__object *o) {
  const ethd_scene *s = b->scene;
  const ethd__shape *shape = &ethd__shapes[o->shape];
  const double *kept = ethd__numbers(s, o);
  size_t discs = ethd__disc_count(o);
  for (size_t k = 0; k < discs; k++, n++) {
    ethd__disc d = ethd__disc_at(shape, kept, k);
    b->points[n] = ethd_vec_scale(s->scale, ethd_vec_sub(d.centre, s->centre));
    b->radii[n] = s->scale * d.radius;
  }
  return n;
}

/* ---- the tree of the scene ---- */

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

static void build_tree(build *b, const ethd__tree *tree) {
  ethd__cloud cloud = {b->points, b->radii};
  for (uint32_t level = 1; level <= tree->levels; level++) {
    size_t step = (size_t)1 << 3 * (level - 1), lanes = (tree->leaves + step - 1) / step;
    for (size_t i = 0; i < (lanes + ETHD__WIDE - 1) / ETHD__WIDE * ETHD__WIDE; i++) {
      ethd__node *node = &b->nodes[tree->first[level] + i / ETHD__WIDE];
      if (i < lanes)
        ethd__box_fit(&cloud, b->start[i * step], b->start[least((i + 1) * step, tree->leaves)], node, i % ETHD__WIDE);
      else
        ethd__box_clear(node, i % ETHD__WIDE);
    }
  }
}

/* ---- the tree of a chain ---- */

typedef struct strip {
  const ethd_vec *points;
  size_t edges;
  bool closed;
} strip;

/* Returns |across| / along of edge k against the axis, INFINITY if it has the opposite direction. */
static double slope_of(const strip *t, size_t k, ethd_vec axis) {
  ethd_vec e = ethd_vec_sub(t->points[k + 1], t->points[k]);
  double along = ethd_vec_dot(axis, e);
  return along > 0 ? fabs(ethd_vec_cross(axis, e)) / along : INFINITY;
}

/* The position of x across the axis is exact to 2^-20 of its distance; a steeper slope would multiply that error by too
   much. */
#define STEEPEST 8

/* Returns the steepest slope of edges [from, to) against the box's axis (c, s), and of one more edge on each side, on
   which the vertices at both ends depend. It is FLT_MAX, which excludes no box, if that slope can't be used and at the
   ends of an open chain. */
static float steepest(const strip *t, size_t from, size_t to, float c, float s) {
  if (!t->closed && (from == 0 || to == t->edges)) return FLT_MAX;
  ethd_vec axis = {c, s};
  if (ethd_vec_dot(axis, ethd_vec_sub(t->points[to], t->points[from])) < 0) axis = ethd_vec_scale(-1, axis);
  double before = slope_of(t, from ? from - 1 : t->edges - 1, axis), most = slope_of(t, to % t->edges, axis);
  most = fmax(most, before);
  for (size_t k = from; k < to && most < INFINITY; k++) most = fmax(most, slope_of(t, k, axis));
  most = most * ETHD__STRETCH_FAR + 0x1p-16;
  return most < STEEPEST ? (float)most : FLT_MAX;
}

static void build_strip(build *b, const ethd__object *o, const ethd_vec *points) {
  const ethd__tree *tree = ethd__tree_at(b->scene, o);
  ethd__cloud cloud = {points, NULL};
  strip t = {points, o->edges, o->closed};
  for (uint32_t level = 1; level <= tree->levels; level++) {
    size_t step = (size_t)1 << 3 * (level - 1), lanes = (t.edges + step - 1) / step;
    for (size_t i = 0; i < (lanes + ETHD__WIDE - 1) / ETHD__WIDE * ETHD__WIDE; i++) {
      size_t from = i * step, to = least(from + step, t.edges), place = tree->first[level] + i / ETHD__WIDE;
      ethd__node *node = &b->nodes[place];
      size_t lane = i % ETHD__WIDE;
      if (i < lanes) {
        ethd__box_fit(&cloud, from, to + 1, node, lane);
        b->slopes[ETHD__WIDE * place + lane] = steepest(&t, from, to, node->c[lane], node->s[lane]);
      } else {
        ethd__box_clear(node, lane);
      }
    }
  }
}

void ethd__nodes_build(ethd_scene *s, void *room) {
  build b = {s, (void *)((char *)s + s->nodes_at), (void *)((char *)s + s->slopes_at), room, NULL, NULL};
  size_t discs = disc_count(s);
  b.radii = (double *)(b.points + discs);
  b.start = (size_t *)(b.radii + discs);
  b.start[0] = 0;
  for (uint32_t i = 0; i < s->tree.leaves; i++) {
    const ethd__object *o = ethd__object_at(s, i);
    size_t next = put_object(&b, b.start[i], o);
    b.start[i + 1] = next;
    if (ethd__has_tree(o)) build_strip(&b, o, b.points + b.start[i]);
  }
  build_tree(&b, &s->tree);
}
