/* Contacts against samples of the boundary. Their order, and which one is followed: test_scene_tree. */
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "scene/shapes.h"
#include "scene_objects.h"
#include "unit/suite.h"

static ethd_vec on_chain(const double *p, size_t n, size_t k, double t) {
  const double *a = p + 2 * (k % n), *b = p + 2 * ((k + 1) % n);
  return (ethd_vec){a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
}

static double apart(ethd_vec a, ethd_vec b) { return hypot(a.x - b.x, a.y - b.y); }

static int is_reported(const ethd_touch *t, size_t n, ethd_vec p, double near) {
  for (size_t i = 0; i < n; i++)
    if (apart(t[i].point, p) <= near) return 1;
  return 0;
}

/* No place of the boundary within `step` of p is nearer to x, but by rounding. */
static int is_minimum(const object *o, const ethd_touch *t, ethd_vec x) {
  const double *p = o->p;
  size_t n = o->count / 2, k = (size_t)t->feature / 2;
  int closed = ethd__shapes[o->shape].is_closed, at_vertex = t->feature % 2;
  if (o->shape == ETHD_SHAPE_SEGMENT) /* has no features */
    for (size_t end = 0; end < 2; end++)
      if (t->point.x == p[2 * end] && t->point.y == p[2 * end + 1]) at_vertex = 1, k = end;
  double d = apart(t->point, x), step = 1e-7;
  for (int i = -1; i <= 1; i += 2) {
    size_t edge = at_vertex && i < 0 ? (k ? k - 1 : n - 1) : k;
    if (!closed && ((at_vertex && i < 0 && k == 0) || edge >= n - 1)) continue;
    ethd_vec a = on_chain(p, n, edge, 0), b = on_chain(p, n, edge, 1);
    double l = apart(a, b);
    ethd_vec q = {t->point.x + i * step * (b.x - a.x) / l, t->point.y + i * step * (b.y - a.y) / l};
    if (apart(q, x) < d - 4 * DBL_EPSILON) return 0;
  }
  return 1;
}

/* Every minimum of samples is reported, every reported one is a minimum. Of a polygon, those count whose
   neighbourhood toward x is free. */
static void check_touches(const object *o, const ethd_scene *scene, ethd_vec x, double range) {
  enum { ROOM = 200, PER_EDGE = 64 };
  static ethd_touch t[ROOM];
  size_t n = o->count / 2;
  int closed = ethd__shapes[o->shape].is_closed;
  size_t found = ethd_scene_touches(scene, x, range, t, ROOM);
  ck_assert_uint_le(found, ROOM);
  for (size_t i = 0; i < found; i++) {
    ck_assert(t[i].distance <= range && (i == 0 || t[i - 1].distance <= t[i].distance));
    ck_assert(fabs(apart(t[i].point, x) - fabs(t[i].distance)) <= 4 * DBL_EPSILON);
    ck_assert(hypot(x.x + t[i].distance * t[i].n.x - t[i].point.x, x.y + t[i].distance * t[i].n.y - t[i].point.y) <=
              2 * SCENE_TIGHT);
    ck_assert_msg(is_minimum(o, &t[i], x), "feature %d is no minimum", t[i].feature);
  }
  if (closed && scene_winding(o->p, n, x.x, x.y)) {
    ck_assert_uint_eq(found, 1);
    ck_assert(t[0].distance < 0);
    return;
  }
  size_t samples = (n - !closed) * PER_EDGE, last = samples - closed;
  for (size_t j = 0; j <= last; j++) {
    ethd_vec here = on_chain(o->p, n, j / PER_EDGE, (double)(j % PER_EDGE) / PER_EDGE);
    if (!closed && j == last) here = on_chain(o->p, n, n - 2, 1);
    size_t i = j ? j - 1 : samples - 1, k = closed ? (j + 1) % samples : j + 1;
    ethd_vec before = on_chain(o->p, n, i / PER_EDGE, (double)(i % PER_EDGE) / PER_EDGE);
    ethd_vec after = on_chain(o->p, n, k / PER_EDGE, (double)(k % PER_EDGE) / PER_EDGE);
    if (!closed && k == last) after = on_chain(o->p, n, n - 2, 1);
    double d = apart(here, x), near = 0;
    if ((closed || j > 0) && apart(before, x) < d) continue;
    if ((closed || j < last) && apart(after, x) < d) continue;
    if (d > range - 1e-9) continue;
    if (closed && scene_winding(o->p, n, here.x + 1e-6 * (x.x - here.x), here.y + 1e-6 * (x.y - here.y))) continue;
    if (closed || j > 0) near = apart(before, here);
    if (closed || j < last) near = fmax(near, apart(after, here));
    ck_assert_msg(is_reported(t, found, here, near), "missed one at %g %g, %g away", here.x, here.y, d);
  }
}

TEST_LOOP(test_touches_of_chains, 0, ETHD_SHAPE_COUNT) {
  enum { SCENES = 300, EACH = 40 };
  ethd_shape shape = (ethd_shape)_i;
  if (!ethd__shapes[shape].is_chain) return;
  scene_seed(500 + (uint64_t)_i);
  for (int s = 0; s < SCENES; s++) {
    object o = scene_random(shape);
    ethd_scene *scene = scene_build(&o, 1);
    for (int i = 0; i < EACH; i++)
      check_touches(&o, scene, (ethd_vec){scene_uniform(-1, 1), scene_uniform(-1, 1)}, i % 2 ? 4 : 0.2);
    ethd_scene_destroy(scene);
  }
}

/* Solids of one smooth or convex surface: the nearest, and nothing else. */
TEST(test_touches_of_convex_solids) {
  ethd_shape shapes[ETHD_SHAPE_COUNT];
  int count = 0;
  for (int k = 0; k < ETHD_SHAPE_COUNT; k++)
    if (!ethd__shapes[k].is_chain) shapes[count++] = (ethd_shape)k;
  ck_assert_int_ge(count, 4);
  scene_seed(600);
  for (int s = 0; s < 1000 * count; s++) {
    object o = scene_random(shapes[s % count]);
    ethd_scene *scene = scene_build(&o, 1);
    ethd_vec x = {scene_uniform(-1, 1), scene_uniform(-1, 1)};
    ethd_nearest q;
    ethd_touch t[2];
    ethd_scene_query(scene, x, &q);
    ck_assert_uint_eq(ethd_scene_touches(scene, x, 4, t, 2), 1);
    ck_assert(t[0].distance == q.distance && t[0].point.x == q.point.x && t[0].n.y == q.n.y);
    ck_assert(t[0].object == 0 && t[0].feature == 0 && t[0].side == 0 && t[0].material == -1);
    ck_assert_uint_eq(ethd_scene_touches(scene, x, q.distance, t, 2), 1);
    ck_assert_uint_eq(ethd_scene_touches(scene, x, nextafter(q.distance, -9), t, 2), 0);
    ck_assert_uint_eq(ethd_scene_touches(scene, x, NAN, t, 2), 0);
    ethd_scene_destroy(scene);
  }
}

TEST(test_channel_and_corner) {
  /* A notch of width 0.2 in a block, open above. */
  ethd_scene *s = SCENE_ONE(ETHD_SHAPE_POLYGON, 0, 0, 1, 0, 1, 1, 0.6, 1, 0.6, 0.3, 0.4, 0.3, 0.4, 1, 0, 1);
  ethd_touch t[8];
  ck_assert_uint_eq(ethd_scene_touches(s, (ethd_vec){0.5, 0.5}, 0.3, t, 8), 3);
  ck_assert(fabs(t[0].distance - 0.1) <= SCENE_TIGHT && fabs(t[1].distance - 0.1) <= SCENE_TIGHT);
  ck_assert(fabs(t[2].distance - 0.2) <= SCENE_TIGHT && t[2].feature == 8 && t[2].n.y == -1);
  ck_assert(t[0].n.x * t[1].n.x == -1);
  ck_assert_uint_eq(ethd_scene_touches(s, (ethd_vec){0.5, 0.5}, 0.15, t, 8), 2);
  /* From below the block only its bottom faces x, and no wall behind it. */
  ck_assert_uint_eq(ethd_scene_touches(s, (ethd_vec){0.2, -0.1}, 9, t, 8), 1);
  ck_assert(t[0].feature == 0 && t[0].distance == 0.1 && t[0].n.y == 1);
  ethd_scene_destroy(s);
}

/* A foot a nanometre from a corner: the edge's normal, although the corner is as near in double. */
TEST(test_foot_beside_a_vertex) {
  static const double there[] = {0, 0, 1, 0, 2, -1}, back[] = {2, -1, 1, 0, 0, 0};
  for (int i = 0; i < 2; i++) {
    ethd_scene *s = scene_one(ETHD_SHAPE_POLYLINE, 6, i ? back : there);
    ethd_vec x = {1 - 1e-9, 0.5};
    ethd_nearest q;
    ethd_touch t[2];
    ethd_scene_query(s, x, &q);
    ck_assert(q.distance == 0.5 && q.n.x == 0 && q.n.y == -1 && q.point.x == x.x);
    ck_assert_uint_eq(ethd_scene_touches(s, x, 1, t, 2), 1);
    ck_assert(t[0].feature == 2 * i && t[0].n.x == 0 && t[0].side == (i ? -1 : 1));
    ethd_scene_destroy(s);
  }
}

TEST(test_shared_vertices_count_once) {
  /* A straight line of four edges, seen from over its inner points, as wall and as polygon. */
  ethd_scene *s = SCENE_ONE(ETHD_SHAPE_POLYLINE, 0, 0, 0.1, 0, 0.2, 0, 0.30000000000000004, 0, 1, 0);
  ethd_touch t[8];
  for (int k = 1; k <= 3; k++) {
    ck_assert_uint_eq(ethd_scene_touches(s, (ethd_vec){k * 0.1, 0.05}, 1, t, 8), 1);
    ck_assert(t[0].distance == 0.05 && t[0].side == 1 && t[0].n.y == -1);
    ck_assert_uint_eq(ethd_scene_touches(s, (ethd_vec){k * 0.1, -0.05}, 1, t, 8), 1);
    ck_assert(t[0].side == -1 && t[0].n.y == 1);
  }
  ethd_scene_destroy(s);
  /* A corner, from outside (its vertex) and from inside (both edges). */
  s = SCENE_ONE(ETHD_SHAPE_POLYLINE, 0, 1, 0, 0, 1, 0);
  ck_assert_uint_eq(ethd_scene_touches(s, (ethd_vec){-0.3, -0.4}, 1, t, 8), 1);
  ck_assert(t[0].feature == 3 && fabs(t[0].distance - 0.5) <= SCENE_TIGHT && t[0].side == -1);
  ck_assert_uint_eq(ethd_scene_touches(s, (ethd_vec){0.2, 0.1}, 1, t, 8), 2);
  ck_assert(t[0].feature == 2 && t[0].side == 1 && t[1].feature == 0 && t[1].side == 1);
  /* Its ends. */
  ck_assert_uint_eq(ethd_scene_touches(s, (ethd_vec){-0.1, 1.5}, 0.6, t, 8), 1);
  ck_assert(t[0].feature == 1 && t[0].side == 0);
  ck_assert_uint_eq(ethd_scene_touches(s, (ethd_vec){1.5, 0}, 0.6, t, 8), 1);
  ck_assert(t[0].feature == 5 && t[0].side == 0 && t[0].n.x == -1);
  ethd_scene_destroy(s);
  /* A ring of thin walls has no ends: beyond its first point stands a corner like the others. */
  s = SCENE_ONE(ETHD_SHAPE_POLYLINE, 0, 0, 1, 0, 1, 1, 0, 1, 0, 0);
  ck_assert_uint_eq(ethd_scene_touches(s, (ethd_vec){-0.3, -0.4}, 0.6, t, 8), 1);
  ck_assert(t[0].feature == 1 && t[0].side == -1);
  ck_assert_uint_eq(ethd_scene_touches(s, (ethd_vec){0.5, 0.25}, 4, t, 8), 4);
  ethd_scene_destroy(s);
  s = SCENE_ONE(ETHD_SHAPE_SEGMENT, 0, 0, 1, 0);
  ck_assert_uint_eq(ethd_scene_touches(s, (ethd_vec){1.5, 0}, 1, t, 8), 1);
  ck_assert(t[0].feature == 0 && t[0].side == 0);
  ethd_scene_destroy(s);
}
