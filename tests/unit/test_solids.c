/* What a query of solids finds, in which order, and where; the plane's shapes as solids. Distances beside SciPy's:
   tests/solids.py. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "ethd/scene.h"
#include "scene_objects.h"
#include "solids/solids.h"
#include "unit/solids_rig.h"

/* ---- what a query finds ---- */

static size_t ask(const char *text, ethd_vec3 x, ethd_surface out[8]) {
  ethd_solids *s = parse(text);
  size_t count = ethd_solids_surfaces(s, NULL, x, INFINITY, out, 8);
  ethd_solids_destroy(s);
  return count;
}

static void expect(const char *text, ethd_vec3 x, ethd_vec3 point, ethd_vec3 n) {
  ethd_surface s[8];
  ck_assert_uint_eq(ask(text, x, s), 1);
  ck_assert_msg(close_to(s->point, point) && close_to(s->n, n), "%s: %g %g %g, n %g %g %g", text, s->point.x,
                s->point.y, s->point.z, s->n.x, s->n.y, s->n.z);
}

TEST(test_faces_edges_corners) {
  static const char *const box = "box 0 0 0 1 2 3";
  expect(box, (ethd_vec3){0.5, 0.5, 5}, (ethd_vec3){0.5, 0.5, 3}, (ethd_vec3){0, 0, -1});
  expect(box, (ethd_vec3){-4, 1, -1}, (ethd_vec3){-1, 1, -1}, (ethd_vec3){1, 0, 0});
  expect(box, (ethd_vec3){4, -6, 1}, (ethd_vec3){1, -2, 1}, (ethd_vec3){-0.6, 0.8, 0});
  expect(box, (ethd_vec3){3, 4, 4}, (ethd_vec3){1, 2, 3}, (ethd_vec3){-2 / 3., -2 / 3., -1 / 3.});
  expect(box, (ethd_vec3){0.75, 0, 0}, (ethd_vec3){1, 0, 0}, (ethd_vec3){-1, 0, 0});
  expect(box, (ethd_vec3){0, -1.75, 0}, (ethd_vec3){0, -2, 0}, (ethd_vec3){0, 1, 0});
  expect(box, (ethd_vec3){1, 2, 3}, (ethd_vec3){1, 2, 3}, (ethd_vec3){0, 0, -1});         /* on a corner */
  expect(box, (ethd_vec3){1, 0.5, 0.5}, (ethd_vec3){1, 0.5, 0.5}, (ethd_vec3){-1, 0, 0}); /* on a face */
  expect("box 0 0 0 1 1 1", (ethd_vec3){0.5, -0.5, 0}, (ethd_vec3){0.5, -1, 0}, (ethd_vec3){0, 1, 0});
  expect("box 0 0 0 1 1 1", (ethd_vec3){0, 0, 0}, (ethd_vec3){0, 0, 1}, (ethd_vec3){0, 0, -1});
  expect("box 0 0 0 1 1 1", (ethd_vec3){1, 1, 1 + 1e-15}, (ethd_vec3){1, 1, 1}, (ethd_vec3){0, 0, -1});
  expect("box 0 0 0 1e-170 1e-170 1", (ethd_vec3){2e-170, 2e-170, 0}, (ethd_vec3){0, 0, 0}, (ethd_vec3){0, -1, 0});
}

/* A normal that isn't quite of unit length, and c with it. */
TEST(test_halfspace_is_divided) {
  const double length = 1 + 5e-7;
  ethd_surface s[8];
  ck_assert_uint_eq(ask("halfspace 0 0 1.0000005 3", (ethd_vec3){1, 2, 0}, s), 1);
  ck_assert_double_eq_tol(s->n.z, 1, 1e-16);
  ck_assert_double_eq_tol(s->point.z, 3 / length, 1e-15);
}

static void expect_unit(const char *text, ethd_vec3 x, double distance, ethd_vec3 across) {
  ethd_surface s[8];
  ck_assert_uint_eq(ask(text, x, s), 1);
  ck_assert_msg(fabs(ethd_vec3_norm(s->n) - 1) < 1e-15, "%s", text);
  ck_assert_double_eq_tol(depth(s, x), distance, 1e-15);
  ck_assert_double_eq_tol(ethd_vec3_dot(s->n, across), 0, 1e-15);
}

