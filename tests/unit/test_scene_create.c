/* What a scene may be made of, and large ones. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene_objects.h"
#include "unit/suite.h"

/* ---- refusals of structs ---- */

static ethd_status create(ethd_shape shape, size_t count, const double *p, int32_t material, ethd_error *error) {
  ethd_object_def o = {shape, material, p, count, 7};
  ethd_scene_def def = {&o, 1, NULL, 0};
  ethd_scene *scene = (ethd_scene *)&o;
  ethd_status status = ethd_scene_create(&def, &scene, error);
  ck_assert((status == ETHD_OK) == (scene != NULL));
  ethd_scene_destroy(scene);
  return status;
}

typedef struct refusal {
  ethd_status status;
  ethd_shape shape;
  size_t count;
  double p[16];
} refusal;

static const refusal refusals[] = {
    {ETHD_E_NOT_FINITE, ETHD_SHAPE_CIRCLE, 3, {NAN, 0, 1}},
    {ETHD_E_NOT_FINITE, ETHD_SHAPE_CIRCLE, 3, {0, 0, INFINITY}},
    {ETHD_E_RANGE, ETHD_SHAPE_CIRCLE, 3, {1.0001e6, 0, 1}},
    {ETHD_E_RANGE, ETHD_SHAPE_CIRCLE, 3, {0, 0, 0}},
    {ETHD_E_RANGE, ETHD_SHAPE_CIRCLE, 3, {0, 0, -1}},
    {ETHD_E_RANGE, ETHD_SHAPE_CIRCLE, 3, {0, 0, 1e9}},
    {ETHD_E_RANGE, ETHD_SHAPE_BOX, 5, {0, 0, 0, 1, 0}},
    {ETHD_E_RANGE, ETHD_SHAPE_BOX, 5, {0, 0, 1, -1, 0}},
    {ETHD_E_NOT_FINITE, ETHD_SHAPE_BOX, 5, {0, 0, 1, 1, NAN}},
    {ETHD_E_RANGE, ETHD_SHAPE_CAPSULE, 5, {0, 0, 1, 1, 0}},
    {ETHD_E_RANGE, ETHD_SHAPE_HALFPLANE, 3, {0, 0, 1}},
    {ETHD_E_RANGE, ETHD_SHAPE_HALFPLANE, 3, {1.000002, 0, 1}},
    {ETHD_E_RANGE, ETHD_SHAPE_HALFPLANE, 3, {0.6, 0.7, 1}},
    {ETHD_E_RANGE, ETHD_SHAPE_HALFPLANE, 3, {1, 0, 2e6}},
    {ETHD_E_ARGUMENT, ETHD_SHAPE_CIRCLE, 2, {0, 0}},
    {ETHD_E_ARGUMENT, ETHD_SHAPE_CIRCLE, 4, {0, 0, 1, 1}},
    {ETHD_E_ARGUMENT, ETHD_SHAPE_POLYGON, 4, {0, 0, 1, 1}},
    {ETHD_E_ARGUMENT, ETHD_SHAPE_POLYGON, 7, {0, 0, 1, 0, 1, 1, 0}},
    {ETHD_E_ARGUMENT, ETHD_SHAPE_POLYLINE, 2, {0, 0}},
    {ETHD_E_ARGUMENT, ETHD_SHAPE_SEGMENT, 6, {0, 0, 1, 1, 2, 2}},
    {ETHD_E_GEOMETRY, ETHD_SHAPE_SEGMENT, 4, {0.5, 1, 0.5, 1}},
    {ETHD_E_GEOMETRY, ETHD_SHAPE_SEGMENT, 4, {1, 1, 1, 1.0000000000000002}},
    {ETHD_E_GEOMETRY, ETHD_SHAPE_POLYLINE, 6, {0, 0, 1, 1, 1, 1}},
    {ETHD_E_GEOMETRY, ETHD_SHAPE_POLYGON, 8, {0, 0, 1, 0, 1, 1, 0, 0}},
    {ETHD_E_GEOMETRY, ETHD_SHAPE_POLYGON, 8, {0, 0, 1, 0, 1, 0, 0, 1}},
    {ETHD_E_GEOMETRY, ETHD_SHAPE_POLYGON, 6, {0, 0, 1, 1, 2, 2}},
    {ETHD_E_GEOMETRY, ETHD_SHAPE_POLYGON, 8, {0, 0, 1, 1, 1, 0, 0, 1}},
    {ETHD_E_GEOMETRY, ETHD_SHAPE_POLYGON, 10, {0, 0, 2, 0, 2, 2, 1, 0, 0, 2}},       /* a vertex on an edge */
    {ETHD_E_GEOMETRY, ETHD_SHAPE_POLYGON, 12, {0, 0, 1, 1, 2, 0, 2, 2, 1, 1, 0, 2}}, /* a vertex twice */
    {ETHD_E_GEOMETRY, ETHD_SHAPE_POLYGON, 8, {0, 0, 2, 0, 1, 0, 1, 1}},              /* back over itself */
    {ETHD_OK, ETHD_SHAPE_POLYLINE, 8, {0, 0, 1, 1, 1, 0, 0, 1}},
    {ETHD_OK, ETHD_SHAPE_POLYGON, 8, {0, 0, 1, 0, 2, 0, 1, 1}}, /* a straight vertex */
    {ETHD_OK, ETHD_SHAPE_CAPSULE, 5, {1, 1, 1, 1, 0.1}},
    {ETHD_OK, ETHD_SHAPE_CIRCLE, 3, {1e6, -1e6, 1e6}},
};

