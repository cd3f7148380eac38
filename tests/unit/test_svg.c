/* Drawings as scenes: what each element becomes, how far edges are off a curve, each refusal with its line, and
   drawings broken at random. ETHD_FUZZ: so many of those. */
#include <check.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "settings/scene_file.h"
#include "sim/random.h"
#include "svg/svg.h"
#include "unit/mutate.h"
#include "unit/rig.h"

#define OPEN "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100mm\" height=\"50mm\" viewBox=\"0 0 100 50\">\n"
#define CLOSE "</svg>"

static ethd_svg_options options = {1e-5, NAN, {0, 0}};
static ethd_svg_notes notes;
static char message[ETHD_MESSAGE_MAX];

static ethd_scene *scene_of(const char *text) {
  ethd_scene *scene;
  if (ethd_svg_parse(text, strlen(text), "t.svg", &options, &scene, &notes, message) < 0) ck_abort_msg("%s", message);
  return scene;
}

static ethd_object_def object(const ethd_scene *scene, size_t i) {
  ethd_object_def o;
  ck_assert_int_eq(ethd_scene_object(scene, i, &o), (int)i);
  return o;
}

typedef struct expected {
  const char *element;
  ethd_shape shape;
  size_t count;
  double numbers[12]; /* mm */
} expected;

static const expected elements[] = {
    {"<line x1='1' y1='2' x2='30' y2='4'/>", ETHD_SHAPE_SEGMENT, 4, {1, 48, 30, 46}},
    {"<polyline points='1,2 3,4,5 6'/>", ETHD_SHAPE_POLYLINE, 6, {1, 48, 3, 46, 5, 44}},
    {"<polygon points='1 2 3 4 5 2'/>", ETHD_SHAPE_POLYGON, 6, {1, 48, 3, 46, 5, 48}},
    {"<polygon points='1 2 3 4 5 2 1 2'/>", ETHD_SHAPE_POLYGON, 6, {1, 48, 3, 46, 5, 48}},
    {"<polygon fill='none' points='1 2 3 4 5 2'/>", ETHD_SHAPE_POLYLINE, 8, {1, 48, 3, 46, 5, 48, 1, 48}},
    {"<g style='fill : none'><polygon points='1 2 3 4 5 2'/></g>",
     ETHD_SHAPE_POLYLINE,
     8,
     {1, 48, 3, 46, 5, 48, 1, 48}},
    {"<g fill='none'><polygon style='fill:#123' points='1 2 3 4 5 2'/></g>",
     ETHD_SHAPE_POLYGON,
     6,
     {1, 48, 3, 46, 5, 48}},
    {"<circle cx='10' cy='20' r='5'/>", ETHD_SHAPE_CIRCLE, 3, {10, 30, 5}},
    {"<circle cx='1mm' cy='2px' r='1pt' transform='scale(2)'/>",
     ETHD_SHAPE_CIRCLE,
     3,
     {2 * 96 / 25.4, 46, 2 * 96 / 72.0}},
    {"<circle r='5' transform='translate(10 20) rotate(30)'/>", ETHD_SHAPE_CIRCLE, 3, {10, 30, 5}},
    {"<rect x='10' y='10' width='20' height='6'/>", ETHD_SHAPE_BOX, 5, {20, 37, 10, 3, 0}},
    {"<rect x='10' y='10' width='20' height='6' transform='rotate(90 20 13)'/>",
     ETHD_SHAPE_BOX,
     5,
     {20, 37, 10, 3, -M_PI_2 * 1e3}},
    {"<rect x='1' y='1' width='2' height='3' fill='none'/>",
     ETHD_SHAPE_POLYLINE,
     10,
     {1, 49, 3, 49, 3, 46, 1, 46, 1, 49}},
    {"<rect x='1' y='1' width='2' height='3' transform='matrix(1 0 1 1 0 0)'/>",
     ETHD_SHAPE_POLYGON,
     8,
     {2, 49, 4, 49, 7, 46, 5, 46}},
    {"<path d='M1 2L3 4'/>", ETHD_SHAPE_SEGMENT, 4, {1, 48, 3, 46}},
    {"<path d='m1 2 2 2-1-3'/>", ETHD_SHAPE_POLYLINE, 6, {1, 48, 3, 46, 2, 49}},
    {"<path d='M1,2H5V8h-2v-1'/>", ETHD_SHAPE_POLYLINE, 10, {1, 48, 5, 48, 5, 42, 3, 42, 3, 43}},
    {"<path d='M1 2 3 4 5 2z'/>", ETHD_SHAPE_POLYGON, 6, {1, 48, 3, 46, 5, 48}},
    {"<path d='M1 2 3 4 5 2 1 2Z' fill='none'/>", ETHD_SHAPE_POLYLINE, 8, {1, 48, 3, 46, 5, 48, 1, 48}},
    {"<path d='M1 1 1 1 1 1L2 2 2 2'/>", ETHD_SHAPE_SEGMENT, 4, {1, 49, 2, 48}},
    {"<path d='M.5.5.25 1e0'/>", ETHD_SHAPE_SEGMENT, 4, {.5, 49.5, .25, 49}},
    {"<path d='M0 0A0 5 0 1 1 3 4'/>", ETHD_SHAPE_SEGMENT, 4, {0, 50, 3, 46}},
};

