/* Writes a picture of a scene and its trees as pieces of lines: a CSV that apps/plot/scene.gp draws. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/picture.h"
#include "ethd/maths.h"
#include "scene/scene.h"
#include "text/csv.h"

#define BOXES_MAX 5000 /* of a level: more can't be seen */
#define LEVELS 16
#define ARC 96 /* pieces of a circle */
#define TURN 6.28318530717958647692

/* ---- pieces ---- */

typedef struct pen {
  ethd_csv_out *out;
  const char *what;
  int32_t number; /* of the object, or the level */
  ethd_vec at;
} pen;

static void line_to(pen *p, ethd_vec to) {
  ethd_csv_word(p->out, p->what);
  ethd_csv_integer(p->out, p->number);
  ethd_csv_number(p->out, p->at.x);
  ethd_csv_number(p->out, p->at.y);
  ethd_csv_number(p->out, to.x - p->at.x);
  ethd_csv_number(p->out, to.y - p->at.y);
  ethd_csv_row(p->out);
  p->at = to;
}

static ethd_vec on_circle(ethd_vec c, double r, double angle) {
  double sine, cosine;
  ethd_sincos(angle, &sine, &cosine);
  return (ethd_vec){c.x + r * cosine, c.y + r * sine};
}

static void draw_arc(pen *p, ethd_vec c, double r, double from, double turn) {
  p->at = on_circle(c, r, from);
  for (int k = 1; k <= ARC; k++) line_to(p, on_circle(c, r, from + turn * k / ARC));
}

static void draw_box(pen *p, ethd_vec centre, double cosine, double sine, double w, double h) {
  static const int corners[5][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
  for (int k = 0; k < 5; k++) {
    double u = w * corners[k][0], v = h * corners[k][1];
    ethd_vec to = {centre.x + cosine * u - sine * v, centre.y + sine * u + cosine * v};
    if (k) line_to(p, to);
    p->at = to;
  }
}

/* ---- objects ---- */

/* Draws a convex solid: the points nearest to far away ones in every direction outline it. */
static void draw_solid(pen *p, const ethd_scene *scene, double size) {
  ethd_touch touch;
  for (int k = 0; k <= ARC; k++) {
    ethd_vec from = on_circle((ethd_vec){0, 0}, 1e3 * size, TURN * k / ARC);
    ethd_scene_follow(scene, p->number, from, from, &touch);
    if (k) line_to(p, touch.point);
    p->at = touch.point;
  }
}

/* How chains are drawn; a shape without a row is drawn by its distance. */
static const struct {
  const char *what;
  bool is_closed;
} chains[ETHD_SHAPE_COUNT] = {
    [ETHD_SHAPE_SEGMENT] = {"wall", false},
    [ETHD_SHAPE_POLYLINE] = {"wall", false},
    [ETHD_SHAPE_POLYGON] = {"solid", true},
};

static void draw_chain(pen *p, const ethd_object_def *o) {
  const double *v = o->numbers;
  p->at = (ethd_vec){v[0], v[1]};
  for (size_t k = 2; k < o->count; k += 2) line_to(p, (ethd_vec){v[k], v[k + 1]});
  if (chains[o->shape].is_closed) line_to(p, (ethd_vec){v[0], v[1]});
}

/* Draws a wall as long as the picture; a short line marks its solid side. */
static void draw_halfplane(pen *p, const double *v, double size) {
  ethd_vec foot = {v[0] * v[2], v[1] * v[2]}, along = {-v[1] * size, v[0] * size};
  p->at = ethd_vec_sub(foot, along);
  line_to(p, ethd_vec_add(foot, along));
  p->at = foot;
  line_to(p, ethd_vec_add(foot, ethd_vec_scale(0.02 * size, (ethd_vec){v[0], v[1]})));
}

static void draw_object(pen *p, const ethd_scene *scene, const ethd_object_def *o, double size) {
  p->what = o->shape == ETHD_SHAPE_HALFPLANE ? "halfplane" : chains[o->shape].what ? chains[o->shape].what : "solid";
  if (o->shape == ETHD_SHAPE_HALFPLANE)
    draw_halfplane(p, o->numbers, size);
  else if (chains[o->shape].what)
    draw_chain(p, o);
  else
    draw_solid(p, scene, size);
}

/* ---- trees ---- */

static void draw_trees(pen *p, const ethd_scene *scene, const ethd_scene_info *info) {
  size_t counts[LEVELS] = {0};
  ethd_scene_box b;
  for (size_t i = 0; i < info->boxes; i++)
    if (ethd_scene_box_at(scene, i, &b) == ETHD_OK && b.level < LEVELS) counts[b.level]++;
  for (int level = 1; level < LEVELS; level++)
    if (counts[level] > BOXES_MAX) printf("not drawn: the %zu boxes of level %d\n", counts[level], level);
  p->what = "box";
  for (size_t i = 0; i < info->boxes; i++) {
    if (ethd_scene_box_at(scene, i, &b) != ETHD_OK || b.level >= LEVELS || counts[b.level] > BOXES_MAX) continue;
    p->number = b.level;
    draw_box(p, b.centre, b.cosine, b.sine, b.half_u, b.half_v);
  }
}

static void draw_reach(pen *p, const ethd_setup *setup) {
  double radii[2];
  ethd_arm_reach(&setup->arm, &radii[0], &radii[1]);
  p->what = "reach";
  p->number = 0;
  for (int i = 0; i < 2; i++)
    if (radii[i] > 0) draw_arc(p, (ethd_vec){0, 0}, radii[i], 0, TURN);
}

static void draw_all(ethd_csv_out *out, const ethd_scene *scene, const ethd_setup *setup) {
  pen p = {.out = out};
  ethd_object_def o;
  ethd_scene_info info;
  ethd_scene_describe(scene, &info);
  double inner, size;
  ethd_arm_reach(&setup->arm, &inner, &size);
  if (info.x_min <= info.x_max) size = fmax(size, hypot(fmax(-info.x_min, info.x_max), fmax(-info.y_min, info.y_max)));
  for (size_t i = 0; (p.number = ethd_scene_object(scene, i, &o)) >= 0; i++) draw_object(&p, scene, &o, 4 * size);
  draw_trees(&p, scene, &info);
  draw_reach(&p, setup);
}

/* ---- files ---- */

int ethd__scene_plot(const ethd__scene_args *arg, const ethd_scene *scene, const ethd_setup *setup) {
  char message[ETHD_MESSAGE_MAX];
  ETHD__FREED char *csv = ethd__picture_table(arg->plot);
  ethd__refuse_input("--plot", arg->plot, "info", arg->scene);
  ethd__refuse_input("--plot", csv, "info", arg->scene);
  ethd__refuse_input("--plot", csv, "--config", arg->config);
  ethd_csv_out *out = ethd_csv_create(csv, "what,number,x_m,y_m,dx_m,dy_m", message);
  if (!out) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  draw_all(out, scene, setup);
  ethd__must(ethd_csv_close(out, message), message);
  const ethd__picture_value values[] = {
      {"in", csv, true}, {"out", arg->plot, true}, {"name", arg->scene, false}, {NULL, NULL, false}};
  ethd__must(ethd__picture_ready(message), message);
  ethd__must(ethd__picture_draw("scene.gp", NULL, values, message), message);
  printf("picture:      %s, drawn from %s\n", arg->plot, csv);
  return ETHD_EXIT_DONE;
}
