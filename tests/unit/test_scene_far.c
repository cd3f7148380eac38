/* Queries from where doubles end: not a number, so far that squares overflow, so near a corner that squares are lost;
   and from the vertices themselves. */
#include <math.h>
#include <string.h>

#include "unit/rig.h"

#define EDGES 40

/* A polyline of EDGES edges along the parabola y = x^2 / 100, from x = 0 on; it has a tree of its own. */
static void chain(double *p) {
  for (int k = 0; k <= EDGES; k++) p[2 * k] = k, p[2 * k + 1] = k * k / 100.0;
}

static ethd_scene *build(const ethd_object_def *objects, size_t count) {
  ethd_scene *scene;
  ck_assert_int_eq(ethd_scene_create(&(ethd_scene_def){objects, count, NULL, 0}, &scene, NULL), ETHD_OK);
  return scene;
}

static void close_to(double got, double want) { ck_assert_double_eq_tol(got, want, 1e-12 * fmax(1, fabs(want))); }

TEST(test_not_a_number) {
  ethd_scene *scene = rig_scene("circle 0 0 1\nhalfplane 0 1 -5\n");
  const ethd_vec from[] = {{NAN, 0}, {0, NAN}, {INFINITY, 0}, {0, -INFINITY}};
  ethd_touch touch;
  for (int i = 0; i < 4; i++) {
    ethd_nearest n = {0};
    ethd_scene_query(scene, from[i], &n);
    ck_assert(n.object == -1 && isinf(n.distance));
    ck_assert_uint_eq(ethd_scene_touches(scene, from[i], 9, &touch, 1), 0);
  }
  ck_assert_uint_eq(ethd_scene_touches(scene, (ethd_vec){0, 0}, NAN, &touch, 1), 0);
  ck_assert_uint_eq(ethd_scene_touches(scene, (ethd_vec){0, 0}, 9, &touch, 1), 2);
  ethd_scene_destroy(scene);
}

/* Within the size of the scenes. */
static void about(double got, double want) { ck_assert_double_eq_tol(got, want, 200 + 1e-12 * want); }

/* Far beyond the frame another point stands for x in the trees; the answer is that of the ends seen from afar. */
TEST(test_far_away) {
  double p[2 * (EDGES + 1)], square[2 * 4 * EDGES];
  chain(p);
  for (int k = 0; k < 4 * EDGES; k++) { /* a square of 10 m, many points a side */
    int side = k / EDGES;
    double t = 10.0 * (k % EDGES) / EDGES;
    square[2 * k] = side == 0 ? t : side == 1 ? 10 : side == 2 ? 10 - t : 0;
    square[2 * k + 1] = (side == 0 ? 0 : side == 1 ? t : side == 2 ? 10 : 10 - t) + 100;
  }
  const ethd_object_def objects[] = {{ETHD_SHAPE_POLYLINE, -1, p, 2 * (EDGES + 1), 0},
                                     {ETHD_SHAPE_POLYGON, -1, square, 8 * EDGES, 0}};
  for (int which = 0; which < 3; which++) {
    ethd_scene *scene = which < 2 ? build(objects + which, 1) : build(objects, 2);
    for (double far = 1e12; far < 1e150; far *= 1e6)
      for (int way = 0; way < 4; way++) {
        ethd_vec x = {way == 0 ? far : way == 1 ? -far : 5, way == 2 ? far : way == 3 ? -far : 105};
        ethd_nearest n;
        ethd_touch touch[4], again;
        ethd_scene_query(scene, x, &n);
        ck_assert(n.object >= 0 && n.object <= 1);
        about(n.distance, far);
        ck_assert_double_eq_tol(ethd_vec_norm(n.n), 1, 1e-12);
        size_t found = ethd_scene_touches(scene, x, 2 * far, touch, 4);
        ck_assert_uint_ge(found, 1);
        about(touch[0].distance, far);
        ethd_scene_follow(scene, touch[0].object, x, x, &again);
        about(again.distance, far);
      }
    ethd_scene_destroy(scene);
  }
}

/* Where even the square of the distance isn't finite, an object is still the answer. */
TEST(test_squares_that_overflow) {
  double p[2 * (EDGES + 1)];
  chain(p);
  const ethd_object_def line = {ETHD_SHAPE_POLYLINE, -1, p, 2 * (EDGES + 1), 0};
  const double segment[] = {0, 0, 1, 0};
  const ethd_object_def thin = {ETHD_SHAPE_SEGMENT, -1, segment, 4, 0};
  ethd_scene *scenes[] = {build(&line, 1), build(&thin, 1)};
  for (int i = 0; i < 2; i++) {
    ethd_nearest n;
    ethd_touch touch;
    ethd_scene_query(scenes[i], (ethd_vec){1e200, 1e200}, &n);
    ck_assert(n.object == 0 || (n.object == -1 && isinf(n.distance)));
    ethd_scene_follow(scenes[i], 0, (ethd_vec){0.3, 2}, (ethd_vec){1e200, 0}, &touch);
    ck_assert(touch.object == 0 && touch.distance > 1.9 && touch.distance < 2.1);
  }
  ethd_scene_destroy(scenes[0]);
  ethd_scene_destroy(scenes[1]);
}

/* A box of 1e-150 m: beyond its corner by less than a square can show. */
TEST(test_corner_beyond_squares) {
  ethd_scene *scene = rig_scene("box 0 0 1e-150 1e-150 0\n");
  ethd_nearest n;
  ethd_scene_query(scene, (ethd_vec){2e-150, 2e-150}, &n);
  ck_assert(n.distance >= 0 && n.distance < 2e-150 && n.n.x == -1 && n.n.y == 0);
  ethd_scene_query(scene, (ethd_vec){-2e-150, 2e-150}, &n);
  ck_assert(n.n.x == 1 && n.n.y == 0);
  ethd_scene_query(scene, (ethd_vec){3, 4}, &n);
  close_to(n.distance, 5);
  ethd_scene_destroy(scene);
}

/* So small a scene that its frame's scale would be more than a double's square. */
TEST(test_tiny_scene) {
  ethd_scene *scene = rig_scene("circle 0 0 1e-130\n");
  ethd_nearest n;
  ethd_scene_query(scene, (ethd_vec){3, 4}, &n);
  ck_assert_int_eq(n.object, 0);
  close_to(n.distance, 5);
  ethd_scene_destroy(scene);
}

/* On a polyline's vertices: straight on, blunt, sharp, straight back, and the ends. */
TEST(test_on_a_vertex) {
  ethd_scene *scene = rig_scene("polyline 0 0 1 0 2 0 3 1 3 3 3 2 0 2 1 2.5\n");
  const ethd_vec at[] = {{0, 0}, {1, 0}, {2, 0}, {3, 1}, {3, 3}, {3, 2}, {0, 2}, {1, 2.5}};
  for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
    ethd_nearest n;
    ethd_touch touch[16];
    ethd_scene_query(scene, at[i], &n);
    ck_assert(n.distance == 0 && n.point.x == at[i].x && n.point.y == at[i].y);
    ck_assert_double_eq_tol(ethd_vec_norm(n.n), 1, 1e-12);
    size_t found = ethd_scene_touches(scene, at[i], 0.1, touch, 16);
    ck_assert_uint_ge(found, 1);
    for (size_t k = 0; k < found; k++) ck_assert_double_eq_tol(ethd_vec_norm(touch[k].n), 1, 1e-12);
  }
  ethd_scene_destroy(scene);
}
