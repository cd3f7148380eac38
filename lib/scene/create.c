#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "fp_mode.h"
#include "scene/build.h"
#include "scene/check.h"
#include "scene/shapes.h"

static uint32_t edges_of(const ethd_object_def *o) {
  return ethd__shapes[o->shape].is_chain ? (uint32_t)(ethd__kept_count(o) / 2 - 1) : 0;
}

/* Returns true for an object without bounds, which is in no tree. */
static bool is_endless(const ethd_object_def *o) {
  const ethd__shape *s = &ethd__shapes[o->shape];
  return !s->is_chain && !s->discs;
}

/* ---- sizes ---- */

static size_t reserve(size_t *bytes, size_t size) {
  size_t at = *bytes;
  *bytes += (size + 63) / 64 * 64;
  return at;
}

/* Computes the sizes and offsets of all arrays. The nodes of chains come first, since only they have slopes. */
static ethd_status plan(const ethd_scene_def *def, ethd_scene *s, ethd_error *error) {
  size_t numbers = 0, nodes = 0, endless = 0;
  for (size_t i = 0; i < def->object_count; i++) {
    numbers += ethd__kept_count(&def->objects[i]);
    if (edges_of(&def->objects[i]) > ETHD__FLAT) {
      nodes += ethd__node_count(edges_of(&def->objects[i]));
      s->tree_count++;
    }
    endless += is_endless(&def->objects[i]);
  }
  if (numbers > UINT32_MAX) /* unreachable: in a test, since it needs 34 GB of numbers */
    return ethd__refuse(error, ETHD_E_FULL, "numbers", (ethd__found){(double)numbers, 0, UINT32_MAX});
  s->object_count = (uint32_t)def->object_count;
  s->material_count = (uint32_t)def->material_count;
  s->number_count = (uint32_t)numbers;
  ethd__tree_set(&s->tree, (uint32_t)(def->object_count - endless), (uint32_t)nodes);
  s->node_count = (uint32_t)nodes + ethd__node_count(s->tree.leaves);
  reserve(&s->bytes, sizeof *s);
  s->nodes_at = reserve(&s->bytes, s->node_count * sizeof(ethd__node));
  s->objects_at = reserve(&s->bytes, s->object_count * sizeof(ethd__object));
  s->numbers_at = reserve(&s->bytes, s->number_count * sizeof(double));
  s->trees_at = reserve(&s->bytes, s->tree_count * sizeof(ethd__tree));
  s->places_at = reserve(&s->bytes, s->object_count * sizeof(uint32_t));
  s->slopes_at = reserve(&s->bytes, nodes * ETHD__WIDE * sizeof(float));
  s->materials_at = reserve(&s->bytes, s->material_count * sizeof(ethd_material));
  return ETHD_OK;
}

/* ---- bounds ---- */

typedef struct bounds {
  double x_min, x_max, y_min, y_max;
} bounds;

static const bounds nowhere = {INFINITY, -INFINITY, INFINITY, -INFINITY};

/* Comparisons are faster than fmin and fmax, which handle NaN too. */
static double lesser(double a, double b) { return a < b ? a : b; }
static double greater(double a, double b) { return a > b ? a : b; }

static bounds together(bounds a, bounds b) {
  bounds r = {lesser(a.x_min, b.x_min), greater(a.x_max, b.x_max), lesser(a.y_min, b.y_min), greater(a.y_max, b.y_max)};
  return r;
}

static bounds around(ethd__disc d) {
  bounds b = {d.centre.x - d.radius, d.centre.x + d.radius, d.centre.y - d.radius, d.centre.y + d.radius};
  return b;
}

static bounds bounds_of(const ethd_object_def *def) {
  const ethd__shape *s = &ethd__shapes[def->shape];
  double room[ETHD__KEPT_MAX];
  const double *kept = s->is_chain ? def->numbers : room;
  size_t discs = s->is_chain ? def->count / 2 : s->discs;
  bounds b = nowhere;
  if (!s->is_chain) ethd__keep(def, room);
  for (size_t k = 0; k < discs; k++) b = together(b, around(ethd__disc_at(s, kept, k)));
  return b;
}

/* The trees' frame: centre and scale map the bounds into [-1, 1]. */
static void frame(ethd_scene *s, bounds b) {
  int exponent = 0;
  s->x_min = b.x_min, s->x_max = b.x_max, s->y_min = b.y_min, s->y_max = b.y_max;
  s->scale = 1;
  if (!(b.x_min <= b.x_max)) return;
  s->centre = (ethd_vec){b.x_min + (b.x_max - b.x_min) / 2, b.y_min + (b.y_max - b.y_min) / 2};
  double half =
      fmax(fmax(b.x_max - s->centre.x, s->centre.x - b.x_min), fmax(b.y_max - s->centre.y, s->centre.y - b.y_min));
  frexp(half, &exponent);
  s->scale = ldexp(1, exponent < -400 ? 400 : -exponent); /* its square is finite */
}

/* Returns the largest of an object's coordinates and lengths: the scale of its rounding errors. */
static double largest(const ethd_object_def *def) {
  const ethd__shape *s = &ethd__shapes[def->shape];
  double most = 0;
  for (size_t k = 0; k < def->count; k++)
    if (s->form.numbers[ethd__number_of(&s->form, k)].kind != ETHD__DIRECTION)
      most = greater(most, fabs(def->numbers[k]));
  return most;
}

/* ---- objects ---- */

static ethd_vec point(const double *p, size_t k) {
  ethd_vec r = {p[2 * k], p[2 * k + 1]};
  return r;
}