/* Where the gradient isn't defined n is a unit vector, and on an axis at right angles to it. */
TEST(test_where_no_normal_is_defined) {
  const ethd_vec3 none = {0, 0, 0};
  expect_unit("sphere 1 2 3 0.5", (ethd_vec3){1, 2, 3}, -0.5, none);
  expect_unit("capsule 0 0 0 0 0 2 0.5", (ethd_vec3){0, 0, 1}, -0.5, (ethd_vec3){0, 0, 1});
  expect_unit("capsule 0 0 0 0 0 2 0.5", (ethd_vec3){0, 0, 0}, -0.5, (ethd_vec3){0, 0, 1});
  expect_unit("capsule 0 0 0 2 2 2 0.5", (ethd_vec3){2, 2, 2}, -0.5, (ethd_vec3){1, 1, 1});
  expect_unit("capsule 0 0 0 2 0 0 0.5", (ethd_vec3){1, 1e-200, 0}, -0.5, (ethd_vec3){1, 0, 0});
  expect_unit("capsule 0 0 0 0 2 0 0.5", (ethd_vec3){0, 1, 0}, -0.5, (ethd_vec3){0, 1, 0});
  expect_unit("capsule 1 1 1 1 1 1 0.5", (ethd_vec3){1, 1, 1}, -0.5, none); /* a sphere */
  expect_unit("capsule 1 1 1 1 1 1 0.5", (ethd_vec3){1, 4, 1}, 2.5, (ethd_vec3){1, 0, 1});
}

TEST(test_range_order_room) {
  ethd_solids *s = parse("sphere 5 0 0 1\nhalfspace 0 0 -1 0\nsphere 2 0 0 1\nsphere 0 2 0 1\nsphere -2 0 0 1\n");
  ethd_surface out[8];
  const ethd_vec3 x = {0, 0, 1}; /* from the spheres at 2: sqrt(5) - 1 */
  static const int ids[] = {1, 2, 3, 4, 0};
  for (size_t room = 0; room <= 6; room++) {
    memset(out, 0x7f, sizeof out);
    ck_assert_uint_eq(ethd_solids_surfaces(s, NULL, x, 10, out, room), 5);
    for (size_t i = 0; i < 5 && i < room; i++) ck_assert_int_eq(out[i].id, ids[i]);
    ck_assert_int_eq(out[room < 5 ? room : 5].id, 0x7f7f7f7f); /* nothing is written behind */
  }
  ck_assert(ask("sphere 0 0 2 1\nhalfspace 0 0 1 1\nsphere 2 0 0 1", (ethd_vec3){0, 0, 0}, out) == 3 && out[0].id == 0);
  ck_assert(out[1].id == 1 && out[2].id == 2);
  ck_assert_uint_eq(ethd_solids_surfaces(s, NULL, x, 1, out, 8), 1); /* the range itself counts */
  ck_assert_uint_eq(ethd_solids_surfaces(s, NULL, x, 0.999, out, 8), 0);
  ck_assert_uint_eq(ethd_solids_surfaces(s, NULL, x, 1.237, out, 8), 4);
  ck_assert_uint_eq(ethd_solids_surfaces(s, NULL, x, 1.236, out, 8), 1);
  ck_assert_uint_eq(ethd_solids_surfaces(s, NULL, (ethd_vec3){0, 0, 50}, 48, out, 8), 0); /* beyond them all */
  ck_assert_uint_eq(ethd_solids_surfaces(s, NULL, (ethd_vec3){5, 0, 0}, -0.5, out, 8), 1);
  ck_assert_uint_eq(ethd_solids_surfaces(s, NULL, (ethd_vec3){5, 0, 0}, -1.5, out, 8), 0);
  ck_assert_uint_eq(ethd_solids_surfaces(s, NULL, (ethd_vec3){5, 0, 0}, -INFINITY, out, 8), 0);
  ethd_solids_destroy(s);
}