START_TEST(test_elements) {
  const expected *e = &elements[_i];
  char text[600];
  snprintf(text, sizeof text, OPEN "%s" CLOSE, e->element);
  ethd_scene *s = scene_of(text);
  ethd_object_def o = object(s, 0), more;
  ck_assert_int_eq(ethd_scene_object(s, 1, &more), -1);
  ck_assert_msg(o.shape == e->shape && o.count == e->count, "%s: %s with %zu numbers", e->element,
                ethd_shape_name(o.shape), o.count);
  for (size_t k = 0; k < o.count; k++)
    ck_assert_msg(fabs(o.numbers[k] - 1e-3 * e->numbers[k]) <= 1e-15, "%s: number %zu is %.17g", e->element, k,
                  o.numbers[k]);
  ethd_scene_destroy(s);
}
END_TEST

/* ---- curves: the largest distance of points of the curve from the edges, and of vertices from the curve ---- */

typedef struct curve {
  const char *data;
  ethd_vec (*at)(double t);
} curve;

static ethd_vec cubic(double t) { /* M10 10 C 20 40 40 -10 50 20 */
  double u = 1 - t, b[] = {u * u * u, 3 * u * u * t, 3 * u * t * t, t * t * t};
  return (ethd_vec){10 * b[0] + 20 * b[1] + 40 * b[2] + 50 * b[3], 10 * b[0] + 40 * b[1] - 10 * b[2] + 20 * b[3]};
}

static ethd_vec quadratic(double t) { /* M10 10 Q 30 45 60 5 */
  double u = 1 - t;
  return (ethd_vec){10 * u * u + 60 * u * t + 60 * t * t, 10 * u * u + 90 * u * t + 5 * t * t};
}

static ethd_vec smooth(double t) { /* ... S: the control point is mirrored: 60 50 */
  double u = 1 - t, b[] = {u * u * u, 3 * u * u * t, 3 * u * t * t, t * t * t};
  return (ethd_vec){50 * b[0] + 60 * b[1] + 70 * b[2] + 90 * b[3], 20 * b[0] + 50 * b[1] + 5 * b[2] + 30 * b[3]};
}

static ethd_vec ellipse(double t) { /* centre 50 25, 20 and 8, turned by 30 degrees */
  double a = 2 * M_PI * t, c = cos(M_PI / 6), s = sin(M_PI / 6), u = 20 * cos(a), v = 8 * sin(a);
  return (ethd_vec){50 + c * u - s * v, 25 + s * u + c * v};
}

