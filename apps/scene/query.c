/* Calculates distances of points to a scene. */
#include "cli/cli.h"
#include "scene/scene.h"
#include "text/csv.h"

#define COORDINATE_MAX 1e9 /* m */

static int column(const ethd_csv *points, const char *name) {
  int c = ethd_csv_column(points, name);
  if (c < 0) ethd__fail(ETHD_EXIT_INPUT, "%s:1: the column %s is missing; x_m and y_m are needed", points->path, name);
  return c;
}

static double coordinate(const ethd_csv *points, size_t row, int c) {
  double v = points->values[row * points->columns + (size_t)c];
  if (v >= -COORDINATE_MAX && v <= COORDINATE_MAX) return v;
  const char *name = points->names[c];
  if (ethd_csv_empty(points, row, c))
    ethd__fail(ETHD_EXIT_INPUT, "%s:%zu: %s: empty; a number is needed", points->path, ethd_csv_line(row), name);
  ethd__fail(ETHD_EXIT_INPUT, "%s:%zu: %s: found %g, allowed %g to %g", points->path, ethd_csv_line(row), name, v,
             -COORDINATE_MAX, COORDINATE_MAX);
}

static void write_nearest(ethd_csv_out *out, const ethd_nearest *nearest) {
  ethd_csv_number(out, nearest->distance);
  ethd_csv_number(out, nearest->n.x);
  ethd_csv_number(out, nearest->n.y);
  ethd_csv_integer(out, nearest->object);
  ethd_csv_row(out);
}

int ethd__scene_query(const ethd__scene_args *arg) {
  static const char *const wanted[] = {"x_m", "y_m", NULL};
  char message[ETHD_MESSAGE_MAX];
  ethd_csv points;
  double seconds;
  ethd_scene *scene = ethd__scene_load(arg->scene, &seconds);
  ethd__need(ethd_csv_read_columns(arg->in, wanted, &points, message), message);
  int x = column(&points, "x_m"), y = column(&points, "y_m");
  for (size_t row = 0; row < points.rows; row++) {
    coordinate(&points, row, x);
    coordinate(&points, row, y);
  }
  ethd__refuse_input("--out", arg->out, "--in", arg->in);
  ethd__refuse_input("--out", arg->out, "--scene", arg->scene);
  ethd_csv_out *out = ethd_csv_create(arg->out, "distance_m,nx,ny,object", message);
  if (!out) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  for (size_t row = 0; row < points.rows && !ethd__stop; row++) {
    ethd_vec at = {coordinate(&points, row, x), coordinate(&points, row, y)};
    ethd_nearest nearest;
    ethd_scene_query(scene, at, &nearest);
    write_nearest(out, &nearest);
    ethd__progress(row + 1, points.rows, "points");
  }
  if (ethd__stop)
    ethd_csv_abandon(out);
  else if (ethd_csv_close(out, message) < 0)
    ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  ethd_csv_free(&points);
  ethd_scene_destroy(scene);
  return ethd__stop ? ETHD_EXIT_FAILED : ETHD_EXIT_DONE;
}
