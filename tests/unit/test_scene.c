/* Distances against long double by other formulas (corners, areas, winding angles), within 1 m. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "scene_objects.h"
#include "unit/suite.h"

enum { QUERIES = 100000 };

/* Distance is convex along an edge: golden-section search. */
static real by_golden_section(real ax, real ay, real bx, real by, real x, real y) {
  const real g = 0.6180339887498948482045868343656L;
  real lo = 0, hi = 1;
  for (int i = 0; i < 100; i++) {
    real s = hi - g * (hi - lo), t = lo + g * (hi - lo);
    real ds = hypotl(ax + s * (bx - ax) - x, ay + s * (by - ay) - y);
    real dt = hypotl(ax + t * (bx - ax) - x, ay + t * (by - ay) - y);
    if (ds < dt)
      hi = t;
    else
      lo = s;
  }
  real t = (lo + hi) / 2;
  return fminl(fminl(hypotl(ax - x, ay - y), hypotl(bx - x, by - y)),
               hypotl(ax + t * (bx - ax) - x, ay + t * (by - ay) - y));
}

/* A unit normal along which the surface point lies; the point is on the surface. */
static void check_frame(const object *o, ethd_vec x, double distance, ethd_vec point, ethd_vec n) {
  real norm = hypotl(n.x, n.y);
  ck_assert(fabsl(norm - 1) <= 4 * DBL_EPSILON);
  ck_assert(hypotl(x.x + (real)distance * n.x - point.x, x.y + (real)distance * n.y - point.y) <= 2 * SCENE_TIGHT);
  ck_assert(fabsl(scene_expected(o, point.x, point.y)) <= SCENE_TIGHT);
  /* Distance falls along n, from outside and from inside. */
  if (fabs(distance) > 1e-4)
    ck_assert(scene_expected(o, x.x + 1e-6L * n.x, x.y + 1e-6L * n.y) - scene_expected(o, x.x, x.y) <= -0.999999e-6L);
}

TEST(test_golden_section_agrees) {
  scene_seed(11);
  for (int i = 0; i < 2000; i++) {
    real v[6];
    for (int k = 0; k < 6; k++) v[k] = scene_uniform(-1, 1);
    real fine = scene_to_edge(v[0], v[1], v[2], v[3], v[4], v[5]);
    ck_assert(fabsl(fine - by_golden_section(v[0], v[1], v[2], v[3], v[4], v[5])) <= 1e-9L);
  }
}

TEST_LOOP(test_each_shape, 0, ETHD_SHAPE_COUNT) {
  ethd_shape shape = (ethd_shape)_i;
  enum { SCENES = 500 };
  scene_seed(100 + (uint64_t)_i);
  real worst = 0;
  for (int s = 0; s < SCENES; s++) {
    object o = scene_random(shape);
    ethd_scene *scene = scene_build(&o, 1);
    for (int i = 0; i < QUERIES / SCENES; i++) {
      ethd_vec x = {scene_uniform(-1, 1), scene_uniform(-1, 1)};
      ethd_nearest q;
      ethd_scene_query(scene, x, &q);
      real error = fabsl(q.distance - scene_expected(&o, x.x, x.y));
      ck_assert_msg(error <= SCENE_TIGHT, "%s: %Lg at %.17g %.17g", ethd_shape_name(shape), error, x.x, x.y);
      ck_assert_int_eq(q.object, 0);
      if (i % 8 == 0) check_frame(&o, x, q.distance, q.point, q.n);
      worst = fmaxl(worst, error);
    }
    ethd_scene_destroy(scene);
  }
  ck_assert(worst > 0);
}

/* ---- special places ---- */

static ethd_nearest at(const ethd_scene *scene, double x, double y) {
  ethd_nearest q;
  ethd_scene_query(scene, (ethd_vec){x, y}, &q);
  return q;
}

static void check_at(int line, const ethd_scene *scene, double x, double y, double d, double u, double v) {
  ethd_nearest q = at(scene, x, y);
  ck_assert_msg(fabs(q.distance - d) <= SCENE_TIGHT && fabs(q.n.x - u) <= SCENE_TIGHT && fabs(q.n.y - v) <= SCENE_TIGHT,
                "line %d: %.17g (%.17g, %.17g)", line, q.distance, q.n.x, q.n.y);
}
#define CHECK_AT(...) check_at(__LINE__, __VA_ARGS__)

TEST(test_paper_wall) {
  ethd_scene *s = SCENE_ONE(ETHD_SHAPE_HALFPLANE, -1, 0, -0.238);
  CHECK_AT(s, 0.25, 0.25, 0.012, -1, 0);
  CHECK_AT(s, 0.2, -3, -0.038, -1, 0);
  ethd_nearest q = at(s, 0.25, 0.25);
  ck_assert(q.point.x == 0.238 && q.point.y == 0.25);
  ethd_scene_destroy(s);
}

