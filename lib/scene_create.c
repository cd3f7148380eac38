#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "ethd/maths.h"
#include "error.h"
#include "scene.h"
#include "scene_check.h"

/* Boxes keep the cosine and the sine of their angle. */
static size_t kept_numbers(const ethd_object_def *o) { return o->count + (o->shape == ETHD_BOX); }

static size_t kept_points(const ethd_object_def *o) { return o->count / 2 + (o->shape == ETHD_POLYGON); }

static size_t reserve(size_t *bytes, size_t size) {
  size_t at = *bytes;
  *bytes += (size + 7) / 8 * 8;
  return at;
}

static void lay_out(const ethd_scene_def *def, ethd_scene *s) {
  size_t n = s->object_count = def->object_count, bytes = 0;
  s->material_count = def->material_count;
  for (size_t i = 0; i < n; i++) {
    const ethd_object_def *o = &def->objects[i];
    if (ethd__is_chain(o->shape)) s->point_count += kept_points(o);
    else s->number_count += kept_numbers(o);
  }
  reserve(&bytes, sizeof *s);
  s->objects_at = reserve(&bytes, n * sizeof(ethd__object));
  s->x_min_at = reserve(&bytes, n * sizeof(double));
  s->x_max_at = reserve(&bytes, n * sizeof(double));
  s->y_min_at = reserve(&bytes, n * sizeof(double));
  s->y_max_at = reserve(&bytes, n * sizeof(double));
  s->numbers_at = reserve(&bytes, s->number_count * sizeof(double));
  s->x_at = reserve(&bytes, s->point_count * sizeof(double));
  s->y_at = reserve(&bytes, s->point_count * sizeof(double));
  s->materials_at = reserve(&bytes, def->material_count * sizeof(ethd_material));
  s->bytes = bytes;
}

typedef struct box {
  double x_min, x_max, y_min, y_max;
} box;

static box around(double x, double y, double w, double h) {
  box b = {x - w, x + w, y - h, y + h};
  return b;
}

static box together(box a, box b) {
  box r = {fmin(a.x_min, b.x_min), fmax(a.x_max, b.x_max), fmin(a.y_min, b.y_min), fmax(a.y_max, b.y_max)};
  return r;
}

static box keep_numbers(const ethd_object_def *def, double *kept) {
  const double *p = def->numbers;
  double length;
  memcpy(kept, p, def->count * sizeof *p);
  switch (def->shape) {
    case ETHD_CIRCLE: return around(p[0], p[1], p[2], p[2]);
    case ETHD_CAPSULE: return together(around(p[0], p[1], p[4], p[4]), around(p[2], p[3], p[4], p[4]));
    case ETHD_BOX:
      ethd_sincos(p[4], &kept[5], &kept[4]);
      return around(p[0], p[1], fabs(kept[4]) * p[2] + fabs(kept[5]) * p[3],
                    fabs(kept[5]) * p[2] + fabs(kept[4]) * p[3]);
    default:
      length = sqrt(p[0] * p[0] + p[1] * p[1]);
      for (int i = 0; i < 3; i++) kept[i] = p[i] / length;
      return around(0, 0, INFINITY, INFINITY);
  }
}

static ethd_vec point(const double *p, size_t k) {
  ethd_vec r = {p[2 * k], p[2 * k + 1]};
  return r;
}

/* The turn at the first point in the order of x, then y: the polygon is convex there. */
static int turn_of(const double *p, size_t n) {
  size_t k = 0;
  for (size_t i = 1; i < n; i++)
    if (p[2 * i] < p[2 * k] || (p[2 * i] == p[2 * k] && p[2 * i + 1] < p[2 * k + 1])) k = i;
  return ethd__orient(point(p, k ? k - 1 : n - 1), point(p, k), point(p, k + 1 < n ? k + 1 : 0));
}

static box keep_points(const ethd_object_def *def, ethd__object *o, double *x, double *y) {
  const double *p = def->numbers;
  size_t n = def->count / 2, kept = kept_points(def);
  box b = around(p[0], p[1], 0, 0);
  for (size_t k = 0; k < kept; k++) {
    x[k] = p[2 * (k % n)];
    y[k] = p[2 * (k % n) + 1];
    b = together(b, around(x[k], y[k], 0, 0));
  }
  o->edges = (uint32_t)(kept - 1);
  o->turn = def->shape == ETHD_POLYGON ? turn_of(p, n) : 0;
  o->closed = kept > 3 && x[0] == x[kept - 1] && y[0] == y[kept - 1];
  return b;
}

static double largest(const ethd_object_def *def) {
  double most = 0;
  for (size_t k = 0; k < def->count; k++) most = fmax(most, fabs(def->numbers[k]));
  return most;
}

static void fill(const ethd_scene_def *def, ethd_scene *s) {
  char *base = (char *)s;
  ethd__object *objects = (void *)(base + s->objects_at);
  double *x_min = (void *)(base + s->x_min_at), *x_max = (void *)(base + s->x_max_at);
  double *y_min = (void *)(base + s->y_min_at), *y_max = (void *)(base + s->y_max_at);
  double *x = (void *)(base + s->x_at), *y = (void *)(base + s->y_at);
  double *numbers = (void *)(base + s->numbers_at);
  size_t number = 0, place = 0;
  double extent = 0;
  for (size_t i = 0; i < s->object_count; i++) {
    const ethd_object_def *d = &def->objects[i];
    ethd__object *o = &objects[i];
    bool chain = ethd__is_chain(d->shape);
    *o = (ethd__object){(int32_t)d->shape, d->material, (uint32_t)(chain ? place : number), 0, 0, 0};
    box b = chain ? keep_points(d, o, x + place, y + place) : keep_numbers(d, numbers + number);
    x_min[i] = b.x_min, x_max[i] = b.x_max, y_min[i] = b.y_min, y_max[i] = b.y_max;
    *(chain ? &place : &number) += chain ? kept_points(d) : kept_numbers(d);
    extent = fmax(extent, largest(d));
  }
  s->slack = 16 * DBL_EPSILON * extent;
  if (s->material_count)
    memcpy(base + s->materials_at, def->materials, s->material_count * sizeof(ethd_material));
}

static ethd_status check(const ethd_scene_def *def, ethd_error *error) {
  void *room = malloc(ethd__check_room(def));
  if (!room) return ethd__refuse(error, ETHD_E_MEMORY, "scene", NAN, NAN, NAN);
  ethd_status status = ethd__check_scene(def, room, error);
  free(room);
  return status;
}

ethd_status ethd_scene_create(const ethd_scene_def *def, ethd_scene **out, ethd_error *error) {
  *out = NULL;
  ethd_status status = check(def, error);
  if (status) return status;
  ethd_scene plan = {0};
  lay_out(def, &plan);
  if (plan.point_count > UINT32_MAX || plan.number_count > UINT32_MAX)
    return ethd__refuse(error, ETHD_E_FULL, "numbers", (double)(plan.point_count + plan.number_count), 0,
                        UINT32_MAX);
  ethd_scene *scene = calloc(1, plan.bytes);
  if (!scene) return ethd__refuse(error, ETHD_E_MEMORY, "scene", NAN, NAN, NAN);
  *scene = plan;
  fill(def, scene);
  *out = scene;
  return ETHD_OK;
}

void ethd_scene_destroy(ethd_scene *scene) { free(scene); }