static ethd_vec quarter(double t) { /* M 10 10 A 20 20 0 0 1 30 30: centre 10 30 */
  double a = M_PI_2 * t;
  return (ethd_vec){10 + 20 * sin(a), 30 - 20 * cos(a)};
}

static ethd_vec long_way(double t) { /* M 10 30 A 20 20 0 1 1 30 10: centre 10 10, three quarters */
  double a = M_PI_2 + 1.5 * M_PI * t;
  return (ethd_vec){10 + 20 * cos(a), 10 + 20 * sin(a)};
}

static const curve curves[] = {
    {"M10 10C20 40 40-10 50 20", cubic},
    {"M10 10Q30 45 60 5", quadratic},
    {"M50 20 M 40 -10 C 40 -10 40 -10 50 20 S 70 5 90 30", smooth},
    {"M10 10a20 20 0 0 1 20 20", quarter},
    {"M10 30A20 20 0 113e1,10", long_way},
    {NULL, ellipse},
};

START_TEST(test_curves_within_tolerance) {
  static const double tolerances[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7};
  size_t last = 0;
  for (int i = 0; i < 5; i++) {
    char text[600],
        shape[200] = "<g transform='rotate(30 50 25)'><ellipse cx='50' cy='25' rx='20' ry='8' fill='none'/></g>";
    if (curves[_i].data) snprintf(shape, sizeof shape, "<path fill='none' d='%s'/>", curves[_i].data);
    snprintf(text, sizeof text, OPEN "%s" CLOSE, shape);
    options.tolerance = tolerances[i];
    ethd_scene *s = scene_of(text);
    ethd_scene_info info;
    double most = 0;
    for (int k = 0; k <= 20000; k++) {
      ethd_vec p = curves[_i].at(k / 20000.0);
      ethd_nearest q;
      ethd_scene_query(s, (ethd_vec){1e-3 * p.x, 0.05 - 1e-3 * p.y}, &q);
      most = fmax(most, q.distance);
    }
    ck_assert_msg(most <= tolerances[i], "%s: %g m off at a tolerance of %g", shape, most, tolerances[i]);
    ethd_scene_describe(s, &info);
    ck_assert_uint_ge(info.segments, last);
    if (i == 4) ck_assert_msg(most > 1e-9 && info.segments < 4000, "%zu edges, %g m off", info.segments, most);
    last = info.segments;
    ethd_scene_destroy(s);
  }
  options.tolerance = 1e-5;
}
END_TEST

/* ---- the page ---- */

START_TEST(test_page) {
  static const struct {
    const char *svg;
    double scale, unit, x, y; /* option and result; of the point 10 10, m */
  } pages[] = {
      {"<svg width='10in' height='5in' viewBox='0 0 100 50'>", NAN, 2.54e-3, 0.0254, 0.1016},
      {"<svg width='200' height='100'>", NAN, 0.0254 / 96, 0.254 / 96, 90 * 0.0254 / 96},
      {"<svg viewBox='-10,-20 100 50'>", 0.01, 0.01, 0.2, 0.2},
      {"<svg>", 0.01, 0.01, 0.1, -0.1},
      {"<svg width='100%' height='100%' viewBox='0 0 10 10'>", 1e-3, 1e-3, 0.01, 0},
      {"<svg width='20cm' viewBox='0 0 200 70'>", NAN, 1e-3, 0.01, 0.06},
      {"<svg xmlns='http://www.w3.org/2000/svg' width='200mm' height='70mm' viewBox='0 0 200 70' transform='scale(2)'>",
       NAN, 1e-3, 0.02, 0.05},
  };
  for (size_t i = 0; i < sizeof pages / sizeof *pages; i++)
    for (int moved = 0; moved < 2; moved++) {
      char text[400];
      options.scale = pages[i].scale;
      options.origin = moved ? (ethd_vec){0.5, -0.25} : (ethd_vec){0, 0};
      snprintf(text, sizeof text, "%s<line x1='10' y1='10' x2='20' y2='5'/></svg>", pages[i].svg);
      ethd_scene *s = scene_of(text);
      ethd_object_def o = object(s, 0);
      ck_assert_msg(fabs(o.numbers[0] - pages[i].x - options.origin.x) < 1e-15 &&
                        fabs(o.numbers[1] - pages[i].y - options.origin.y) < 1e-15,
                    "%s: %.17g %.17g", pages[i].svg, o.numbers[0], o.numbers[1]);
      ck_assert(fabs(notes.scale - pages[i].unit) < 1e-15);
      ethd_scene_destroy(s);
    }
  options = (ethd_svg_options){1e-5, NAN, {0, 0}};
}
END_TEST