/* n = (3, 4) (1 + 5e-7) / 5 and c = 0.2 (1 + 5e-7): the plane 3 x + 4 y = 5 * 0.2. */
TEST(test_halfplane_is_normalised) {
  double f = 1 + 5e-7;
  ethd_scene *s = SCENE_ONE(ETHD_SHAPE_HALFPLANE, 0.6 * f, 0.8 * f, 0.2 * f);
  CHECK_AT(s, 0, 0, 0.2, 0.6, 0.8);
  CHECK_AT(s, 1, 1, -1.2, 0.6, 0.8);
  ethd_scene_destroy(s);
}

TEST(test_corners_of_an_l) {
  /*  (0,2)-(1,2)
        |     |
        |   (1,1)-(2,1)       reflex at (1, 1)
        |           |
      (0,0)-------(2,0)  */
  static const double ccw[] = {0, 0, 2, 0, 2, 1, 1, 1, 1, 2, 0, 2};
  double cw[12];
  for (int k = 0; k < 6; k++) cw[2 * k] = ccw[10 - 2 * k], cw[2 * k + 1] = ccw[11 - 2 * k];
  double r = sqrt(0.5);
  for (int i = 0; i < 2; i++) {
    ethd_scene *s = scene_one(ETHD_SHAPE_POLYGON, 12, i ? cw : ccw);
    CHECK_AT(s, 0.75, 0.75, -sqrt(0.125), -r, -r); /* inside, nearest to the reflex corner */
    CHECK_AT(s, 1.25, 1.125, 0.125, 0, -1);        /* outside, in its notch */
    CHECK_AT(s, 2.5, 1.5, sqrt(0.5), -r, -r);      /* off a convex corner */
    CHECK_AT(s, -1, -1, sqrt(2), r, r);
    CHECK_AT(s, 1, 1, 0, -r, -r); /* on the reflex corner */
    CHECK_AT(s, 0, 0, 0, r, r);   /* on a convex one */
    CHECK_AT(s, 1, 0, 0, 0, 1);   /* on an edge */
    CHECK_AT(s, 1.5, 0.9375, -0.0625, 0, -1);
    CHECK_AT(s, 3, 0.5, 1, -1, 0);
    ethd_scene_destroy(s);
  }
}

/* Which side is inside doesn't depend on which point comes first. From the leftmost one the other neighbour's neighbour
   lies on the wrong side. */
TEST(test_winding) {
  enum { POINTS = 40 };
  double points[POINTS][2] = {{0, 0}, {1, -1}};
  for (int k = 2; k < POINTS; k++) {
    double t = (k - 2) / (POINTS - 3.0), bulge = -0.05 * sin(3.14159 * t);
    points[k][0] = 2 - t + 3 * bulge, points[k][1] = 4 - 3 * t - bulge;
  }
  for (int first = 0; first < POINTS; first++)
    for (int back = 0; back < 2; back++) {
      double p[2 * POINTS];
      for (int k = 0; k < POINTS; k++)
        memcpy(p + 2 * k, points[(first + (back ? POINTS - k : k)) % POINTS], sizeof points[0]);
      ethd_object_def o = {ETHD_SHAPE_POLYGON, -1, p, 2 * POINTS, 0};
      ethd_scene_def def = {&o, 1, NULL, 0};
      ethd_scene *s;
      ck_assert_int_eq(ethd_scene_create(&def, &s, NULL), ETHD_OK);
      ck_assert_double_eq_tol(at(s, 0.5, 0).distance, -0.5 * sqrt(0.5), 1e-15);
      ck_assert_double_eq_tol(at(s, -0.5, 0).distance, 0.5, 1e-15);
      ethd_scene_destroy(s);
    }
}

