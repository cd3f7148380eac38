/* Scenes as structs: what is refused, and large ones. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "ethd/scene.h"
#include "unit/draw.h"
#include "unit/suite.h"

static ethd_error error;

static ethd_status create(const ethd_scene_def *def) {
  ethd_scene *scene = (ethd_scene *)&error;
  ethd_status status = ethd_scene_create(def, &scene, &error);
  if (status < 0) ck_assert_ptr_null(scene);
  if (status < 0) ck_assert_int_eq(error.status, status);
  if (!status) ethd_scene_destroy(scene);
  ck_assert_int_eq(ethd_scene_create(def, &scene, NULL), status);
  if (!status) ethd_scene_destroy(scene);
  return status;
}

static ethd_status one(ethd_shape shape, int32_t material, const double *numbers, size_t count) {
  const ethd_object_def object = {shape, material, numbers, count, 7};
  return create(&(ethd_scene_def){&object, 1, NULL, 0});
}

/* What a text can't say; what it can is refused in test_scene_parse.c. */
static const struct {
  ethd_status status;
  ethd_shape shape;
  size_t count;
  double p[16];
} numbers[] = {
    {ETHD_E_NOT_FINITE, ETHD_SHAPE_CIRCLE, 3, {NAN, 0, 1}},
    {ETHD_E_NOT_FINITE, ETHD_SHAPE_CIRCLE, 3, {0, 0, INFINITY}},
    {ETHD_E_NOT_FINITE, ETHD_SHAPE_BOX, 5, {0, 0, 1, 1, NAN}},
    {ETHD_E_ARGUMENT, ETHD_SHAPE_CIRCLE, 2, {0, 0}},
    {ETHD_E_ARGUMENT, ETHD_SHAPE_CIRCLE, 4, {0, 0, 1, 1}},
    {ETHD_E_ARGUMENT, ETHD_SHAPE_POLYGON, 4, {0, 0, 1, 1}},
    {ETHD_E_ARGUMENT, ETHD_SHAPE_POLYGON, 7, {0, 0, 1, 0, 1, 1, 0}},
    {ETHD_E_ARGUMENT, ETHD_SHAPE_POLYLINE, 2, {0, 0}},
    {ETHD_E_ARGUMENT, ETHD_SHAPE_SEGMENT, 6, {0, 0, 1, 1, 2, 2}},
    {ETHD_E_GEOMETRY, ETHD_SHAPE_SEGMENT, 4, {1, 1, 1, 1.0000000000000002}},
    {ETHD_OK, ETHD_SHAPE_POLYLINE, 8, {0, 0, 1, 1, 1, 0, 0, 1}},
    {ETHD_OK, ETHD_SHAPE_POLYGON, 8, {0, 0, 1, 0, 2, 0, 1, 1}}, /* a straight vertex */
    {ETHD_OK, ETHD_SHAPE_CAPSULE, 5, {1, 1, 1, 1, 0.1}},
    {ETHD_OK, ETHD_SHAPE_CIRCLE, 3, {1e6, -1e6, 1e6}},
};
TEST(test_numbers) {
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
    ck_assert_msg(one(numbers[i].shape, -1, numbers[i].p, numbers[i].count) == numbers[i].status, "%zu: %s", i,
                  ethd_status_sentence(error.status));
    if (numbers[i].status) ck_assert(error.line == 7 && error.name[0]);
  }
  const double circle[] = {0, 0, 1};
  ck_assert_int_eq(one(ETHD_SHAPE_CIRCLE, 0, circle, 3), ETHD_E_RANGE);
  ck_assert_int_eq(one(ETHD_SHAPE_CIRCLE, -2, circle, 3), ETHD_E_RANGE);
}

TEST(test_arrays_that_are_missing) {
  ck_assert_int_eq(create(&(ethd_scene_def){NULL, 1, NULL, 0}), ETHD_E_ARGUMENT);
  ck_assert_str_eq(error.name, "scene");
  ck_assert_int_eq(create(&(ethd_scene_def){NULL, 0, NULL, 1}), ETHD_E_ARGUMENT);
  ck_assert_int_eq(create(&(ethd_scene_def){NULL, 0, NULL, 0}), ETHD_OK);
  ck_assert_int_eq(one(ETHD_SHAPE_CIRCLE, -1, NULL, 3), ETHD_E_ARGUMENT);
  ck_assert(strcmp(error.name, "numbers") == 0 && error.line == 7);
}

