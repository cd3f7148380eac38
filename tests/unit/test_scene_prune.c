/* Scenes without what an arm can't reach: the same answers wherever the ring can be, under the same numbers. */
#include <check.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "scene_objects.h"
#include "unit/rig.h"

enum { OBJECTS = 60, ROOM = 64 };

static const ethd_arm arm = {ETHD_ARM_SERIAL, 0.2, 0.12}; /* 0.08 to 0.32 m */
#define RADIUS 0.03

static ethd_scene *draw(void) {
  object o[OBJECTS];
  for (int i = 0; i < OBJECTS; i++) {
    o[i] = scene_random((ethd_shape)(scene_draw() % ETHD_SHAPE_COUNT));
    for (size_t k = 0; k < o[i].count && i % 3; k++) o[i].p[k] *= o[i].shape == ETHD_SHAPE_HALFPLANE ? 1 : 0.5;
  }
  return scene_build(o, OBJECTS);
}

static bool same(const ethd_touch *a, const ethd_touch *b) {
  return a->distance == b->distance && a->point.x == b->point.x && a->point.y == b->point.y && a->n.x == b->n.x &&
         a->n.y == b->n.y && a->object == b->object && a->feature == b->feature && a->side == b->side &&
         a->material == b->material;
}

/* Anywhere the ring can be; or on the rim, as near to an object as it comes. */
static ethd_vec place(const ethd_scene *whole, int i) {
  double r = scene_uniform(0.08, 0.32), angle = scene_uniform(-4, 4);
  if (i < OBJECTS) {
    ethd_touch t;
    ethd_scene_follow(whole, i, (ethd_vec){0, 0}, (ethd_vec){0, 0}, &t);
    r = ethd_vec_norm(t.point) > 0.2 ? 0.32 : 0.08;
    angle = atan2(t.point.y, t.point.x);
  }
  return (ethd_vec){r * cos(angle), r * sin(angle)};
}

static void check_answers(const ethd_scene *whole, const ethd_scene *pruned) {
  ethd_touch a[ROOM], b[ROOM];
  for (int i = 0; i < 2 * OBJECTS; i++) {
    ethd_vec x = place(whole, i);
    size_t n = ethd_scene_touches(whole, x, RADIUS * 0.999999, a, ROOM);
    ck_assert_uint_eq(ethd_scene_touches(pruned, x, RADIUS * 0.999999, b, ROOM), n);
    for (size_t k = 0; k < n && k < ROOM; k++) {
      ethd_touch t, u;
      ck_assert(same(&a[k], &b[k]));
      ethd_vec from = {x.x + scene_uniform(-0.1, 0.1), x.y + scene_uniform(-0.1, 0.1)};
      ethd_scene_follow(whole, a[k].object, x, from, &t);
      ethd_scene_follow(pruned, a[k].object, x, from, &u);
      ck_assert(same(&t, &u));
    }
  }
}

TEST(test_same_answers) {
  size_t dropped = 0;
  scene_seed(950);
  for (int s = 0; s < 300; s++) {
    ethd_scene *whole = draw(), *pruned, *again;
    ethd_error error;
    size_t out = ethd_scene_out_of_reach(whole, &arm, RADIUS);
    ck_assert_int_eq(ethd_scene_prune(whole, &arm, RADIUS, &pruned, &error), ETHD_OK);
    ck_assert_int_eq(pruned != NULL, out > 0);
    if (pruned) {
      ethd_scene_info info;
      ethd_scene_describe(pruned, &info);
      ck_assert(info.objects == OBJECTS - out && info.dropped == out);
      check_answers(whole, pruned);
      ck_assert_int_eq(ethd_scene_prune(pruned, &arm, RADIUS, &again, &error), ETHD_OK);
      ck_assert_ptr_null(again);
    }
    dropped += out;
    ethd_scene_destroy(pruned);
    ethd_scene_destroy(whole);
  }
  ck_assert_int_gt((int)dropped, 1000);
}

/* A radius that isn't a number leaves nothing out: a scene without its walls would be taken for the whole one. */
TEST(test_radius_that_is_none) {
  ethd_scene *whole = draw(), *pruned;
  ethd_error error;
  ck_assert_uint_eq(ethd_scene_out_of_reach(whole, &arm, NAN), 0);
  ck_assert_int_eq(ethd_scene_prune(whole, &arm, NAN, &pruned, &error), ETHD_OK);
  ck_assert_ptr_null(pruned);
  ck_assert_int_eq(ethd_scene_prune(whole, &arm, INFINITY, &pruned, &error), ETHD_OK);
  ck_assert_ptr_null(pruned);
  ethd_scene_destroy(whole);
}

