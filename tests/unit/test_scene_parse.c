/* Scenes from text: what is taken, and each refusal with its line and word. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ethd/scene.h"
#include "unit/draw.h"
#include "unit/suite.h"

static ethd_scene *parse(const char *text) {
  ethd_scene *scene;
  ethd_error error = {.name = ""};
  ethd_status status = ethd_scene_parse(text, strlen(text), &scene, &error);
  ck_assert_msg(status == ETHD_OK, "line %d, %s: %s", error.line, error.name, ethd_status_sentence(status));
  return scene;
}

TEST(test_every_shape) {
  ethd_scene *s = parse("# a scene\n"
                        "halfplane -1 0 -0.238\n"
                        "\tcircle 1 2 3   # a comment\r\n"
                        "\n"
                        "capsule 0 0 1 1 .5\n"
                        "box 1 2 3 4 0.5\n"
                        "polygon 0 0 1 0 1 1\n"
                        "segment 0 0 1 1\n"
                        "polyline 0 0 1 1 1 0 0 1#and the last without a line end");
  ethd_scene_info info;
  ethd_scene_describe(s, &info);
  ck_assert_uint_eq(info.objects, ETHD_SHAPE_COUNT);
  for (int i = 0; i < ETHD_SHAPE_COUNT; i++) ck_assert_uint_eq(info.by_shape[i], 1);
  ck_assert_uint_eq(info.segments, 3 + 1 + 3);
  ck_assert_uint_eq(info.materials, 0);
  ethd_scene_destroy(s);
}

TEST(test_empty_texts) {
  static const char *const texts[] = {"", "\n", "#", " \t\r\n#x\n\n", "material soft\n"};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    ethd_scene *s = parse(texts[i]);
    ethd_nearest q;
    ethd_scene_query(s, (ethd_vec){0, 0}, &q);
    ck_assert_int_eq(q.object, -1);
    ethd_scene_destroy(s);
  }
  ethd_scene *s;
  ck_assert_int_eq(ethd_scene_parse(NULL, 0, &s, NULL), ETHD_OK);
  ethd_scene_destroy(s);
  ck_assert_int_eq(ethd_scene_parse(NULL, 1, &s, NULL), ETHD_E_ARGUMENT);
}

/* Text ends where its length says, in the middle of a number or of a page without a 0. */
TEST(test_length_counts) {
  const char text[] = "circle 0 0 1.25";
  for (size_t n = 0; n < sizeof text; n++) {
    char *exact = malloc(n + 1);
    memcpy(exact, text, n);
    exact = realloc(exact, n ? n : 1);
    ethd_scene *s;
    ethd_status status = ethd_scene_parse(exact, n, &s, NULL);
    ck_assert_int_eq(status == ETHD_OK, n == 0 || (n >= 12 && n < sizeof text));
    if (n >= 12 && n < sizeof text) {
      ethd_nearest q;
      ethd_scene_query(s, (ethd_vec){0, 0}, &q);
      ck_assert(q.distance == (n < 14 ? -1 : n == 14 ? -1.2 : -1.25));
    }
    ethd_scene_destroy(s);
    free(exact);
  }
}

/* c of a half-plane {x > c} is its distance from the base. */
static void check_number(const char *word) {
  char text[400];
  snprintf(text, sizeof text, "halfplane 1 0 %s", word);
  ethd_scene *s = parse(text);
  ethd_nearest q;
  ethd_scene_query(s, (ethd_vec){0, 0}, &q);
  ck_assert_msg(q.distance == strtod(word, NULL), "%s: %.17g", word, q.distance);
  ethd_scene_destroy(s);
}

TEST(test_numbers) {
  static const char *const words[] = {"0",
                                      "-0",
                                      "1",
                                      "+1",
                                      "1.",
                                      ".5",
                                      "-.5e1",
                                      "1e5",
                                      "25E+3",
                                      "100000e-4",
                                      "1e00000000005",
                                      "1E-5",
                                      "1e+05",
                                      "0.1",
                                      "123456.789012345678901",
                                      "1e-400",
                                      "0.000000000000000000000000000001e30",
                                      "100000000000000000000000000000e-30",
                                      "4.9406564584124654e-324",
                                      "2.2250738585072011e-308",
                                      "9007199254740993e-10",
                                      "0.1000000000000000055511151231257827021181583404541015625",
                                      "1e-0000000000000000000001",
                                      "0e999999999999999999999"};
  for (size_t i = 0; i < sizeof words / sizeof *words; i++) check_number(words[i]);
  for (uint64_t i = 0; i < 20000; i++) {
    char word[64];
    double v = ((double)(int64_t)draw_bits(i)) * 0x1p-44;
    snprintf(word, sizeof word, i % 3 ? "%.17g" : i % 2 ? "%.12f" : "%.20e", v);
    check_number(word);
  }
}