START_TEST(test_skipped) {
  ethd_scene *s = scene_of("<?xml version='1.0'?>\n<!DOCTYPE svg PUBLIC 'x' 'y'>\n<!-- a comment -->"
                           "<svg xmlns='http://www.w3.org/2000/svg' xmlns:i='http://i' width='10mm' height='10mm'>"
                           "<title>t</title><desc>d<b/></desc><metadata><i:x><path d='nonsense'/></i:x></metadata>"
                           "<defs><text/><path d='nonsense'/></defs><i:grid><path d='M0 0'/></i:grid>"
                           "<g display='none'><text>hidden</text></g><rect style=' visibility:hidden ' width='-1'/>"
                           "<path/><path d=''/><path d='M1 1 1 1z'/><circle r='0'/><polyline/>"
                           "<circle id='c' class='x' stroke='red' stroke-width='3' cx='1' cy='1' r='1'/></svg>");
  ethd_scene_info info;
  ethd_scene_describe(s, &info);
  ck_assert_uint_eq(info.objects, 1);
  ck_assert_uint_eq(notes.skipped, 7);
  ck_assert_uint_eq(notes.blank, 3);
  ethd_scene_destroy(s);
}
END_TEST

/* ---- refusals ---- */

static const struct {
  const char *body, *said; /* after OPEN: line 2 on; with "<": the whole */
} refusals[] = {
    {"\n<text>x</text>", "t.svg:3: not supported; .*text"},
    {"<image/>", "t.svg:2: not supported; .*image"},
    {"<g>\n<use/></g>", "t.svg:3: not supported; .*use"},
    {"<style>path{fill:none}</style>", "t.svg:2: not supported; .*style"},
    {"<svg/>", "t.svg:2: not supported; .*svg"},
    {"<path d='M0 0 L1'/>", "t.svg:2: a number is missing in a path: found \"L1\""},
    {"<path d='L0 0'/>", "a path must begin with M: found \"L0 0\""},
    {"<path d='M0 0 R 1 1'/>", "not a command of a path.*\"R 1 1\""},
    {"<path d='M0 0 L 1 nan'/>", "a number is missing in a path"},
    {"<path d='M0 0 L 1 0x10'/>", "not a command of a path"},
    {"<path d='M0 0 L 1 1e999'/>", "a number is missing in a path"},
    {"<path d='M0 0 A 1 1 0 2 0 3 3'/>", "a flag of an arc isn't 0 or 1"},
    {"<path d='M0 0 9 0 9 9z M1 1 2 1 2 2z'/>", "filled parts overlap"},
    {"<path d='M0 0 9 9 9 0 0 9z'/>", "t.svg:2: polygon: edges 0 and 2 meet"},
    {"<polygon points='0 0 1 0 2 0'/>", "t.svg:2: polygon: edges"},
    {"<polygon points='0 0 4 0 4 4 2 0 0 4'/>", "t.svg:2: polygon: edges"},
    {"<polygon points='0 0 1'/>", "points: an even count.*\"1\""},
    {"<circle r='-1'/>", "r is negative"},
    {"<rect width='5%' height='1'/>", "width: a length is needed.*\"5%\""},
    {"<rect width='5em' height='1'/>", "width: a length is needed.*\"5em\""},
    {"<g transform='skewX(10)'/>", "transform: .*skewX"},
    {"<g transform='scale(0)'/>", "transform: .*scale(0)"},
    {"<g transform='scale(1'/>", "transform: "},
    {"<g transform='matrix(1 2 3)'/>", "transform: "},
    {"<g clip-path='url(#c)'/>", "clip-path"},
    {"<line x1='1e12' x2='1'/>", "segment x"},
    {"<path d='M0 0 C 1e300 1e300 1e307 0 9 9'/>", "20 million points"},
    {"<path d='M0 0'", "t.svg:2: no XML"},
    {"<g>", "t.svg:2: no XML: "},
    {"</g>", "t.svg:2: no XML"},
    {"&nothing;", "t.svg:2: no XML: undefined entity"},
    {"<!DOCTYPE svg [<!ENTITY a \"b\">]><svg width='1' height='1'>&a;</svg>",
     "t.svg:1: entities aren't supported: found \"a\""},
    {"<html/>", "t.svg:1: a drawing must begin with svg: found \"html\""},
    {"<svg xmlns='http://other' width='1'/>", "a drawing must begin with svg"},
    {"<svg/>", "t.svg:1: no width or height"},
    {"<svg width='-1mm'/>", "width and height are lengths over 0: found \"-1mm\""},
    {"<svg width='1em'/>", "width and height are lengths over 0"},
    {"<svg width='1' viewBox='0 0 0 1'/>", "viewBox: "},
    {"<svg width='1' viewBox='0 0 1'/>", "viewBox: "},
    {"<svg width='1' height='1' viewBox='0 0 2 1'/>", "stretch the viewBox"},
    {"", "t.svg:1: no XML"},
    {"circle 0 0 1", "t.svg:1: no XML"},
};

