/* Details that a small bug would change and that no other test looks at: found by changing lib at random
   (tests/mutation.sh). */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/check.h"
#include "unit/rig.h"

static ethd_error error;

/* ---- scenes' text ---- */

static ethd_status parse(const char *text) {
  ethd_scene *scene;
  ethd_status status = ethd_scene_parse(text, strlen(text), &scene, &error);
  if (!status) ethd_scene_destroy(scene);
  return status;
}

TEST(test_words_that_are_no_numbers) {
  const char *const words[] = {"1+5", "15A3", "1#", "1d5", "1E", "1e+", "e5", ".e1", "-", "+", "-.", "1e5.", "1\x02"};
  char text[64];
  for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
    snprintf(text, sizeof text, "circle 0 %s 1", words[i]);
    if (words[i][1] == '#') continue; /* a comment */
    ck_assert_msg(parse(text) == ETHD_E_SYNTAX, "%s is taken", words[i]);
  }
  ck_assert_int_eq(parse("circle\x01"
                         "0 0 1"),
                   ETHD_E_UNKNOWN);
  ck_assert_int_eq(parse("circle 0\b0 1"), ETHD_E_SYNTAX);
}

TEST(test_exponents) {
  static const struct {
    const char *text;
    double value;
  } cases[] = {{"1e5", 1e5}, {"1e-5", 1e-5}, {"25E+3", 25e3}, {"1e00000000005", 1e5}, {"100000e-4", 10}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char text[64];
    ethd_scene *scene;
    ethd_object_def def;
    snprintf(text, sizeof text, "circle 0 %s 1", cases[i].text);
    ck_assert_int_eq(ethd_scene_parse(text, strlen(text), &scene, &error), ETHD_OK);
    ck_assert_int_eq(ethd_scene_object(scene, 0, &def), 0);
    ck_assert(def.numbers[1] == cases[i].value);
    ethd_scene_destroy(scene);
  }
}

/* What an error says of numbers: what was found, and what is allowed. */
TEST(test_errors_say_numbers) {
  char text[8192] = "material m";
  for (int i = 0; i <= ETHD_PARAMS_MAX; i++) snprintf(text + strlen(text), 16, " k%d=1", i);
  ck_assert_int_eq(parse(text), ETHD_E_FULL);
  ck_assert(error.found == ETHD_PARAMS_MAX + 1 && error.min == 0 && error.max == ETHD_PARAMS_MAX);
  *text = 0;
  for (int i = 0; i <= ETHD_MATERIALS_MAX; i++) snprintf(text + strlen(text), 24, "material m%d k=1\n", i);
  ck_assert_int_eq(parse(text), ETHD_E_FULL);
  ck_assert(error.found == ETHD_MATERIALS_MAX + 1 && error.min == 0 && error.max == ETHD_MATERIALS_MAX);
  static ethd_material many[ETHD_MATERIALS_MAX + 1];
  ethd_scene *scene;
  ck_assert_int_eq(ethd_scene_create(&(ethd_scene_def){NULL, 0, many, ETHD_MATERIALS_MAX + 1}, &scene, &error),
                   ETHD_E_FULL);
  ck_assert(error.found == ETHD_MATERIALS_MAX + 1 && error.min == 0 && error.max == ETHD_MATERIALS_MAX);
  ck_assert_int_eq(parse("halfplane 1 1 0"), ETHD_E_RANGE);
  ck_assert(error.found == sqrt(2) && error.min == 1 - 1e-6 && error.max == 1 + 1e-6);
}

/* A polygon that comes to a point twice: the message names both visits. */
TEST(test_same_point_twice) {
  const double p[] = {0, 0, 2, 0, 1, 1, 2, 2, 0, 2, 1, 1};
  char room[1024];
  size_t meet[2] = {99, 99};
  ck_assert(!ethd__is_simple(p, 6, room, meet));
  ck_assert((meet[0] == 2 && meet[1] == 5) || (meet[0] == 5 && meet[1] == 2));
}

/* ---- ranges ---- */

TEST(test_bounds_of_numbers) {
  static const struct {
    const char *name;
    double most;
  } bounds[] = {{"transition.memory", 0.99}, {"loop.period", 0.1}};
  ethd_setup s = ethd_setup_default();
  ethd_setup_transition(&s, &ethd_transition_predictive);
  for (size_t i = 0; i < sizeof bounds / sizeof *bounds; i++) {
    ck_assert_int_eq(ethd_setup_set(&s, bounds[i].name, bounds[i].most * 1.01, &error), ETHD_E_RANGE);
    ck_assert_double_eq(error.max, bounds[i].most);
  }
  ethd_velocity v;
  ck_assert_int_eq(ethd_velocity_prepare(s.velocity, s.velocity_p, 1.05, &v, &error), ETHD_E_RANGE);
  ck_assert(error.max == 1 && error.min == 1e-6);
}