TEST(test_shapes_that_are_none) {
  const double p[] = {0, 0, 1};
  const ethd_shape none[] = {(ethd_shape)-1, ETHD_SHAPE_COUNT};
  for (int i = 0; i < 2; i++) {
    ck_assert_int_eq(one(none[i], -1, p, 3), ETHD_E_UNKNOWN);
    ck_assert(strcmp(error.name, "shape") == 0 && error.line == 7);
    ck_assert_str_eq(ethd_shape_name(none[i]), "");
    ck_assert_str_eq(ethd_shape_form(none[i]), "");
  }
}

/* No room is asked for points that can't be: the count is far over what a number may have. */
TEST(test_count_that_cannot_be) {
  const double p[] = {0, 0, 1};
  ck_assert_int_eq(one(ETHD_SHAPE_POLYGON, 5, p, (size_t)1 << 33), ETHD_E_RANGE);
  ck_assert_str_eq(error.name, "material");
}

TEST(test_names_without_an_end) {
  ethd_material m = {.name = "soft", .count = 1, .line = 3, .values = {{"k_e", 500}}};
  const ethd_scene_def def = {NULL, 0, &m, 1};
  ck_assert_int_eq(create(&def), ETHD_OK);
  memset(m.values[0].name, 'x', sizeof m.values[0].name);
  ck_assert_int_eq(create(&def), ETHD_E_ARGUMENT);
  ck_assert(strcmp(error.name, "soft") == 0 && error.line == 3);
  memset(m.name, 'x', sizeof m.name);
  ck_assert_int_eq(create(&def), ETHD_E_ARGUMENT);
  ck_assert_str_eq(error.name, "material");
  m.name[0] = 0;
  ck_assert_int_eq(create(&def), ETHD_E_ARGUMENT);
  ck_assert_str_eq(error.name, "material");
}

TEST(test_materials_of_structs) {
  static ethd_material m[ETHD_MATERIALS_MAX + 1];
  double circle[3] = {0, 0, 1};
  ethd_object_def o = {ETHD_SHAPE_CIRCLE, 1, circle, 3, 0};
  ethd_scene *scene;
  for (int i = 0; i <= ETHD_MATERIALS_MAX; i++)
    m[i] = (ethd_material){.name = {(char)('A' + i)}, .count = 1, .line = i, .values = {{"k", 0}}};
  ethd_scene_def def = {&o, 1, m, ETHD_MATERIALS_MAX};
  ck_assert_int_eq(ethd_scene_create(&def, &scene, &error), ETHD_OK);
  ethd_touch t;
  ck_assert_uint_eq(ethd_scene_touches(scene, (ethd_vec){0, 0}, 0, &t, 1), 1);
  ck_assert_int_eq(t.material, 1);
  ck_assert_str_eq(ethd_scene_material(scene, 1)->name, "B");
  ck_assert_ptr_null(ethd_scene_material(scene, ETHD_MATERIALS_MAX));
  ethd_scene_destroy(scene);
  def.material_count++;
  ck_assert_int_eq(ethd_scene_create(&def, &scene, &error), ETHD_E_FULL);
  ck_assert(error.found == ETHD_MATERIALS_MAX + 1 && error.min == 0 && error.max == ETHD_MATERIALS_MAX);
  def.material_count = 1;
  ck_assert_int_eq(ethd_scene_create(&def, &scene, &error), ETHD_E_RANGE); /* the circle's is the second */
  ck_assert(error.found == 1 && error.min == -1 && error.max == 0);
  def.material_count = 3;
  m[2].name[0] = 'A';
  ck_assert_int_eq(ethd_scene_create(&def, &scene, &error), ETHD_E_DUPLICATE);
  ck_assert_int_eq(error.line, 2);
  m[2] = (ethd_material){.name = "C", .count = ETHD_PARAMS_MAX + 1};
  ck_assert_int_eq(ethd_scene_create(&def, &scene, &error), ETHD_E_FULL);
  m[2] = (ethd_material){.name = "C", .count = 2, .values = {{"k", 1}, {"k", 2}}};
  ck_assert_int_eq(ethd_scene_create(&def, &scene, &error), ETHD_E_DUPLICATE);
  for (int i = 0; i < 2; i++) {
    m[2] = (ethd_material){.name = "C", .count = 1, .values = {{"k", i ? NAN : INFINITY}}};
    ck_assert_int_eq(ethd_scene_create(&def, &scene, &error), ETHD_E_NOT_FINITE);
  }
}