/* '.*' apart, a plain text. */
static int says(const char *said) {
  const char *gap = strstr(said, ".*");
  char first[120];
  snprintf(first, sizeof first, "%.*s", gap ? (int)(gap - said) : 119, said);
  const char *at = strstr(message, first);
  return at && (!gap || strstr(at, gap + 2));
}

START_TEST(test_refusals) {
  char text[600];
  const char *body = refusals[_i].body;
  int whole = _i >= 31;
  snprintf(text, sizeof text, "%s%s%s", whole ? "" : OPEN, body, whole ? "" : CLOSE);
  ethd_scene *scene = (ethd_scene *)&text;
  ethd_status status = ethd_svg_parse(text, strlen(text), "t.svg", &options, &scene, &notes, message);
  ck_assert_msg(status < 0 && scene == NULL, "%s: taken", text);
  ck_assert_msg(says(refusals[_i].said), "%s: %s", text, message);
}
END_TEST

START_TEST(test_depth) {
  for (int depth = 62; depth < 66; depth++) {
    char text[2000] = OPEN;
    for (int i = 0; i < depth; i++) strcat(text, "<g>");
    for (int i = 0; i < depth; i++) strcat(text, "</g>");
    strcat(text, CLOSE);
    ethd_scene *scene;
    ethd_status status = ethd_svg_parse(text, strlen(text), "t.svg", &options, &scene, &notes, message);
    ck_assert_int_eq(status, depth <= 63 ? ETHD_OK : ETHD_E_SYNTAX);
    ethd_scene_destroy(scene);
  }
}
END_TEST

/* ---- written and read again ---- */

static char *print(const ethd_scene *scene) {
  char *text;
  size_t length;
  FILE *file = open_memstream(&text, &length);
  ck_assert_int_eq(ethd_scene_print(scene, file), ETHD_OK);
  fclose(file);
  return text;
}