/* ---- a tick ---- */

static ethd_sense sense_at(const rig *r, double d) {
  motion m = rig_at(d, 0, 0);
  ethd_sense s = rig_sense(&r->setup.arm, &m);
  s.time_ns = r->sense.time_ns + 1000000;
  return s;
}

/* Each number of a body's pose is looked at; so is each joint's range, on both sides. */
TEST(test_every_number_is_looked_at) {
  for (int k = 0; k < 6; k++) {
    rig r;
    rig_open(&r, NULL);
    ethd_scene *body = rig_scene(RIG_WALL);
    r.setup.bodies[0] = body;
    rig_start(&r);
    ethd_sense s = sense_at(&r, 0.02);
    s.have |= ETHD_HAVE_BODY;
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    s.bodies[k] = 1e12;
    ck_assert_int_lt(rig_try(&r, &s), 0);
    ck_assert_int_eq(r.trace.fault, ETHD_FAULT_INPUT);
    rig_close(&r);
    ethd_scene_destroy(body);
  }
  for (int k = 0; k < 4; k++) {
    rig r;
    rig_open(&r, NULL);
    rig_start(&r);
    ethd_sense s = sense_at(&r, 0.02);
    r.setup.limits.joints[k] = s.q[k / 2] + (k % 2 ? -0.01 : 0.01);
    rig_post(&r);
    ck_assert_int_lt(rig_try(&r, &s), 0);
    ck_assert_int_eq(r.trace.fault, ETHD_FAULT_WORKSPACE);
    rig_close(&r);
  }
}

/* ---- which law runs ---- */

static const ethd_control *asked;
static const ethd_law *answers[2];

static ethd_status rule(const double *p, void *state, const ethd_contact *c, ethd_ruling *out) {
  (void)p, (void)state, (void)c;
  out->share = 1;
  answers[0] = ethd_control_law(asked);
  return ETHD_OK;
}

static ethd_status push(const double *p, void *state, double gap, double speed, int entering, double *force) {
  (void)p, (void)state, (void)gap, (void)speed, (void)entering;
  *force = 0;
  answers[1] = ethd_control_law(asked);
  return ETHD_OK;
}

TEST(test_law_of_each_kind) {
  ethd_transition_law ruling = ethd_transition_smooth;
  ethd_contact_law pushing = ethd_contact_spring;
  ruling.step = rule;
  pushing.step = push;
  rig r;
  rig_open(&r, "halfplane -1 0 -0.238\nhalfplane 0 -1 -0.238\n");
  ethd_setup_transition(&r.setup, &ruling);
  ethd_setup_contact(&r.setup, &pushing);
  rig_start(&r);
  asked = r.control;
  motion m = {{0.249, 0.249}, {0, 0}, {0.249, 0.249}, {0, 0}};
  rig_step(&r, &m);
  ck_assert_int_eq(r.trace.contacts, 2);
  ck_assert_ptr_eq(answers[0], &ruling.law);
  ck_assert_ptr_eq(answers[1], &pushing.law);
  rig_close(&r);
}

/* ---- the finger's fit ---- */

/* A polygon far from its first vertex's middle is judged by its area over its extent: a sliver is none. */
TEST(test_slivers) {
  ethd_fit fit;
  ethd_setup s = ethd_setup_default();
  ck_assert_int_eq(ethd_fit_prepare(ETHD_FIT_CENTROID, s.fit_p, 0.012, 0.0075, &fit, NULL), ETHD_OK);
  ethd_finger finger;
  double r[ETHD_RAYS];
  for (int k = 0; k < ETHD_RAYS; k++) r[k] = k % 8 ? (double)NAN : 0.0045; /* two, opposite */
  ck_assert_int_eq(ethd_fit_step(&fit, r, &finger), ETHD_STATUS_STALE);
  r[4] = 0.012 - 1e-14; /* a third one on the line between them, up to rounding */
  ck_assert_int_eq(ethd_fit_step(&fit, r, &finger), ETHD_STATUS_STALE);
  r[4] = 0.0045;
  ck_assert_int_eq(ethd_fit_step(&fit, r, &finger), ETHD_OK);
}