/* Edges on one line: apart, touching at a point, and one within the other. */
TEST(test_edges_on_one_line) {
  static const struct {
    double p[16];
    int count, meet;
  } cases[] = {
      {{0, 0, 1, 0, 1, 1, 2, 1, 2, 0, 3, 0, 3, 2, 0, 2}, 8, 0},   /* 0-1 and 2-3 of the base */
      {{0, 0, 2, 0, 2, 1, 1, 1, 1, 0, 3, 0, 3, 2, 0, 2}, 8, 1},   /* 0-2 and 1-3 */
      {{3, 0, 0, 0, 0, 2, 3, 2, 3, 1, 1, 1, 1, 0, 2, 0}, 8, 1},   /* 2 lies within 0-3 */
      {{0, 0, 0, 1, 1, 1, 1, 2, 0, 2, 0, 3, 2, 3, 2, 0}, 8, 0},   /* upright, apart */
      {{0, 0, 0, 2, 1, 2, 1, 1, 0, 1, 0, 3, 2, 3, 2, 0}, 8, 1},   /* upright, overlapping */
      {{0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 0, 3, -1, 3, -1, 0}, 8, 0}, /* on a diagonal, apart */
      {{0, 0, 2, 2, 1, 3, 1, 1, 3, 3, 0, 5, -1, 5, -1, 0}, 8, 1}, /* on a diagonal, overlapping */
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    ck_assert_msg(one(ETHD_SHAPE_POLYGON, -1, cases[i].p, 2 * (size_t)cases[i].count) ==
                      (cases[i].meet ? ETHD_E_GEOMETRY : ETHD_OK),
                  "case %zu: %s", i, error.name);
    double back[16];
    for (int k = 0; k < 8; k++) back[2 * k] = cases[i].p[14 - 2 * k], back[2 * k + 1] = cases[i].p[15 - 2 * k];
    ck_assert_int_eq(one(ETHD_SHAPE_POLYGON, -1, back, 16), cases[i].meet ? ETHD_E_GEOMETRY : ETHD_OK);
  }
}

/* Two points of a round that have changed places. */
TEST(test_edges_by_number) {
  enum { POINTS = 240 };
  double p[2 * POINTS];
  for (int k = 0; k < POINTS; k++) {
    int at = k == 120 ? 121 : k == 121 ? 120 : k;
    p[2 * k] = cos(at * 0.026), p[2 * k + 1] = sin(at * 0.026);
  }
  ck_assert_int_eq(one(ETHD_SHAPE_POLYGON, -1, p, 2 * POINTS), ETHD_E_GEOMETRY);
  ck_assert_str_eq(error.name, "polygon: edges 119 and 121 meet");
  for (int k = 0; k < POINTS / 2; k++)
    for (int i = 0; i < 2; i++) {
      double *a = &p[2 * k + i], *b = &p[2 * (POINTS - 1 - k) + i], t = *a;
      *a = *b, *b = t;
    }
  ck_assert_int_eq(one(ETHD_SHAPE_POLYGON, -1, p, 2 * POINTS), ETHD_E_GEOMETRY);
  ck_assert_str_eq(error.name, "polygon: edges 117 and 119 meet");
}

/* Half a million objects and a polygon of 100 000 points, built and asked. */
TEST(test_large) {
  enum { OBJECTS = 500000, N = 100000 };
  ethd_object_def *o = calloc(OBJECTS, sizeof *o);
  double *p = malloc((size_t)OBJECTS * 4 * sizeof *p), *q = malloc(2 * N * sizeof *q);
  for (size_t i = 0; i < OBJECTS; i++) {
    for (size_t k = 0; k < 4; k++) p[4 * i + k] = draw(4 * i + k, -1, 1);
    o[i] = (ethd_object_def){ETHD_SHAPE_SEGMENT, -1, p + 4 * i, 4, 0};
  }
  for (size_t k = 0; k < N; k++) {
    double a = 2 * M_PI * (double)k / N;
    q[2 * k] = 5 + cos(a), q[2 * k + 1] = sin(a);
  }
  o[OBJECTS - 1] = (ethd_object_def){ETHD_SHAPE_POLYGON, -1, q, 2 * N, 0};
  ethd_scene_def def = {o, OBJECTS, NULL, 0};
  ethd_scene *s;
  ck_assert_int_eq(ethd_scene_create(&def, &s, NULL), ETHD_OK);
  ethd_nearest nearest;
  ethd_scene_query(s, (ethd_vec){5.5, 0}, &nearest);
  ck_assert_int_eq(nearest.object, OBJECTS - 1);
  ck_assert(fabs(nearest.distance + 0.5 * cos(0)) < 1e-9);
  ethd_scene_query(s, (ethd_vec){3, 0}, &nearest);
  ck_assert(fabs(nearest.distance - 1) < 1e-9 && nearest.object == OBJECTS - 1);
  ethd_scene_destroy(s);
  free(o);
  free(p);
  free(q);
}