START_TEST(test_print) {
  ethd_scene *s = rig_scene(
      "material a k_e=1.5 b_e=0.1\nhalfplane 0.6 0.8 0.30000000000000004 material=a\ncircle 1 2 1e-7\n"
      "capsule 0 0 1 1 .5\nbox 1 2 3 4 0.5 material=b\npolygon 0 0 1 0 1 1\nsegment 0 0 1 1\nmaterial b\n"
      "polyline 0.1 0.2 0.30000000000000004 1 1 0 0.1 0.2\nhalfplane 0.70710678118654746 0.70710678118654757 1\n");
  char *text = print(s);
  ck_assert_str_eq(text, "material a k_e=1.5 b_e=0.1\nmaterial b\nhalfplane 0.6 0.8 0.30000000000000004 material=a\n"
                         "circle 1 2 1e-07\ncapsule 0 0 1 1 0.5\nbox 1 2 3 4 0.5 material=b\npolygon 0 0 1 0 1 1\n"
                         "segment 0 0 1 1\npolyline 0.1 0.2 0.30000000000000004 1 1 0 0.1 0.2\n"
                         "halfplane 0.7071067811865475 0.7071067811865476 1\n");
  ethd_scene *again = rig_scene(text);
  char *twin = print(again);
  ck_assert_str_eq(text, twin);
  free(text);
  free(twin);
  ethd_scene_destroy(s);
  ethd_scene_destroy(again);
}
END_TEST

/* ---- broken drawings ---- */

START_TEST(test_broken_drawings) {
  static const char seed[] =
      OPEN "<g fill='none' transform='translate(1,2) rotate(30) scale(.5)'><path d='M1 1h5v5z m2 2q3 4 5 6t3-2'/></g>\n"
           "<path style='fill:none' d='M10 10C20 40 40-10 50 20s5 5 6 6A3 4 5 0 1 60 40z'/><circle cx='9' r='2'/>"
           "<rect x='1' y='2' width='3' height='4' rx='1'/><ellipse rx='3' ry='2'/><polygon points='0 0 3 0 3 3'/>"
           "<polyline points='1,1 2,3 4,4'/><line x2='5mm'/><title>x</title>" CLOSE;
  static const char *const words[] = {"<g>",
                                      "</g>",
                                      "<path d='M0 0L1 1'/>",
                                      "'",
                                      "e9",
                                      "e-9",
                                      "-",
                                      ".",
                                      "0",
                                      "NaN",
                                      "A",
                                      "C",
                                      "M",
                                      "Z",
                                      "1e308",
                                      "matrix(1 2 3 4 5 6)",
                                      "&lt;",
                                      "<!--",
                                      "-->",
                                      "fill='none'",
                                      "display='none'",
                                      " ",
                                      "\n",
                                      "/>",
                                      NULL};
  const char *wanted = getenv("ETHD_FUZZ");
  uint64_t cases = wanted ? strtoull(wanted, NULL, 10) : 20000, taken = 0;
  char text[2 * sizeof seed + 64];
  options.tolerance = 1e-3;
  ethd_scene_destroy(scene_of(seed));
  for (uint64_t i = 0; i < cases; i++) {
    size_t n = mutate(seed, sizeof seed - 1, words, i, text, sizeof text);
    char *exact = malloc(n + 1);
    ethd_scene *scene;
    memcpy(exact, text, n);
    message[0] = 0;
    ethd_status status = ethd_svg_parse(exact, n, "t.svg", &options, &scene, &notes, message);
    free(exact);
    ck_assert(status <= 0 && (status == 0) == (scene != NULL));
    if (status) {
      ck_assert(strncmp(message, "t.svg:", 6) == 0 && !strchr(message, '\n'));
      continue;
    }
    taken++;
    ethd_nearest q;
    ethd_scene_query(scene, (ethd_vec){0.03, 0.02}, &q);
    ck_assert(q.object < 0 || isfinite(q.distance));
    ethd_scene_destroy(scene);
  }
  ck_assert_int_gt((int)(1000 * taken / cases), 20);
  if (wanted) printf("%llu drawings, %llu taken\n", (unsigned long long)cases, (unsigned long long)taken);
  options.tolerance = 1e-5;
}
END_TEST

