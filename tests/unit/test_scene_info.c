/* A scene's summary, and what an arm can't reach. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/shapes.h"
#include "scene_objects.h"
#include "unit/suite.h"

TEST(test_describe) {
  object o[] = {{ETHD_SHAPE_HALFPLANE, 3, {0, 1, 5}},
                {ETHD_SHAPE_CIRCLE, 3, {1, 2, 0.5}},
                {ETHD_SHAPE_POLYGON, 8, {0, 0, 3, 0, 3, 1, 0, 1}},
                {ETHD_SHAPE_POLYLINE, 6, {-2, 0, -1, 0, -1, -4}},
                {ETHD_SHAPE_SEGMENT, 4, {0, 0, 1, 1}},
                {ETHD_SHAPE_CIRCLE, 3, {0, 0, 0.1}}};
  ethd_scene *s = scene_build(o, 6);
  ethd_scene_info info;
  ethd_scene_describe(s, &info);
  ck_assert_uint_eq(info.objects, 6);
  ck_assert_uint_eq(info.by_shape[ETHD_SHAPE_CIRCLE], 2);
  ck_assert_uint_eq(info.by_shape[ETHD_SHAPE_HALFPLANE], 1);
  ck_assert_uint_eq(info.by_shape[ETHD_SHAPE_BOX], 0);
  ck_assert_uint_eq(info.segments, 4 + 2 + 1);
  ck_assert(info.x_min == -2 && info.x_max == 3 && info.y_min == -4 && info.y_max == 2.5);
  ck_assert(info.bytes > 6 * 32 && info.bytes < 6 * 32 + 2000);
  ethd_scene_destroy(s);
  s = scene_build(o, 1);
  ethd_scene_describe(s, &info);
  ck_assert(info.x_min > info.x_max && info.y_min > info.y_max);
  ethd_scene_destroy(s);
  s = SCENE_ONE(ETHD_SHAPE_BOX, 1, 1, 2, 1, M_PI / 2);
  ethd_scene_describe(s, &info);
  ck_assert(fabs(info.x_min) <= SCENE_TIGHT && fabs(info.x_max - 2) <= SCENE_TIGHT);
  ck_assert(fabs(info.y_max - 3) <= SCENE_TIGHT);
  ethd_scene_destroy(s);
  for (int i = 0; i < ETHD_SHAPE_COUNT; i++)
    for (int k = 0; k < i; k++) ck_assert_str_ne(ethd_shape_name((ethd_shape)i), ethd_shape_name((ethd_shape)k));
  ck_assert_str_eq(ethd_shape_name(ETHD_SHAPE_HALFPLANE), "halfplane");
}

/* A shape's form names its numbers in their order: those that messages name. */
TEST(test_forms) {
  for (int i = 0; i < ETHD_SHAPE_COUNT; i++) {
    const ethd__shape *row = &ethd__shapes[i];
    char form[80], *rest = form;
    ck_assert_str_eq(ethd_shape_name((ethd_shape)i), row->form.name);
    ck_assert_uint_lt(strlen(ethd_shape_form((ethd_shape)i)), sizeof form);
    strcpy(form, ethd_shape_form((ethd_shape)i));
    size_t words = 0;
    for (char *w; (w = strtok_r(rest, " ", &rest)) != NULL && strcmp(w, "...") != 0; words++) {
      const char *name = row->form.numbers[row->is_chain ? words % 2 : words].name;
      ck_assert_int_eq(strncasecmp(w, name, row->is_chain ? 1 : strlen(w) + 1), 0);
    }
    ck_assert_uint_eq(words, row->form.count);
    ck_assert_int_eq(strstr(row->form.text, "...") != NULL, row->form.most == SIZE_MAX);
    ck_assert_int_eq(row->nearest != NULL, !row->is_chain);
  }
  ck_assert_str_eq(ethd_shape_form(ETHD_SHAPE_BOX), "X Y HALF_W HALF_H ANGLE");
  ck_assert_str_eq(ethd_shape_form(ETHD_SHAPE_COUNT), "");
}

/* An arm of 0.3 and 0.2 m: an annulus of 0.1 to 0.5 m, and a ring of 0.05 m. Objects lie within reach iff a
   point of theirs lies 0.05 to 0.55 m from the base: random points of them against the answer. */
TEST(test_out_of_reach) {
  ethd_arm arm = {ETHD_ARM_SERIAL, 0.3, 0.2};
  int out = 0;
  scene_seed(900);
  for (int s = 0; s < 2000; s++) {
    object o = scene_random((ethd_shape)(scene_draw() % ETHD_SHAPE_COUNT));
    if (s % 2)
      for (size_t k = 0; k < o.count && o.shape != ETHD_SHAPE_HALFPLANE; k++)
        o.p[k] *= o.shape == ETHD_SHAPE_BOX ? 0.2 : 0.05;
    ethd_scene *scene = scene_build(&o, 1);
    size_t dropped = ethd_scene_out_of_reach(scene, &arm, 0.05);
    int reached = 0;
    real nearest = scene_expected(&o, 0, 0);
    for (int i = 0; i < 400 && !reached; i++) {
      real r = scene_uniform(0.0501, 0.5499), a = scene_uniform(-4, 4);
      reached = scene_expected(&o, r * cosl(a), r * sinl(a)) <= 0;
    }
    if (reached) ck_assert_uint_eq(dropped, 0);
    if (nearest > 0.5501L) ck_assert_uint_eq(dropped, 1);
    out += (int)dropped;
    ethd_scene_destroy(scene);
  }
  ck_assert_int_gt(out, 100);
  ethd_scene *s = SCENE_ONE(ETHD_SHAPE_CIRCLE, 0.02, 0, 0.0299); /* in the hole */
  ck_assert_uint_eq(ethd_scene_out_of_reach(s, &arm, 0.05), 1);
  ethd_scene_destroy(s);
  s = SCENE_ONE(ETHD_SHAPE_CIRCLE, 0.02, 0, 0.0301);
  ck_assert_uint_eq(ethd_scene_out_of_reach(s, &arm, 0.05), 0);
  ethd_scene_destroy(s);
  s = SCENE_ONE(ETHD_SHAPE_BOX, 0.9, 0, 0.3501, 0.1, 0);
  ck_assert_uint_eq(ethd_scene_out_of_reach(s, &arm, 0.05), 0);
  ethd_scene_destroy(s);
  s = SCENE_ONE(ETHD_SHAPE_BOX, 0.9, 0, 0.3499, 0.1, 0);
  ck_assert_uint_eq(ethd_scene_out_of_reach(s, &arm, 0.05), 1);
  ethd_scene_destroy(s);
  s = SCENE_ONE(ETHD_SHAPE_POLYGON, -9, -9, 9, -9, 9, 9, -9, 9); /* everything lies in it */
  ck_assert_uint_eq(ethd_scene_out_of_reach(s, &arm, 0.05), 0);
  ethd_scene_destroy(s);
}

