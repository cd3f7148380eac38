/* What a scene holds, and how far points are from it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "common/cli.h"
#include "ethd/config.h"
#include "file/csv.h"
#include "file/text.h"

#define SCENE_BYTES_MAX ((size_t)1 << 30)
#define COORDINATE_MAX 1e9 /* m */

static const char doc[] =
    "Says what a scene holds, or the signed distance of points from it.\v"
    "query: IN needs the columns x_m,y_m; OUT gets distance_m,nx,ny,object, a row per point: the smallest "
    "signed distance over the objects, the normal into that object there, and its number in the file. Nothing "
    "is left out.\n"
    "info: counts, extent, build time, memory, and what the arm can't reach.\n\n"
    "Example:\n"
    "  ethd-scene query --scene walls.scene --in points.csv --out distances.csv\n"
    "  ethd-scene info walls.scene";

static const struct argp_option options[] = {
    {"scene", 's', "F", 0, "query: the scene", 0},
    {"in", 'i', "IN.csv", 0, "query: points", 0},
    {"out", 'o', "OUT.csv", 0, "query: distances", 0},
    {"config", 'c', "C.ini", 0, "info: whose arm and ring; defaults without", 0},
    {0},
};

static struct {
  const char *command, *scene, *in, *out, *config;
} arg;

static bool is(const char *a, const char *b) { return a && strcmp(a, b) == 0; }

static void check_usage(struct argp_state *state) {
  if (is(arg.command, "query")) {
    if (!arg.scene || !arg.in || !arg.out) argp_error(state, "query needs --scene, --in and --out");
    if (arg.config) argp_error(state, "--config is for info");
  } else if (is(arg.command, "info")) {
    if (!arg.scene) argp_error(state, "info needs a scene file");
    if (arg.in || arg.out) argp_error(state, "--in and --out are for query");
  } else {
    argp_error(state, "what to do: query or info");
  }
}

static void take_word(char *word, struct argp_state *state) {
  if (!arg.command) {
    if (!is(word, "query") && !is(word, "info"))
      argp_error(state, "\"%s\": unknown; query or info is allowed", word);
    arg.command = word;
  } else if (is(arg.command, "info") && !arg.scene) {
    arg.scene = word;
  } else {
    argp_error(state, "\"%s\": no such argument", word);
  }
}

static error_t parse(int key, char *text, struct argp_state *state) {
  switch (key) {
    case 's': arg.scene = text; return 0;
    case 'i': arg.in = text; return 0;
    case 'o': arg.out = text; return 0;
    case 'c': arg.config = text; return 0;
    case ARGP_KEY_ARG: take_word(text, state); return 0;
    case ARGP_KEY_END: check_usage(state); return 0;
    default: return ARGP_ERR_UNKNOWN;
  }
}

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static ethd_scene *load(const char *path, double *seconds) {
  char message[ETHD_MESSAGE_MAX], *text;
  size_t length;
  ethd_scene *scene;
  ethd_error error;
  ethd_status status = ethd_text_read(path, SCENE_BYTES_MAX, &text, &length, message);
  if (status < 0) ethd__fail(ethd__exit_code(status), "%s", message);
  double start = now();
  status = ethd_scene_parse(text, length, &scene, &error);
  *seconds = now() - start;
  free(text);
  if (status >= 0) return scene;
  ethd_error_text(path, &error, message);
  ethd__fail(ethd__exit_code(status), "%s", message);
}

/* ---- query ---- */

static int column(const ethd_csv *points, const char *name) {
  int c = ethd_csv_column(points, name);
  if (c < 0)
    ethd__fail(ETHD_EXIT_INPUT, "%s:1: the column %s is missing; x_m and y_m are needed", arg.in, name);
  return c;
}

static double coordinate(const ethd_csv *points, size_t row, int c) {
  double v = points->values[row * points->columns + (size_t)c];
  if (v >= -COORDINATE_MAX && v <= COORDINATE_MAX) return v;
  const char *name = points->names[c];
  if (ethd_csv_empty(points, row, c))
    ethd__fail(ETHD_EXIT_INPUT, "%s:%zu: %s: empty; a number is needed", arg.in, ethd_csv_line(row), name);
  ethd__fail(ETHD_EXIT_INPUT, "%s:%zu: %s: found %g, allowed %g to %g", arg.in, ethd_csv_line(row), name, v,
             -COORDINATE_MAX, COORDINATE_MAX);
}