TEST(test_undefined_gradients) {
  ethd_scene *s = SCENE_ONE(ETHD_SHAPE_CIRCLE, 0.25, 0.5, 0.125);
  ethd_nearest q = at(s, 0.25, 0.5);
  ck_assert(q.distance == -0.125 && fabs(ethd_vec_norm(q.n) - 1) <= DBL_EPSILON);
  q = at(s, 0.25 + 1e-170, 0.5);
  ck_assert(fabs(ethd_vec_norm(q.n) - 1) <= DBL_EPSILON);
  ethd_scene_destroy(s);
  s = SCENE_ONE(ETHD_SHAPE_CAPSULE, 0, 0, 3, 4, 0.5); /* on its axis n is across */
  q = at(s, 1.5, 2);
  ck_assert(q.distance == -0.5 && fabs(fabs(q.n.x * 4 - q.n.y * 3) - 5) <= 4 * DBL_EPSILON);
  q = at(s, 3, 4);
  ck_assert(q.distance == -0.5 && fabs(ethd_vec_norm(q.n) - 1) <= DBL_EPSILON);
  ethd_scene_destroy(s);
  s = SCENE_ONE(ETHD_SHAPE_CAPSULE, 0.1, 0.2, 0.1, 0.2, 0.5); /* a circle */
  CHECK_AT(s, 1.1, 0.2, 0.5, -1, 0);
  ethd_scene_destroy(s);
  s = SCENE_ONE(ETHD_SHAPE_SEGMENT, 0, 0, 1, 0);
  q = at(s, 0.5, 0);
  ck_assert(q.distance == 0 && q.n.x == 0 && fabs(q.n.y) == 1);
  q = at(s, 1, 0);
  ck_assert(q.distance == 0 && fabs(ethd_vec_norm(q.n) - 1) <= DBL_EPSILON);
  CHECK_AT(s, 2, 0, 1, -1, 0);
  CHECK_AT(s, 0.5, -0.25, 0.25, 0, 1);
  ethd_scene_destroy(s);
  s = SCENE_ONE(ETHD_SHAPE_BOX, 0, 0, 1, 2, 0);
  CHECK_AT(s, 1, 2, 0, 0, -1); /* a corner: a face's normal */
  CHECK_AT(s, 4, 6, 5, -0.6, -0.8);
  CHECK_AT(s, 0, 1.75, -0.25, 0, -1);
  ethd_scene_destroy(s);
}

TEST(test_empty_and_ties) {
  ethd_scene *s = scene_build(NULL, 0);
  ethd_nearest q = at(s, 1, 2);
  ck_assert(q.object == -1 && isinf(q.distance) && q.distance > 0);
  ck_assert_uint_eq(ethd_scene_touches(s, (ethd_vec){0, 0}, 1e9, NULL, 0), 0);
  ethd_scene_destroy(s);
  object o[3] = {
      {ETHD_SHAPE_CIRCLE, 3, {9, 9, 1}}, {ETHD_SHAPE_CIRCLE, 3, {1, 0, 0.5}}, {ETHD_SHAPE_CIRCLE, 3, {-1, 0, 0.5}}};
  s = scene_build(o, 3);
  q = at(s, 0, 0);
  ck_assert(q.object == 1 && q.distance == 0.5);
  ethd_scene_destroy(s);
  ethd_scene_destroy(NULL);
}

/* Points that rounding puts on either side of a line: signs must not flip where the distance isn't tiny. */
TEST(test_nearly_straight_vertices) {
  scene_seed(300);
  for (int c = 0; c < 2000; c++) {
    object o = {ETHD_SHAPE_POLYGON, 0, {0}};
    double ux = scene_uniform(-0.5, 0.5), uy = scene_uniform(0.1, 0.5);
    for (int k = 0; k <= 10; k++) scene_add(&o, 0.1 * k * ux), scene_add(&o, 0.1 * k * uy); /* a line, up to rounding */
    scene_add(&o, -0.5), scene_add(&o, 0.25);
    ethd_scene *s = scene_build(&o, 1);
    double l = hypot(ux, uy);
    for (int k = 0; k <= 10; k++) {
      double d = scene_uniform(1e-6, 0.02), f = k == 0 || k == 10 ? 0.05 * l : 0;
      double x = 0.1 * k * ux + (k ? -f : f) * ux / l, y = 0.1 * k * uy + (k ? -f : f) * uy / l;
      for (int side = -1; side <= 1; side += 2) {
        double px = x + side * d * -uy / l, py = y + side * d * ux / l;
        ethd_nearest q = at(s, px, py);
        real e = scene_expected(&o, px, py);
        ck_assert_msg(fabsl(q.distance - e) <= SCENE_TIGHT, "%d: %g, not %Lg", k, q.distance, e);
        if (e < 0) continue;
        ethd_touch t[4];
        ck_assert_uint_eq(ethd_scene_touches(s, (ethd_vec){px, py}, 1.0001 * d + 1e-12, t, 4), 1);
      }
    }
    ethd_scene_destroy(s);
  }
}

/* Beyond the tip of a needle both edges are as near, and one of them shows its inner face. */
TEST(test_needles) {
  static const double widths[] = {1e-3, 1e-6, 1e-9, 1e-12, 1e-14};
  scene_seed(400);
  for (int w = 0; w < 5; w++) {
    object o = {ETHD_SHAPE_POLYGON, 6, {0, 0, 1, 0, 0, widths[w]}};
    ethd_scene *s = scene_build(&o, 1);
    for (int i = 0; i < 20000; i++) {
      double x = i % 2 ? 1 + scene_uniform(-2, 2) * widths[w] : scene_uniform(-1, 2), y = scene_uniform(-1, 1);
      ethd_nearest q = at(s, x, y);
      ck_assert(fabsl(q.distance - scene_to_chain(o.p, 3, 1, x, y)) <= SCENE_TIGHT); /* outside: |y| is far over w */
      ck_assert(y * q.n.y < 0 || fabs(y) < 1e-3);
    }
    ethd_scene_destroy(s);
  }
}