TEST(test_materials) {
  ethd_scene *s = parse("circle 9 0 1 material=Hard_2.A-z\n" /* defined below */
                        "material soft k_e=100 b_e=1.5\n"
                        "material Hard_2.A-z k_e=1e5\n"
                        "circle 0 0 1 material=soft # and a comment\n"
                        "circle -9 0 1\n");
  static const int expected[] = {1, 0, -1};
  for (int i = 0; i < 3; i++) {
    ethd_touch t;
    ck_assert_uint_eq(ethd_scene_touches(s, (ethd_vec){9 - 9 * i, 0}, 0, &t, 1), 1);
    ck_assert_int_eq(t.object, i);
    ck_assert_int_eq(t.material, expected[i]);
  }
  const ethd_material *m = ethd_scene_material(s, 0);
  ck_assert_str_eq(m->name, "soft");
  ck_assert(m->count == 2 && m->line == 2 && m->values[0].value == 100 && m->values[1].value == 1.5);
  ck_assert_str_eq(m->values[1].name, "b_e");
  ck_assert_int_eq(ethd_scene_material(s, 1)->line, 3);
  ck_assert_ptr_null(ethd_scene_material(s, 2));
  ethd_scene_destroy(s);
}

#define NAME_31 "abcdefghijklmnopqrstuvwxyz01234"
#define KEYS_15 "a=1 b=1 c=1 d=1 e=1 f=1 g=1 h=1 i=1 j=1 k=1 l=1 m=1 n=1 o=1 "

typedef struct refusal {
  const char *text;
  ethd_status status;
  int line;
  const char *name; /* that the error's name holds */
} refusal;