/* Returns a polygon's winding: its turn at the first point in the order of x, then y, since it is convex there. */
static int turn_of(const double *p, size_t n) {
  size_t k = 0;
  for (size_t i = 1; i < n; i++)
    if (p[2 * i] < p[2 * k] || (p[2 * i] == p[2 * k] && p[2 * i + 1] < p[2 * k + 1])) k = i;
  return ethd__orient(point(p, k ? k - 1 : n - 1), point(p, k), point(p, k + 1 < n ? k + 1 : 0));
}

static bool is_closed(const double *points, uint32_t edges) {
  return edges > 2 && points[0] == points[2 * edges] && points[1] == points[2 * edges + 1];
}

static void measure(const ethd_scene_def *def, ethd_scene *s) {
  bounds all = nowhere;
  double extent = 0;
  for (uint32_t i = 0; i < s->object_count; i++) {
    all = together(all, bounds_of(&def->objects[i]));
    extent = greater(extent, largest(&def->objects[i]));
  }
  s->slack = 16 * DBL_EPSILON * extent;
  frame(s, all);
}

static uint32_t step_of(const ethd_scene *s, double low, double high, double centre) {
  double v = s->scale * (low / 2 + high / 2 - centre);
  return (uint32_t)((v + 1) / 2 * UINT32_MAX);
}

/* Puts the objects into the order of the leaves; endless ones come last. */
static void order(const ethd_scene_def *def, const ethd_scene *s, ethd__item *items) {
  uint32_t n = 0, last = s->tree.leaves;
  for (uint32_t i = 0; i < s->object_count; i++) {
    bounds b = bounds_of(&def->objects[i]);
    if (is_endless(&def->objects[i])) {
      items[last++].id = i;
    } else {
      items[n++] =
          (ethd__item){{step_of(s, b.x_min, b.x_max, s->centre.x), step_of(s, b.y_min, b.y_max, s->centre.y)}, i};
    }
  }
  ethd__order_build(items, s->tree.leaves);
}

static void fill(const ethd_scene_def *def, const int32_t *ids, ethd_scene *s, const ethd__item *items) {
  char *base = (char *)s;
  ethd__object *objects = (void *)(base + s->objects_at);
  ethd__tree *trees = (void *)(base + s->trees_at);
  uint32_t *places = (void *)(base + s->places_at), number = 0, tree = 0, node = 0;
  for (uint32_t i = 0; i < s->object_count; i++) {
    const ethd_object_def *d = &def->objects[items[i].id];
    uint32_t edges = edges_of(d);
    double *numbers = (double *)(void *)(base + s->numbers_at) + number;
    ethd__keep(d, numbers);
    objects[i] = (ethd__object){.id = ids ? ids[items[i].id] : (int32_t)items[i].id,
                                .material = d->material,
                                .first = number,
                                .edges = edges,
                                .tree = tree,
                                .shape = (int8_t)d->shape};
    if (ethd__shapes[d->shape].is_closed) objects[i].turn = (int8_t)turn_of(d->numbers, d->count / 2);
    if (edges) objects[i].closed = is_closed(numbers, edges);
    places[items[i].id] = i;
    number += (uint32_t)ethd__kept_count(d);
    if (edges <= ETHD__FLAT) continue;
    ethd__tree_set(&trees[tree++], edges, node);
    node += ethd__node_count(edges);
  }
  if (s->material_count) memcpy(base + s->materials_at, def->materials, s->material_count * sizeof(ethd_material));
}

/* ---- all ---- */

static ethd_status check(const ethd_scene_def *def, ethd_error *error) {
  void *room = malloc(ethd__check_room(def));
  if (!room) return ethd__error(error, ETHD_E_MEMORY, "scene");
  ethd_status status = ethd__check_scene(def, room, error);
  free(room);
  return status;
}

static bool build(const ethd_scene_def *def, const int32_t *ids, ethd_scene *scene) {
  ethd__item *items = malloc((scene->object_count + (size_t)1) * sizeof *items);
  if (!items) return false;
  measure(def, scene);
  order(def, scene, items);
  fill(def, ids, scene, items);
  free(items);
  void *room = malloc(ethd__nodes_room(scene));
  if (!room) return false;
  ethd__nodes_build(scene, room);
  free(room);
  return true;
}

ethd_status ethd__scene_make(const ethd_scene_def *def, const int32_t *ids, ethd_scene **out, ethd_error *error) {
  ethd_scene empty;
  memset(&empty, 0, sizeof empty);
  empty.outer = INFINITY;
  *out = NULL;
  ethd_status status = plan(def, &empty, error);
  if (status) return status; /* unreachable: it fails only with more numbers than a test has */
  ethd_scene *scene = aligned_alloc(64, empty.bytes);
  if (scene) {
    memset(scene, 0, empty.bytes);
    *scene = empty;
  }
  if (!scene || !build(def, ids, scene)) {
    free(scene);
    return ethd__error(error, ETHD_E_MEMORY, "scene");
  }
  *out = scene;
  return ETHD_OK;
}

ETHD__FP_APART static ethd_status create(const ethd_scene_def *def, ethd_scene **out, ethd_error *error) {
  *out = NULL;
  ethd_status status = check(def, error);
  return status ? status : ethd__scene_make(def, NULL, out, error);
}

ethd_status ethd_scene_create(const ethd_scene_def *def, ethd_scene **out, ethd_error *error) {
  ETHD__FP_RETURN(ethd_status, create(def, out, error));
}

void ethd_scene_destroy(ethd_scene *scene) { free(scene); }