/* Bounds never hide a solid whose distance is the range to the bit, however far from the origin and from x it is. */
TEST(test_bounds_hide_nothing) {
  scene_seed(33);
  for (int i = 0; i < 40000; i++) {
    const ethd__solid_shape *shape = &ethd__solid_shapes[1 + i % 3];
    double given[9], kept[15], scale = pow(10, scene_uniform(-3, 5.9)), away = pow(10, scene_uniform(-3, 6));
    char text[400];
    int n = snprintf(text, sizeof text, "%s", shape->form.name);
    for (size_t k = 0; k < shape->form.count; k++) {
      bool is_size = shape->form.numbers[k].kind == ETHD__LENGTH;
      given[k] = is_size ? scene_uniform(0.1, 1) : scene_uniform(-scale, scale);
      n += snprintf(text + n, sizeof text - (size_t)n, " %.17g", given[k]);
    }
    ethd_solids *s = parse(text);
    ethd__foot foot;
    ethd_surface found;
    ethd_vec3 x = ethd_vec3_of(given);
    *(i % 2 ? &x.x : i % 4 ? &x.y : &x.z) += away;
    shape->keep(given, shape->form.count, kept);
    shape->nearest(kept, x, &foot);
    ck_assert_msg(ethd_solids_surfaces(s, NULL, x, foot.distance, &found, 1) == 1, "%s: %.17g", text, away);
    ck_assert_uint_eq(ethd_solids_surfaces(s, NULL, x, nextafter(foot.distance, -INFINITY), &found, 1), 0);
    ethd_solids_destroy(s);
  }
}

TEST(test_odd_places) {
  ethd_solids *s = parse("sphere 0 0 0 1\nhalfspace 0 0 -1 0\nbox 0 0 0 1 1 1 1 1 1\ncapsule 0 0 0 1 1 1 1\n");
  static const double odd[] = {NAN, INFINITY, -INFINITY, 1.01e100, -DBL_MAX};
  ethd_surface out[4];
  for (int i = 0; i < 5; i++)
    for (int k = 0; k < 3; k++) {
      double x[3] = {0, 0, 0};
      x[k] = odd[i];
      ck_assert_uint_eq(ethd_solids_surfaces(s, NULL, ethd_vec3_of(x), INFINITY, out, 4), 0);
    }
  ck_assert_uint_eq(ethd_solids_surfaces(s, NULL, (ethd_vec3){0, 0, 0}, NAN, out, 4), 0);
  ck_assert_uint_eq(ethd_solids_surfaces(s, NULL, (ethd_vec3){1e100, -1e100, 1e100}, INFINITY, out, 4), 4);
  for (int i = 0; i < 4; i++) ck_assert_double_eq_tol(ethd_vec3_norm(out[i].n), 1, 1e-15);
  ck_assert_uint_eq(ethd_solids_surfaces(s, NULL, (ethd_vec3){0, 0, 0}, DBL_MAX, out, 4), 4);
  ethd_solids_destroy(s);
}

/* ---- bodies ---- */

TEST(test_poses) {
  ethd_solids *s = parse("sphere 2 0 0 0.5\n");
  ethd_surface out;
  /* A quarter about z brings (2, 0, 0) to (0, 2, 0); the origin is at (0, 0, 1); one radian a second about x. */
  ethd_body_pose3 pose = {{0, 0, 1}, {M_SQRT1_2, 0, 0, M_SQRT1_2}, {3, 0, 0}, {1, 0, 0}};
  ck_assert(ethd_body_pose3_is_valid(&pose));
  ck_assert_uint_eq(ethd_solids_surfaces(s, &pose, (ethd_vec3){0, 1, 1}, 1, &out, 1), 1);
  ck_assert(close_to(out.point, (ethd_vec3){0, 1.5, 1}) && close_to(out.n, (ethd_vec3){0, 1, 0}));
  ck_assert(close_to(out.v, (ethd_vec3){3, 0, 1.5}));
  for (int k = 0; k < 4; k++) pose.orientation[k] *= -(1 + 9e-7); /* the same rotation */
  ck_assert_uint_eq(ethd_solids_surfaces(s, &pose, (ethd_vec3){0, 1, 1}, 1, &out, 1), 1);
  ck_assert(close_to(out.point, (ethd_vec3){0, 1.5, 1}) && close_to(out.v, (ethd_vec3){3, 0, 1.5}));
  ethd_solids_destroy(s);
}