static const refusal refusals[] = {
    {"hello", ETHD_E_UNKNOWN, 1, "hello"},
    {"\n\nCircle 0 0 1", ETHD_E_UNKNOWN, 3, "Circle"},
    {"circlex 0 0 1", ETHD_E_UNKNOWN, 1, "circlex"},
    {"1 2 3", ETHD_E_UNKNOWN, 1, "1"},
    {"circle", ETHD_E_SYNTAX, 1, "circle"},
    {"circle 0 0", ETHD_E_SYNTAX, 1, "circle"},
    {"\ncircle 0 0 1 2", ETHD_E_SYNTAX, 2, "circle"},
    {"halfplane 1 0", ETHD_E_SYNTAX, 1, "halfplane"},
    {"capsule 0 0 1 1", ETHD_E_SYNTAX, 1, "capsule"},
    {"box 0 0 1 1", ETHD_E_SYNTAX, 1, "box"},
    {"segment 0 0 1", ETHD_E_SYNTAX, 1, "segment"},
    {"segment 0 0 1 1 2 2", ETHD_E_SYNTAX, 1, "segment"},
    {"polygon 0 0 1 0", ETHD_E_SYNTAX, 1, "polygon"},
    {"polygon 0 0 1 0 1 1 0", ETHD_E_SYNTAX, 1, "polygon"},
    {"polyline 0 0", ETHD_E_SYNTAX, 1, "polyline"},
    {"polyline 0 0 1", ETHD_E_SYNTAX, 1, "polyline"},
    {"circle 0 zero 1", ETHD_E_SYNTAX, 1, "zero"},
    {"circle 0 nan 1", ETHD_E_SYNTAX, 1, "nan"},
    {"circle 0 inf 1", ETHD_E_SYNTAX, 1, "inf"},
    {"circle 0 -Infinity 1", ETHD_E_SYNTAX, 1, "-Infinity"},
    {"circle 0 0x10 1", ETHD_E_SYNTAX, 1, "0x10"},
    {"circle 0 1,5 1", ETHD_E_SYNTAX, 1, "1,5"},
    {"circle 0 1.5m 1", ETHD_E_SYNTAX, 1, "1.5m"},
    {"circle 0 1.5.2 1", ETHD_E_SYNTAX, 1, "1.5.2"},
    {"circle 0 . 1", ETHD_E_SYNTAX, 1, "."},
    {"circle 0 + 1", ETHD_E_SYNTAX, 1, "+"},
    {"circle 0 +-1 1", ETHD_E_SYNTAX, 1, "+-1"},
    {"circle 0 e5 1", ETHD_E_SYNTAX, 1, "e5"},
    {"circle 0 1e 1", ETHD_E_SYNTAX, 1, "1e"},
    {"circle 0 1e+ 1", ETHD_E_SYNTAX, 1, "1e+"},
    {"circle 0 1e5.0 1", ETHD_E_SYNTAX, 1, "1e5.0"},
    {"circle 0 1e5. 1", ETHD_E_SYNTAX, 1, "1e5."},
    {"circle 0 .e1 1", ETHD_E_SYNTAX, 1, ".e1"},
    {"circle 0 - 1", ETHD_E_SYNTAX, 1, "-"},
    {"circle 0 -. 1", ETHD_E_SYNTAX, 1, "-."},
    {"circle 0 1+5 1", ETHD_E_SYNTAX, 1, "1+5"},
    {"circle 0 15A3 1", ETHD_E_SYNTAX, 1, "15A3"},
    {"circle 0 1d5 1", ETHD_E_SYNTAX, 1, "1d5"},
    {"circle 0 1\x02 1", ETHD_E_SYNTAX, 1, "1?"},
    {"circle 0\b0 1", ETHD_E_SYNTAX, 1, "0?0"},
    {"circle\001 0 0 1", ETHD_E_UNKNOWN, 1, "circle?"},
    {"circle 0 \"1\" 1", ETHD_E_SYNTAX, 1, "\"1\""},
    {"circle 0 0 1 material", ETHD_E_SYNTAX, 1, "material"},
    {"circle 0 x 1\ncircle 0 0 1", ETHD_E_SYNTAX, 1, "x"},
    {"circle 0 0 1\ncircle 0 y 1\ncircle 0 z 1\n", ETHD_E_SYNTAX, 2, "y"},
    {"circle 0 \x1b[2J 1", ETHD_E_SYNTAX, 1, "?[2J"},
    {"circle 0 1\x7f\xff 1", ETHD_E_SYNTAX, 1, "1??"},
    {"circle 0 0 1 material=", ETHD_E_SYNTAX, 1, "material="},
    {"circle 0 0 1 material = soft", ETHD_E_SYNTAX, 1, "material"},
    {"circle 0 0 1 stuff=soft", ETHD_E_SYNTAX, 1, "stuff=soft"},
    {"circle 0 0 1 material=soft 5\nmaterial soft", ETHD_E_SYNTAX, 1, "5"},
    {"circle 0 0 1 material=soft material=soft\nmaterial soft", ETHD_E_SYNTAX, 1, "material=soft"},
    {"circle 0 0 material=soft 1\nmaterial soft", ETHD_E_SYNTAX, 1, "1"},
    {"#\ncircle 0 0 1 material=soft", ETHD_E_UNKNOWN, 2, "material=soft"},
    {"circle 0 0 1 material=sof\nmaterial soft", ETHD_E_UNKNOWN, 1, "material=sof"},
    {"circle 0 0 1 material=soft2\nmaterial soft", ETHD_E_UNKNOWN, 1, "material=soft2"},
    {"circle 0 0 1 material=" NAME_31 "5", ETHD_E_SYNTAX, 1, "material=" NAME_31 "5"},
    {"material", ETHD_E_SYNTAX, 1, "material"},
    {"material so=ft", ETHD_E_SYNTAX, 1, "so=ft"},
    {"material " NAME_31 "5", ETHD_E_SYNTAX, 1, NAME_31 "5"},
    {"material soft k_e", ETHD_E_SYNTAX, 1, "k_e"},
    {"material soft k_e=", ETHD_E_SYNTAX, 1, "k_e="},
    {"material soft =5", ETHD_E_SYNTAX, 1, "=5"},
    {"material soft k_e=5=6", ETHD_E_SYNTAX, 1, "k_e=5=6"},
    {"material soft k_e=stiff", ETHD_E_SYNTAX, 1, "k_e=stiff"},
    {"material soft k_e=nan", ETHD_E_SYNTAX, 1, "k_e=nan"},
    {"material soft " NAME_31 "5=1", ETHD_E_SYNTAX, 1, NAME_31 "5=1"},
    {"material soft k_e=1e999", ETHD_E_NOT_FINITE, 1, "k_e"},
    {"material soft\nmaterial hard\nmaterial soft", ETHD_E_DUPLICATE, 3, "soft"},
    {"\nmaterial soft k_e=1 b_e=2 k_e=1", ETHD_E_DUPLICATE, 2, "k_e"},
    {"material soft " KEYS_15 "p=1 q=1", ETHD_E_FULL, 1, "q"},
    {"circle 0 1e999 1", ETHD_E_NOT_FINITE, 1, "circle y"},
    {"circle 1.01e6 0 1", ETHD_E_RANGE, 1, "circle x"},
    {"circle 0 0 1e9", ETHD_E_RANGE, 1, "circle r"},
    {"#\n#\ncircle 0 0 0", ETHD_E_RANGE, 3, "circle r"},
    {"circle 0 0 1e-400", ETHD_E_RANGE, 1, "circle r"},
    {"box 0 0 1 -1 0", ETHD_E_RANGE, 1, "box half_h"},
    {"capsule 0 0 0 -2e6 1", ETHD_E_RANGE, 1, "capsule y2"},
    {"halfplane 1 1 0", ETHD_E_RANGE, 1, "halfplane |n|"},
    {"halfplane 1.0000011 0 0", ETHD_E_RANGE, 1, "halfplane |n|"},
    {"circle 0 0 1\nsegment 1 1 1 1", ETHD_E_GEOMETRY, 2, "segment: points 0 and 1"},
    {"polyline 0 0 1 1 1 1 2 2", ETHD_E_GEOMETRY, 1, "polyline: points 1 and 2"},
    {"polygon 0 0 1 0 1 1 0 0", ETHD_E_GEOMETRY, 1, "polygon: points 3 and 0"},
    {"\npolygon 0 0 1 1 1 0 0 1", ETHD_E_GEOMETRY, 2, "polygon: edges 0 and 2"},
    {"polygon 0 0 2 0 1 0", ETHD_E_GEOMETRY, 1, "polygon: edges"},
    {"polygon 0 0 1 1 2 2 3 3", ETHD_E_GEOMETRY, 1, "polygon: edges"},
    {"polygon 0 0 4 0 2 0 2 3", ETHD_E_GEOMETRY, 1, "polygon: edges"},             /* back along itself */
    {"polygon 0 0 4 0 4 4 2 0 0 4", ETHD_E_GEOMETRY, 1, "polygon: edges"},         /* a corner on an edge */
    {"polygon 0 0 2 2 4 0 4 4 2 2 0 4", ETHD_E_GEOMETRY, 1, "polygon: edges"},     /* a corner on a corner */
    {"polygon 0 0 9 0 9 9 5 9 5 5 5 9 0 9", ETHD_E_GEOMETRY, 1, "polygon: edges"}, /* a slit */
    {"polygon 0 0 1 0 1 1 1 1", ETHD_E_GEOMETRY, 1, "polygon: points 2 and 3"},
    {"polygon 1e9 0 1 0 1 1", ETHD_E_RANGE, 1, "polygon x"},
    {"segment 0 0 0 1e9", ETHD_E_RANGE, 1, "segment y"},
    {"halfplane 1 0 -1e9", ETHD_E_RANGE, 1, "halfplane c"},
    {"polyline 1e5 0 100000.00000000001 0", ETHD_E_GEOMETRY, 1, "polyline: points 0 and 1"},
    {"segment 0 0 1e-150 0", ETHD_E_GEOMETRY, 1, "segment: points 0 and 1"},
};