/* Parts of a path that touch or overlap are refused, all others are taken: every pair is looked at here. */
START_TEST(test_parts_that_overlap) {
  int taken = 0;
  for (uint64_t i = 0; i < 3000; i++) {
    char text[1024] = OPEN "<path d='";
    int n = 2 + (int)(i % 6), corner[7][4];
    bool overlap = false;
    for (int k = 0; k < n; k++) {
      int *b = corner[k];
      for (int c = 0; c < 2; c++) {
        b[c] = (int)(12 * ethd__uniform((ethd__sim_key){i, (uint64_t)k}, (uint32_t)c, 0));
        b[c + 2] = b[c] + 1 + (int)(3 * ethd__uniform((ethd__sim_key){i, (uint64_t)k}, (uint32_t)c, 1));
      }
      for (int j = 0; j < k; j++)
        overlap |= b[0] <= corner[j][2] && corner[j][0] <= b[2] && b[1] <= corner[j][3] && corner[j][1] <= b[3];
      snprintf(text + strlen(text), sizeof text - strlen(text), "M%d %dH%dV%dH%dz", b[0], b[1], b[2], b[3], b[0]);
    }
    strcat(text, "'/>" CLOSE);
    ethd_scene *scene;
    ethd_status status = ethd_svg_parse(text, strlen(text), "t.svg", &options, &scene, &notes, message);
    ck_assert_msg((status < 0) == overlap, "%s: %s", text, message);
    taken += !overlap;
    ethd_scene_destroy(scene);
  }
  ck_assert(taken > 500 && taken < 2500);
}
END_TEST

/* A drawing of n points; CPU time of the best of three, s. */
static double time_of(int n) {
  char *text;
  size_t length;
  double best = INFINITY;
  FILE *out = open_memstream(&text, &length);
  fputs(OPEN "<polyline points=\"", out);
  for (int i = 0; i < n; i++) fprintf(out, "%d.%d,%d ", i % 97, i % 10, i % 43);
  fputs("\"/><path fill=\"none\" d=\"M0 0", out);
  for (int i = 0; i < n; i++) fprintf(out, "L%d %d.5", i % 89, i % 47);
  fputs("\"/><path d=\"", out); /* a stack of closed parts, which may be each other's holes */
  for (int i = 0; i < n / 4; i++) fprintf(out, "M0 %d.5h1v.25h-1z", i);
  fputs("\"/>" CLOSE, out);
  fclose(out);
  for (int i = 0; i < 3; i++) {
    clock_t start = clock();
    ethd_scene *scene = scene_of(text);
    best = fmin(best, (double)(clock() - start) / CLOCKS_PER_SEC);
    ethd_scene_destroy(scene);
  }
  free(text);
  return best;
}

/* Eight times as many points in eight times as long, and half as much again for what grows by a logarithm; looking at
   the rest of the text for each would take 64 times. */
START_TEST(test_time_is_linear) {
  double one = time_of(8000), eight = time_of(64000);
  ck_assert_msg(eight < 24 * one, "8 times the points took %.3g s, not %.3g s", eight, 8 * one);
}
END_TEST

int main(void) {
  Suite *suite = suite_create("svg");
  TCase *all = tcase_create("all");
  tcase_set_timeout(all, getenv("ETHD_FUZZ") ? 0 : 60);
  tcase_add_loop_test(all, test_elements, 0, sizeof elements / sizeof *elements);
  tcase_add_loop_test(all, test_curves_within_tolerance, 0, sizeof curves / sizeof *curves);
  tcase_add_test(all, test_page);
  tcase_add_test(all, test_skipped);
  tcase_add_loop_test(all, test_refusals, 0, sizeof refusals / sizeof *refusals);
  tcase_add_test(all, test_depth);
  tcase_add_test(all, test_print);
  tcase_add_test(all, test_broken_drawings);
  tcase_add_test(all, test_parts_that_overlap);
  tcase_add_test(all, test_time_is_linear);
  suite_add_tcase(suite, all);
  return rig_run(suite);
}
