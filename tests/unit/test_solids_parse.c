/* Solids from text: what is taken, and each refusal with its line and word. */
#include <math.h>
#include <string.h>
#include <strings.h>

#include "ethd/scene.h"
#include "scene/form.h"
#include "unit/solids_rig.h"

TEST(test_every_solid) {
  ethd_solids *s = parse("# a world\nmaterial soft k_e=500 b_e=1.5\n"
                         "sphere 1 2 3 0.5 material=soft\n\n"
                         "halfspace 0 0 -1 0 # the table\r\n"
                         "\tbox 0 0 0 1 2 3\n"
                         "box 10 0 0 2 1 1 0 0 1.5707963267948966 material=hard\n"
                         "material hard k_e=9000\n"
                         "capsule -5 0 0 -5 4 0 .25");
  ethd_solids_info info;
  ethd_solids_describe(s, &info);
  ck_assert(info.objects == 5 && info.materials == 2);
  ck_assert(close_to(info.min, (ethd_vec3){-5.25, -2, -3}) && close_to(info.max, (ethd_vec3){11, 4.25, 3.5}));
  ck_assert(info.bytes > 5 * 32 && info.bytes < 5 * 300 + 2 * sizeof(ethd_material));
  ck_assert_str_eq(ethd_solids_material(s, 1)->name, "hard");
  ck_assert(ethd_solids_material(s, 0)->values[1].value == 1.5 && !ethd_solids_material(s, 2));
  ethd_surface out[8];
  const ethd_vec3 x = {10, 0, 0.5};
  ck_assert_uint_eq(ethd_solids_surfaces(s, NULL, x, INFINITY, out, 8), 5);
  static const int ids[] = {3, 1, 2, 0, 4}, materials[] = {1, -1, -1, 0, -1};
  const double depths[] = {-0.5, 0.5, 9, sqrt(91.25) - 0.5, sqrt(225.25) - 0.25};
  for (int i = 0; i < 5; i++) {
    ck_assert(out[i].id == ids[i] && out[i].material == materials[i] && ethd_vec3_norm(out[i].v) == 0);
    ck_assert_double_eq_tol(depth(&out[i], x), depths[i], 1e-13);
  }
  ethd_solids_destroy(s);
  ethd_solids_destroy(NULL);
}

TEST(test_empty_worlds) {
  static const char *const texts[] = {"", "\n", "#", "material soft\n"};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    ethd_solids *s = parse(texts[i]);
    ethd_solids_info info;
    ethd_solids_describe(s, &info);
    ck_assert(info.objects == 0 && info.min.x > info.max.x && info.min.y > info.max.y && info.min.z > info.max.z);
    ck_assert_uint_eq(ethd_solids_surfaces(s, NULL, (ethd_vec3){0, 0, 0}, INFINITY, NULL, 0), 0);
    ethd_solids_destroy(s);
  }
  ethd_solids *s;
  ck_assert_int_eq(ethd_solids_parse(NULL, 0, &s, NULL), ETHD_OK);
  ethd_solids_destroy(s);
  ck_assert_int_eq(ethd_solids_parse(NULL, 1, &s, NULL), ETHD_E_ARGUMENT);
  ck_assert_ptr_null(s);
}

typedef struct refusal {
  const char *text;
  ethd_status status;
  int line;
  const char *name;
} refusal;