TEST(test_refusals) {
  for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++) {
    const refusal *r = &refusals[i];
    ethd_error error = {.line = -1};
    ethd_status status = create(r->shape, r->count, r->p, -1, &error);
    ck_assert_msg(status == r->status, "%zu: %s", i, ethd_status_sentence(status));
    if (!status) continue;
    ck_assert(error.status == status && error.line == 7 && error.name[0]);
    ck_assert_int_eq(create(r->shape, r->count, r->p, -1, NULL), r->status);
  }
  double circle[3] = {0, 0, 1};
  ethd_error error;
  ck_assert_int_eq(create(ETHD_SHAPE_COUNT, 3, circle, -1, &error), ETHD_E_UNKNOWN);
  ck_assert_int_eq(create((ethd_shape)99, 3, circle, -1, &error), ETHD_E_UNKNOWN);
  ck_assert_int_eq(create(ETHD_SHAPE_CIRCLE, 3, NULL, -1, &error), ETHD_E_ARGUMENT);
  ck_assert_int_eq(create(ETHD_SHAPE_CIRCLE, 3, circle, 0, &error), ETHD_E_RANGE);
  ck_assert_int_eq(create(ETHD_SHAPE_CIRCLE, 3, circle, -2, &error), ETHD_E_RANGE);
}

TEST(test_materials_of_structs) {
  static ethd_material m[ETHD_MATERIALS_MAX + 1];
  double circle[3] = {0, 0, 1};
  ethd_object_def o = {ETHD_SHAPE_CIRCLE, 1, circle, 3, 0};
  ethd_scene *scene;
  ethd_error error;
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
  def.material_count = 3;
  m[2].name[0] = 'A';
  ck_assert_int_eq(ethd_scene_create(&def, &scene, &error), ETHD_E_DUPLICATE);
  ck_assert_int_eq(error.line, 2);
  memset(m[2].name, 'x', sizeof m[2].name);
  ck_assert_int_eq(ethd_scene_create(&def, &scene, &error), ETHD_E_ARGUMENT);
  m[2] = (ethd_material){.name = "C", .count = ETHD_PARAMS_MAX + 1};
  ck_assert_int_eq(ethd_scene_create(&def, &scene, &error), ETHD_E_FULL);
  m[2] = (ethd_material){.name = "C", .count = 2, .values = {{"k", 1}, {"k", 2}}};
  ck_assert_int_eq(ethd_scene_create(&def, &scene, &error), ETHD_E_DUPLICATE);
  m[2] = (ethd_material){.name = "C", .count = 1, .values = {{"k", NAN}}};
  ck_assert_int_eq(ethd_scene_create(&def, &scene, &error), ETHD_E_NOT_FINITE);
}

static ethd_nearest at(const ethd_scene *scene, double x, double y) {
  ethd_nearest q;
  ethd_scene_query(scene, (ethd_vec){x, y}, &q);
  return q;
}

/* Half a million objects and a polygon of 100 000 points, built and asked. */
TEST(test_large) {
  enum { OBJECTS = 500000, N = 100000 };
  ethd_object_def *o = calloc(OBJECTS, sizeof *o);
  double *p = malloc((size_t)OBJECTS * 4 * sizeof *p), *q = malloc(2 * N * sizeof *q);
  scene_seed(1000);
  for (size_t i = 0; i < OBJECTS; i++) {
    for (int k = 0; k < 4; k++) p[4 * i + (size_t)k] = scene_uniform(-1, 1);
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
  ethd_nearest nearest = at(s, 5.5, 0);
  ck_assert_int_eq(nearest.object, OBJECTS - 1);
  ck_assert(fabs(nearest.distance + 0.5 * cos(0)) < 1e-9);
  nearest = at(s, 3, 0);
  ck_assert(fabs(nearest.distance - 1) < 1e-9 && nearest.object == OBJECTS - 1);
  ethd_scene_destroy(s);
  free(o);
  free(p);
  free(q);
}