static void write_nearest(ethd_csv_out *out, const ethd_nearest *nearest) {
  ethd_csv_number(out, nearest->distance);
  ethd_csv_number(out, nearest->n.x);
  ethd_csv_number(out, nearest->n.y);
  ethd_csv_integer(out, nearest->object);
  ethd_csv_row(out);
}

static int query(void) {
  static const char *const wanted[] = {"x_m", "y_m", NULL};
  char message[ETHD_MESSAGE_MAX];
  ethd_csv points;
  double seconds;
  ethd_scene *scene = load(arg.scene, &seconds);
  ethd_status status = ethd_csv_read_columns(arg.in, wanted, &points, message);
  if (status < 0) ethd__fail(ethd__exit_code(status), "%s", message);
  int x = column(&points, "x_m"), y = column(&points, "y_m");
  for (size_t row = 0; row < points.rows; row++) {
    coordinate(&points, row, x);
    coordinate(&points, row, y);
  }
  ethd_csv_out *out = ethd_csv_create(arg.out, "distance_m,nx,ny,object", message);
  if (!out) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  for (size_t row = 0; row < points.rows && !ethd__stop; row++) {
    ethd_vec at = {coordinate(&points, row, x), coordinate(&points, row, y)};
    ethd_nearest nearest;
    ethd_scene_query(scene, at, &nearest);
    write_nearest(out, &nearest);
    ethd__progress(row + 1, points.rows, "points");
  }
  if (ethd_csv_close(out, message) < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  ethd_csv_free(&points);
  ethd_scene_destroy(scene);
  return ethd__stop ? ETHD_EXIT_FAILED : ETHD_EXIT_DONE;
}

/* ---- info ---- */

static ethd_setup setup_of(const char *path) {
  char message[ETHD_MESSAGE_MAX];
  ethd_config *config;
  if (!path) return ethd_setup_default();
  ethd_status status = ethd_config_load(path, &config, message);
  if (status < 0) ethd__fail(ethd__exit_code(status), "%s", message);
  ethd_setup setup = config->setup;
  setup.scene = NULL;
  ethd_config_free(config);
  return setup;
}

static void say_counts(const ethd_scene_info *info) {
  printf("%s: %zu objects\n", arg.scene, info->objects);
  for (int shape = 0; shape < ETHD_SHAPE_COUNT; shape++)
    if (info->by_shape[shape])
      printf("  %-10s %zu\n", ethd_shape_name((ethd_shape)shape), info->by_shape[shape]);
  printf("segments:     %zu (edges of polygons, polylines and segments)\n", info->segments);
  printf("materials:    %zu\n", info->materials);
  if (info->x_min <= info->x_max)
    printf("extent:       x %.9g to %.9g m, y %.9g to %.9g m%s\n", info->x_min, info->x_max, info->y_min,
           info->y_max, info->by_shape[ETHD_HALFPLANE] ? ", and half-planes" : "");
  else
    printf("extent:       %s\n", info->by_shape[ETHD_HALFPLANE] ? "half-planes only" : "none");
}

static int info(void) {
  double seconds;
  ethd_scene_info info;
  ethd_setup setup = setup_of(arg.config);
  ethd_scene *scene = load(arg.scene, &seconds);
  ethd_scene_describe(scene, &info);
  say_counts(&info);
  printf("build time:   %.3g ms (read and built)\n", 1e3 * seconds);
  printf("memory:       %zu bytes\n", info.bytes);
  printf("out of reach: %zu of %zu objects, which a controller drops (%s arm %g + %g m, ring %g m)\n",
         ethd_scene_out_of_reach(scene, &setup.arm, ethd_setup_range(&setup)), info.objects,
         setup.arm.mechanism == ETHD_ARM_SERIAL ? "serial" : "parallel", setup.arm.link1, setup.arm.link2,
         setup.ring_radius);
  ethd_scene_destroy(scene);
  return ETHD_EXIT_DONE;
}

int main(int argc, char **argv) {
  static const struct argp argp = {options, parse, "query\ninfo F", doc, NULL, NULL, NULL};
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  ethd__catch_interrupt();
  return ethd__end(is(arg.command, "query") ? query() : info());
}
