/* Trees agree with brute force. make stress asks more: ETHD_SCENE_QUERIES of each kind; ETHD_SCENE_OBJECTS in one
   tree. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "scene_brute.h"
#include "scene_objects.h"
#include "unit/suite.h"

static int queries(void) {
  const char *wanted = getenv("ETHD_SCENE_QUERIES");
  return wanted ? atoi(wanted) : 6000;
}

TEST_LOOP(test_kind, 0, scene_kind_count) {
  scene_seed(1000 + (uint64_t)_i);
  scene_check_kind(&scene_kinds[_i], 1, queries());
}

/* The tolerance grows with the scene, whose numbers are rounded alike. */
TEST_LOOP(test_size, 0, scene_kind_count) {
  static const double sizes[] = {0x1p-30, 0x1p-10, 0x1p10, 0x1p19};
  scene_seed(2000 + (uint64_t)_i);
  for (int i = 0; i < 4; i++) scene_check_kind(&scene_kinds[_i], sizes[i], queries() / 10);
}

/* The same bits from every compiler, with and without its vectors. */
TEST(test_bits) {
  static const struct {
    const char *kind;
    uint64_t hash;
  } expected[] = {{"circles", 0xef25ffb4a1277017},  {"capsules", 0xa404c44faf998228},  {"boxes", 0x0ece58aab813b1fa},
                  {"segments", 0x13044bdef500b14a}, {"polylines", 0xc1dc8b3e90ee90d4}, {"scribble", 0x03843c38c005fbf0},
                  {"lattice", 0xbd1a18dec93146b1}};
  scene_seed(3000);
  for (size_t i = 0; i < sizeof expected / sizeof *expected; i++)
    for (int k = 0; k < scene_kind_count; k++) {
      if (strcmp(scene_kinds[k].name, expected[i].kind) != 0) continue;
      uint64_t hash = scene_hash(&scene_kinds[k], 1000);
      ck_assert_msg(hash == expected[i].hash, "%s: 0x%016llx", expected[i].kind, (unsigned long long)hash);
    }
}

static double seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* A hundred thousand objects are in one tree. */
TEST(test_many) {
  const char *wanted = getenv("ETHD_SCENE_OBJECTS");
  const int many = wanted ? atoi(wanted) : 100000;
  double(*p)[4] = malloc((size_t)many * sizeof *p);
  ethd_object_def *o = malloc((size_t)many * sizeof *o);
  ethd_scene *scene;
  ethd_error error;
  scene_seed(4000);
  for (int i = 0; i < many; i++) {
    p[i][0] = scene_uniform(-1, 1), p[i][1] = scene_uniform(-1, 1);
    p[i][2] = p[i][0] + scene_uniform(-1e-3, 1e-3), p[i][3] = p[i][1] + scene_uniform(-1e-3, 1e-3);
    o[i] = (ethd_object_def){i % 3 ? ETHD_SHAPE_SEGMENT : ETHD_SHAPE_CIRCLE, -1, p[i], i % 3 ? 4 : 3, 0};
    if (i % 3 == 0) p[i][2] = 1e-3;
  }
  ethd_scene_def def = {o, (size_t)many, NULL, 0};
  double start = seconds();
  ck_assert_int_eq(ethd_scene_create(&def, &scene, &error), ETHD_OK);
  double spent = seconds() - start;
  ethd_scene_info info;
  ethd_scene_describe(scene, &info);
  ck_assert_uint_le(info.bytes, 120 * (size_t)many);
  if (wanted)
    printf("%d objects: built in %.3g s of processor time, %.1f MB\n", many, spent, 1e-6 * (double)info.bytes);
  ethd_scene_hint hint = {0};
  for (int i = 0; i < (wanted ? 20 : 200); i++) {
    ethd_vec x = {scene_uniform(-1, 1), 0.3};
    double least = INFINITY;
    ethd_nearest q;
    ethd_scene_query_near(scene, x, &hint, &q);
    for (int k = 0; k < many; k++) {
      ethd_vec a = {p[k][0] - x.x, p[k][1] - x.y}, b = {p[k][2] - p[k][0], p[k][3] - p[k][1]};
      double t = k % 3 ? fmin(1, fmax(0, -ethd_vec_dot(a, b) / ethd_vec_dot(b, b))) : 0;
      least = fmin(least, hypot(a.x + t * b.x, a.y + t * b.y) - (k % 3 ? 0 : 1e-3));
    }
    ck_assert_msg(fabs(q.distance - least) <= 1e-15, "%g, not %g", q.distance, least);
  }
  ethd_scene_destroy(scene);
  free(o);
  free(p);
}