TEST(test_refusals) {
  for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++) {
    const refusal *r = &refusals[i];
    ethd_scene *s = (ethd_scene *)&s;
    ethd_error error = {.name = ""};
    ethd_status status = ethd_scene_parse(r->text, strlen(r->text), &s, &error);
    ck_assert_msg(status == r->status, "\"%s\": %s", r->text, ethd_status_sentence(status));
    ck_assert_ptr_null(s);
    ck_assert_msg(error.status == status && error.line == r->line && strstr(error.name, r->name), "\"%s\": line %d, %s",
                  r->text, error.line, error.name);
    ck_assert_int_eq(ethd_scene_parse(r->text, strlen(r->text), &s, NULL), r->status);
  }
}

TEST(test_numbers_of_refusals) {
  ethd_scene *s;
  ethd_error error;
  const char *text = "circle 0 0 -3";
  ck_assert_int_eq(ethd_scene_parse(text, strlen(text), &s, &error), ETHD_E_RANGE);
  ck_assert(error.found == -3 && error.min == 0 && error.max == 1e6);
  text = "circle 0 2e6 3";
  ck_assert_int_eq(ethd_scene_parse(text, strlen(text), &s, &error), ETHD_E_RANGE);
  ck_assert(error.found == 2e6 && error.min == -1e6 && error.max == 1e6);
  text = "box 1 2 3";
  ck_assert_int_eq(ethd_scene_parse(text, strlen(text), &s, &error), ETHD_E_SYNTAX);
  ck_assert(error.found == 3 && error.min == 5 && error.max == 5);
  text = "polygon 1 2 3 4";
  ck_assert_int_eq(ethd_scene_parse(text, strlen(text), &s, &error), ETHD_E_SYNTAX);
  ck_assert(error.found == 4 && error.min == 6 && isinf(error.max));
  text = "halfplane 1 1 0";
  ck_assert_int_eq(ethd_scene_parse(text, strlen(text), &s, &error), ETHD_E_RANGE);
  ck_assert(error.found == sqrt(2) && error.min == 1 - 1e-6 && error.max == 1 + 1e-6);
  text = "material soft " KEYS_15 "p=1 q=1";
  ck_assert_int_eq(ethd_scene_parse(text, strlen(text), &s, &error), ETHD_E_FULL);
  ck_assert(error.found == ETHD_PARAMS_MAX + 1 && error.min == 0 && error.max == ETHD_PARAMS_MAX);
  text = "blob";
  ck_assert_int_eq(ethd_scene_parse(text, strlen(text), &s, &error), ETHD_E_UNKNOWN);
  ck_assert(isnan(error.found) && isnan(error.min) && isnan(error.max));
}