static const refusal refusals[] = {
    {"hello", ETHD_E_UNKNOWN, 1, "hello"},
    {"\nSphere 0 0 0 1", ETHD_E_UNKNOWN, 2, "Sphere"},
    {"sphere 0 0 0 1\ncircle 0 0 1", ETHD_E_UNKNOWN, 2, "circle, a shape of the plane"},
    {"polygon 0 0 1 0 1 1", ETHD_E_UNKNOWN, 1, "polygon, a shape of the plane"},
    {"halfplane 1 0 0", ETHD_E_UNKNOWN, 1, "halfplane, a shape of the plane"},
    {"sphere", ETHD_E_SYNTAX, 1, "numbers after sphere"},
    {"sphere 0 0 1", ETHD_E_SYNTAX, 1, "numbers after sphere"},
    {"sphere 0 0 0 1 1", ETHD_E_SYNTAX, 1, "numbers after sphere"},
    {"halfspace 1 0 0", ETHD_E_SYNTAX, 1, "numbers after halfspace"},
    {"#\n#\ncapsule 0 0 1 1 0.1", ETHD_E_SYNTAX, 3, "numbers after capsule"}, /* as of the plane */
    {"box 0 0 1 1 0.5", ETHD_E_SYNTAX, 1, "numbers after box"},
    {"box 0 0 0 1 1 1 0", ETHD_E_SYNTAX, 1, "numbers after box"},
    {"box 0 0 0 1 1 1 0 0", ETHD_E_SYNTAX, 1, "numbers after box"},
    {"box 0 0 0 1 1 1 0 0 0 0", ETHD_E_SYNTAX, 1, "numbers after box"},
    {"box 0 0 0 1 1 1 0 0 0 0 0 0", ETHD_E_SYNTAX, 1, "numbers after box"},
    {"sphere 0 nan 0 1", ETHD_E_SYNTAX, 1, "nan"},
    {"sphere 0 0 -inf 1", ETHD_E_SYNTAX, 1, "-inf"},
    {"sphere 0 1,5 0 1", ETHD_E_SYNTAX, 1, "1,5"},
    {"sphere 0 0 1e999 1", ETHD_E_NOT_FINITE, 1, "sphere z"},
    {"sphere 0 0 1.01e6 1", ETHD_E_RANGE, 1, "sphere z"},
    {"sphere 0 0 0 0", ETHD_E_RANGE, 1, "sphere r"},
    {"capsule 0 0 0 1 1 1 -1", ETHD_E_RANGE, 1, "capsule r"},
    {"capsule 0 0 0 1 1 2e6 1", ETHD_E_RANGE, 1, "capsule z2"},
    {"box 0 0 0 1 1 0", ETHD_E_RANGE, 1, "box half_z"},
    {"box 0 0 0 1 1 1 0 0 1e7", ETHD_E_RANGE, 1, "box rz"},
    {"halfspace 0 0 0 1", ETHD_E_RANGE, 1, "halfspace |n|"},
    {"\nhalfspace 1 1 0 0", ETHD_E_RANGE, 2, "halfspace |n|"},
    {"halfspace 0 0 1.0000011 0", ETHD_E_RANGE, 1, "halfspace |n|"},
    {"halfspace 0 0 1 2e6", ETHD_E_RANGE, 1, "halfspace c"},
    {"sphere 0 0 0 1 material=soft", ETHD_E_UNKNOWN, 1, "material=soft"},
    {"sphere 0 0 0 1 stuff=soft", ETHD_E_SYNTAX, 1, "stuff=soft"},
    {"material soft\n\nmaterial soft", ETHD_E_DUPLICATE, 3, "soft"},
    {"material soft k_e=1 k_e=2", ETHD_E_DUPLICATE, 1, "k_e"},
    {"material soft k_e=1e999", ETHD_E_NOT_FINITE, 1, "k_e"},
    {"sphere 0 0 0 1\nsphere 0 0 0 \x1b[2J", ETHD_E_SYNTAX, 2, "?[2J"},
};

TEST(test_refusals) {
  for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++) {
    const refusal *r = &refusals[i];
    ethd_solids *s = (ethd_solids *)&s;
    ethd_error error = {.name = ""};
    ethd_status status = ethd_solids_parse(r->text, strlen(r->text), &s, &error);
    ck_assert_msg(status == r->status && error.status == status, "\"%s\": %s", r->text, ethd_status_sentence(status));
    ck_assert_ptr_null(s);
    ck_assert_msg(error.line == r->line && !strcmp(error.name, r->name), "\"%s\": line %d, %s", r->text, error.line,
                  error.name);
    ck_assert_int_eq(ethd_solids_parse(r->text, strlen(r->text), &s, NULL), r->status);
  }
}

TEST(test_numbers_of_refusals) {
  static const struct {
    const char *text;
    double found, min, max;
  } rows[] = {{"sphere 0 0 0 -3", -3, 0, 1e6},  {"sphere 0 2e6 0 3", 2e6, -1e6, 1e6},
              {"sphere 0 0 0", 3, 4, 4},        {"box 1 2 3", 3, 6, 9},
              {"box 1 2 3 4 5 6 7 8", 8, 6, 9}, {"halfspace 0 0 0 0", 0, 1 - 1e-6, 1 + 1e-6}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    ethd_solids *s;
    ethd_error error;
    ck_assert_int_ne(ethd_solids_parse(rows[i].text, strlen(rows[i].text), &s, &error), ETHD_OK);
    ck_assert(error.found == rows[i].found && error.min == rows[i].min && error.max == rows[i].max);
  }
}

/* Words that belong to space alone, in a scene of the plane. */
TEST(test_solids_in_a_scene) {
  static const char *const texts[] = {"sphere 0 0 0 1", "halfspace 1 0 0 0"};
  static const char *const names[] = {"sphere, a shape of space", "halfspace, a shape of space"};
  for (int i = 0; i < 2; i++) {
    ethd_scene *scene;
    ethd_error error;
    ck_assert_int_eq(ethd_scene_parse(texts[i], strlen(texts[i]), &scene, &error), ETHD_E_UNKNOWN);
    ck_assert(error.line == 1 && !strcmp(error.name, names[i]));
  }
}

/* A form's text names its numbers in their order. */
TEST(test_forms) {
  for (size_t i = 0; i < ethd__space.count; i++) {
    const ethd__form *form = ethd__space.form(i);
    char text[80], *rest = text;
    size_t k = 0;
    strcpy(text, form->text);
    for (char *w; (w = strtok_r(rest, " []", &rest)) != NULL; k++)
      ck_assert_int_eq(strcasecmp(w, form->numbers[k].name), 0);
    ck_assert_uint_eq(k, form->step ? form->most : form->count);
  }
}