/* Objects come back as they were given, and again from what was built of them. */
TEST(test_objects_come_back) {
  scene_seed(960);
  for (int s = 0; s < 200; s++) {
    object o[8];
    for (int i = 0; i < 8; i++) o[i] = scene_random((ethd_shape)(scene_draw() % ETHD_SHAPE_COUNT));
    ethd_scene *scene = scene_build(o, 8);
    ethd_object_def defs[9];
    for (int i = 0; i < 8; i++) {
      ck_assert_int_eq(ethd_scene_object(scene, (size_t)i, &defs[i]), i);
      ck_assert(defs[i].shape == o[i].shape && defs[i].count == o[i].count && defs[i].material == -1);
      if (o[i].shape != ETHD_SHAPE_HALFPLANE)
        ck_assert(memcmp(defs[i].numbers, o[i].p, o[i].count * sizeof(double)) == 0);
    }
    ck_assert_int_eq(ethd_scene_object(scene, 8, &defs[8]), -1);
    ethd_scene_def def = {defs, 8, NULL, 0};
    ethd_scene *twin;
    ethd_error error;
    ck_assert_int_eq(ethd_scene_create(&def, &twin, &error), ETHD_OK);
    for (int i = 0; i < 8; i++) {
      ethd_object_def again;
      ck_assert_int_eq(ethd_scene_object(twin, (size_t)i, &again), i);
      ck_assert(memcmp(defs[i].numbers, again.numbers, again.count * sizeof(double)) == 0);
    }
    ethd_scene_destroy(twin);
    ethd_scene_destroy(scene);
  }
}

#define FAR_AWAY "circle 9 9 1 material=soft\n"
#define NEAR_BY                                                                                                     \
  "halfplane -1 0 -0.238\npolyline 0.2 0.1 0.236 0.25 0.2 0.4\ncircle 0.26 0.28 0.01 material=soft\nmaterial soft " \
  "k_e=500\n"

static ethd_scene *prune_for(const ethd_setup *setup) {
  ethd_scene *pruned;
  ethd_error error;
  ck_assert_int_eq(ethd_scene_prune(setup->scene, &setup->arm, ethd_setup_range(setup), &pruned, &error), ETHD_OK);
  return pruned;
}

/* A tap gives the same trace but for when the scene was asked. */
TEST(test_same_tap) {
  rig a, b;
  int touched = 0;
  rig_begin(&a, FAR_AWAY FAR_AWAY NEAR_BY, NULL);
  rig_open(&b, FAR_AWAY FAR_AWAY NEAR_BY);
  ethd_scene *pruned = prune_for(&b.setup);
  b.setup.scene = pruned;
  rig_start(&b);
  for (int tick = 0; tick < 2000; tick++) {
    double d = 0.02 * cos(0.01 * tick) + 0.015;
    motion m = rig_at(d, 0.2 * sin(0.01 * tick), 0.003);
    m.x.y = m.xf.y = 0.25 + 0.03 * sin(0.003 * tick);
    rig_step(&a, &m);
    rig_step(&b, &m);
    touched += a.trace.contacts > 0;
    b.trace.queried = a.trace.queried;
    ck_assert(memcmp(&a.trace, &b.trace, sizeof a.trace) == 0);
    ck_assert(a.trace.contacts == 0 || a.trace.object >= 2);
  }
  ck_assert_int_gt(touched, 300);
  rig_close(&a);
  rig_close(&b);
  ethd_scene_destroy(pruned);
}

static ethd_status check_links(const ethd_setup *base, ethd_scene *scene, double link1, double link2) {
  ethd_setup setup = *base;
  ethd_error error;
  setup.scene = scene;
  setup.arm.link1 = link1;
  setup.arm.link2 = link2;
  return ethd_setup_check(&setup, &error);
}

/* An arm reaches from |l1 - l2| to l1 + l2: each end of it is held alone. */
TEST(test_both_ends) {
  rig r;
  rig_open(&r, "circle 0 0 0.001\n" FAR_AWAY NEAR_BY);
  r.setup.arm.link1 = 0.3;
  r.setup.arm.link2 = 0.2;
  ethd_scene *pruned = prune_for(&r.setup);
  ck_assert_int_eq(check_links(&r.setup, pruned, 0.3, 0.2), ETHD_OK);
  ck_assert_int_eq(check_links(&r.setup, pruned, 0.31, 0.19), ETHD_OK);
  ck_assert_int_eq(check_links(&r.setup, pruned, 0.29, 0.21), ETHD_E_RANGE);
  ck_assert_int_eq(check_links(&r.setup, pruned, 0.31, 0.21), ETHD_E_RANGE);
  ethd_scene_destroy(pruned);
  rig_close(&r);
}

/* A larger ring or arm would miss what was dropped for the smaller one; a body may come from anywhere. */
TEST(test_refused_elsewhere) {
  rig r;
  ethd_error error;
  rig_open(&r, FAR_AWAY NEAR_BY);
  ethd_scene *pruned = prune_for(&r.setup);
  ethd_setup setup = r.setup;
  setup.scene = pruned;
  ck_assert_int_eq(ethd_setup_check(&setup, &error), ETHD_OK);
  setup.ring_radius *= 1.1;
  ck_assert_int_eq(ethd_setup_check(&setup, &error), ETHD_E_RANGE);
  ck_assert_ptr_nonnull(strstr(error.name, "pruned"));
  setup = r.setup;
  setup.scene = pruned;
  setup.arm.link1 = 0.26;
  ck_assert_int_eq(ethd_setup_check(&setup, &error), ETHD_E_RANGE);
  setup = r.setup;
  setup.bodies[1] = pruned;
  ck_assert_int_eq(ethd_setup_check(&setup, &error), ETHD_E_RANGE);
  setup.bodies[1] = r.scene;
  ck_assert_int_eq(ethd_setup_check(&setup, &error), ETHD_OK);
  ethd_scene_destroy(pruned);
  rig_close(&r);
}