TEST(test_zero_bytes_and_odd_ones) {
  static const char zero[] = "circle 0 0 1\n# a comm\0ent\n";
  static const char words[] = "cir\033cle\n";
  ethd_scene *s;
  ethd_error error;
  ck_assert_int_eq(ethd_scene_parse(zero, sizeof zero - 1, &s, &error), ETHD_E_SYNTAX);
  ck_assert(s == NULL && error.line == 2);
  ck_assert_str_eq(error.name, "a NUL byte");
  ck_assert_int_eq(ethd_scene_parse(words, sizeof words - 1, &s, &error), ETHD_E_UNKNOWN);
  ck_assert_str_eq(error.name, "cir?cle"); /* fit for a terminal */
}

TEST(test_limits) {
  char text[64 * 100];
  ethd_scene *s;
  ethd_error error;
  size_t n = 0;
  for (int i = 0; i <= ETHD_MATERIALS_MAX; i++) {
    if (i == ETHD_MATERIALS_MAX) ethd_scene_destroy(parse(text));
    n += (size_t)snprintf(text + n, sizeof text - n, "material m%d k_e=%d\n", i, i);
  }
  ck_assert_int_eq(ethd_scene_parse(text, n, &s, &error), ETHD_E_FULL);
  ck_assert_int_eq(error.line, ETHD_MATERIALS_MAX + 1);
  ck_assert_str_eq(error.name, "m32");
  ck_assert(error.found == ETHD_MATERIALS_MAX + 1 && error.min == 0 && error.max == ETHD_MATERIALS_MAX);
  snprintf(text, sizeof text, "material %s %sp=1\ncircle 0 0 1 material=%s", NAME_31, KEYS_15, NAME_31);
  s = parse(text);
  ck_assert_uint_eq(ethd_scene_material(s, 0)->count, ETHD_PARAMS_MAX);
  ethd_scene_destroy(s);
  char word[200];
  memset(word, '0', sizeof word);
  for (size_t length = 100; length < 199; length += 9) {
    word[length] = 0;
    snprintf(text, sizeof text, "halfplane 1 0 %s", word);
    ck_assert_int_eq(ethd_scene_parse(text, strlen(text), &s, &error), length <= 127 ? ETHD_OK : ETHD_E_SYNTAX);
    ethd_scene_destroy(s);
    word[length] = '0';
  }
}
