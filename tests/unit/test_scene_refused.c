/* Scenes as structs that contradict themselves, and collinear edges: refused before a number of theirs is read. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "unit/rig.h"

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