TEST(test_poses_that_are_not_valid) {
  static const double bad[] = {NAN, INFINITY, -1.01e100};
  static const ethd_body_pose3 good = {{0, 0, 0}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  ethd_solids *s = parse("halfspace 0 0 -1 0\nsphere 0 0 0 1\n");
  ethd_surface out[2];
  const ethd_vec3 x = {0, 0, 0};
  for (int k = 0; k < 13; k++)
    for (int i = 0; i < 3; i++) {
      ethd_body_pose3 pose = good;
      double *number = k < 3    ? &pose.x.x + k
                       : k < 7  ? pose.orientation + k - 3
                       : k < 10 ? &pose.v.x + k - 7
                                : &pose.rate.x + k - 10;
      *number = bad[i];
      ck_assert(!ethd_body_pose3_is_valid(&pose));
      ck_assert_uint_eq(ethd_solids_surfaces(s, &pose, x, INFINITY, out, 2), 0);
    }
  static const double lengths[] = {0, 1 - 1.1e-6, 1 + 1.1e-6, 2.5};
  for (int i = 0; i < 4; i++) {
    ethd_body_pose3 pose = good;
    pose.orientation[0] = lengths[i];
    ck_assert(!ethd_body_pose3_is_valid(&pose));
    ck_assert_uint_eq(ethd_solids_surfaces(s, &pose, x, INFINITY, out, 2), 0);
  }
  ck_assert_uint_eq(ethd_solids_surfaces(s, &good, x, INFINITY, out, 2), 2);
  ethd_solids_destroy(s);
}

/* ---- the plane's shapes, drawn out along z ---- */

/* The text of the solid whose section at z = 0 the object is. A circle is a sphere, whose equator it is. */
static void draw_out(const object *o, char *text, size_t room) {
  const double *p = o->p;
  switch (o->shape) {
  case ETHD_SHAPE_HALFPLANE: snprintf(text, room, "halfspace %.17g %.17g 0 %.17g", p[0], p[1], p[2]); break;
  case ETHD_SHAPE_CIRCLE: snprintf(text, room, "sphere %.17g %.17g 0 %.17g", p[0], p[1], p[2]); break;
  case ETHD_SHAPE_CAPSULE:
    snprintf(text, room, "capsule %.17g %.17g 0 %.17g %.17g 0 %.17g", p[0], p[1], p[2], p[3], p[4]);
    break;
  default: snprintf(text, room, "box %.17g %.17g 0 %.17g %.17g 1 0 0 %.17g", p[0], p[1], p[2], p[3], p[4]);
  }
}

TEST(test_like_the_plane) {
  scene_seed(7);
  for (int i = 0; i < 40000; i++) {
    object o = scene_random((ethd_shape)(i % 4));
    char text[400];
    draw_out(&o, text, sizeof text);
    ethd_solids *s = parse(text);
    ethd_scene *scene = scene_build(&o, 1);
    const ethd_vec x = {scene_uniform(-1, 1), scene_uniform(-1, 1)};
    ethd_nearest plane;
    ethd_surface space;
    ethd_scene_query(scene, x, &plane);
    ck_assert_uint_eq(ethd_solids_surfaces(s, NULL, (ethd_vec3){x.x, x.y, 0}, 4, &space, 1), 1);
    double d = depth(&space, (ethd_vec3){x.x, x.y, 0});
    ck_assert_msg(fabs(d - plane.distance) < 1e-12, "%s: %g", text, d - plane.distance);
    ck_assert_msg(fabs(space.point.x - plane.point.x) < 1e-12 && fabs(space.point.y - plane.point.y) < 1e-12 &&
                      space.point.z == 0 && space.n.z == 0 && space.n.x * plane.n.x + space.n.y * plane.n.y > 1 - 1e-9,
                  "%s", text);
    ethd_solids_destroy(s);
    ethd_scene_destroy(scene);
  }
}