static int holds(const ethd_scene_box *b, double x, double y) {
  double u = b->cosine * (x - b->centre.x) + b->sine * (y - b->centre.y);
  double v = b->cosine * (y - b->centre.y) - b->sine * (x - b->centre.x);
  return fabs(u) <= b->half_u && fabs(v) <= b->half_v;
}

/* The levels of a chain of 1000 edges have 1000, 125, 16 and 2 boxes, and each box holds the ends of its edges. */
TEST(test_boxes) {
  enum { EDGES = 1000 };
  static double p[2 * EDGES];
  for (int k = 0; k < EDGES; k++) p[2 * k] = 3 + cos(k * 2 * M_PI / EDGES), p[2 * k + 1] = sin(k * 2 * M_PI / EDGES);
  ethd_object_def o = {ETHD_SHAPE_POLYGON, -1, p, 2 * EDGES, 0};
  ethd_scene_def def = {&o, 1, NULL, 0};
  ethd_scene *s;
  ck_assert_int_eq(ethd_scene_create(&def, &s, NULL), ETHD_OK);
  ethd_scene_info info;
  ethd_scene_describe(s, &info);
  size_t found[6] = {0}, edges[] = {0, 1, 8, 64, 512};
  for (size_t i = 0; i < info.boxes; i++) {
    ethd_scene_box b;
    if (ethd_scene_box_at(s, i, &b) != ETHD_OK) continue;
    ck_assert(b.of_chain == 1 && b.level >= 1 && b.level <= 4);
    size_t first = found[b.level]++ * edges[b.level];
    for (size_t k = first; k <= first + edges[b.level] && k <= EDGES; k++)
      ck_assert(holds(&b, p[2 * (k % EDGES)], p[2 * (k % EDGES) + 1]));
    ck_assert(b.half_u < 1.01 && b.half_v < 1.01 && (b.level > 1 || b.half_u < 0.0035));
  }
  ck_assert(found[1] == 1000 && found[2] == 125 && found[3] == 16 && found[4] == 2);
  ethd_scene_box b;
  ck_assert_int_eq(ethd_scene_box_at(s, info.boxes, &b), ETHD_STATUS_EMPTY);
  ethd_scene_destroy(s);
}

/* Five chains of different lengths, 10 m apart, and circles between them: each box is that of its own chain, and the
   level that of its own tree. */
TEST(test_boxes_of_several) {
  enum { CHAINS = 5, MOST = 700 };
  static double p[CHAINS][2 * MOST], disc[CHAINS][3];
  const size_t points[CHAINS] = {20, 700, 100, 40, 600}, levels[CHAINS] = {2, 4, 3, 2, 4};
  ethd_object_def o[2 * CHAINS];
  for (int c = 0; c < CHAINS; c++) {
    for (size_t k = 0; k < points[c]; k++) p[c][2 * k] = 10 * c + 0.001 * (double)k, p[c][2 * k + 1] = k % 2 * 0.01;
    disc[c][0] = 10 * c + 5, disc[c][1] = 0, disc[c][2] = 1;
    o[2 * c] = (ethd_object_def){ETHD_SHAPE_POLYLINE, -1, p[c], 2 * points[c], 0};
    o[2 * c + 1] = (ethd_object_def){ETHD_SHAPE_CIRCLE, -1, disc[c], 3, 0};
  }
  ethd_scene_def def = {o, 2 * CHAINS, NULL, 0};
  ethd_scene *s;
  ck_assert_int_eq(ethd_scene_create(&def, &s, NULL), ETHD_OK);
  ethd_scene_info info;
  ethd_scene_describe(s, &info);
  size_t lowest[CHAINS] = {0}, highest[CHAINS] = {0}, objects = 0;
  for (size_t i = 0; i < info.boxes; i++) {
    ethd_scene_box b;
    if (ethd_scene_box_at(s, i, &b) != ETHD_OK) continue;
    if (!b.of_chain) {
      objects += b.level == 1;
      continue;
    }
    int c = (int)floor(b.centre.x / 10 + 0.05);
    ck_assert(c >= 0 && c < CHAINS && b.centre.x - 10 * c < 0.7);
    ck_assert(b.centre.x - 10 * c > -0.01);
    lowest[c] += b.level == 1;
    if ((size_t)b.level > highest[c]) highest[c] = (size_t)b.level;
  }
  ck_assert_uint_eq(objects, 2 * CHAINS);
  for (int c = 0; c < CHAINS; c++) ck_assert(lowest[c] == points[c] - 1 && highest[c] == levels[c]);
  ethd_scene_destroy(s);
}
