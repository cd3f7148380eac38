#include <stdlib.h>
#include <string.h>

#include "fp_mode.h"
#include "scene/text.h"
#include "solids/solids.h"

#define SLACK 1e-14 /* of a coordinate: bound on the rounding error of a distance */

/* ---- reading ---- */

static ethd_status check(const ethd__written *o, ethd_error *error) {
  const ethd__solid_shape *shape = &ethd__solid_shapes[o->shape];
  ethd_status status = ethd__check_numbers(&shape->form, o->numbers, o->count, error);
  if (!status && shape->check) status = shape->check(o->numbers, error);
  if (status && error) error->line = o->line;
  return status;
}

static ethd_status read_objects(ethd__text *t, ethd__written *objects, size_t *count, ethd_error *error) {
  ethd_status status;
  while ((status = ethd__text_next(t, &objects[*count])) == ETHD_OK) ++*count;
  if (status != ETHD_STATUS_EMPTY) return status;
  if (*count > INT32_MAX) /* unreachable: in a test, since it needs 17 GB of text */
    return ethd__refuse(error, ETHD_E_FULL, "objects", (ethd__found){(double)*count, 0, INT32_MAX});
  for (size_t i = 0; i < *count; i++)
    if ((status = check(&objects[i], error)) != ETHD_OK) return status;
  return ETHD_OK;
}

/* ---- building ---- */

static ethd__bounds between(ethd_vec3 min, ethd_vec3 max) {
  ethd_vec3 half = ethd_vec3_scale(0.5, ethd_vec3_sub(max, min));
  return (ethd__bounds){ethd_vec3_add(min, half), half};
}

static ethd__bounds widened(ethd__bounds b) {
  b.half.x += SLACK * (fabs(b.centre.x) + b.half.x);
  b.half.y += SLACK * (fabs(b.centre.y) + b.half.y);
  b.half.z += SLACK * (fabs(b.centre.z) + b.half.z);
  return b;
}

static void extend(ethd_solids *s, ethd__bounds b) {
  ethd_vec3 low = ethd_vec3_sub(b.centre, b.half), high = ethd_vec3_add(b.centre, b.half);
  s->min = (ethd_vec3){fmin(s->min.x, low.x), fmin(s->min.y, low.y), fmin(s->min.z, low.z)};
  s->max = (ethd_vec3){fmax(s->max.x, high.x), fmax(s->max.y, high.y), fmax(s->max.z, high.z)};
}

static void fill(ethd_solids *s, const ethd__written *objects, ethd__bounds *bounds, ethd__solid *solids,
                 double *kept) {
  size_t first = 0, front = 0, back = s->bounded;
  for (size_t i = 0; i < s->count; i++) {
    const ethd__written *o = &objects[i];
    const ethd__solid_shape *shape = &ethd__solid_shapes[o->shape];
    size_t place = shape->bounds ? front++ : back++;
    shape->keep(o->numbers, o->count, kept + first);
    solids[place] = (ethd__solid){first, (int32_t)i, o->material, (uint32_t)o->shape};
    if (shape->bounds) {
      ethd__bounds b = shape->bounds(kept + first);
      extend(s, b);
      bounds[place] = widened(b);
    }
    first += shape->kept;
  }
}

static size_t reserve(size_t *bytes, size_t size) {
  size_t at = *bytes;
  *bytes += (size + 15) / 16 * 16;
  return at;
}

/* Makes solids of checked objects; NULL: no memory. */
static ethd_solids *build(const ethd__written *objects, size_t count, const ethd_material *materials,
                          size_t material_count) {
  size_t bytes = 0, numbers = 0, bounded = 0;
  for (size_t i = 0; i < count; i++) {
    numbers += ethd__solid_shapes[objects[i].shape].kept;
    bounded += ethd__solid_shapes[objects[i].shape].bounds != NULL;
  }
  reserve(&bytes, sizeof(ethd_solids));
  size_t bounds_at = reserve(&bytes, bounded * sizeof(ethd__bounds));
  size_t solids_at = reserve(&bytes, count * sizeof(ethd__solid));
  size_t numbers_at = reserve(&bytes, numbers * sizeof(double));
  size_t materials_at = reserve(&bytes, material_count * sizeof *materials);
  char *base = malloc(bytes);
  if (!base) return NULL;
  ethd_solids *s = (void *)base;
  *s = (ethd_solids){.bounds = (void *)(base + bounds_at),
                     .solids = (void *)(base + solids_at),
                     .numbers = (void *)(base + numbers_at),
                     .materials = (void *)(base + materials_at),
                     .bounded = bounded,
                     .count = count,
                     .material_count = material_count,
                     .bytes = bytes,
                     .min = {INFINITY, INFINITY, INFINITY},
                     .max = {-INFINITY, -INFINITY, -INFINITY}};
  memcpy(base + materials_at, materials, material_count * sizeof *materials);
  fill(s, objects, (void *)(base + bounds_at), (void *)(base + solids_at), (void *)(base + numbers_at));
  if (bounded) s->all = widened(between(s->min, s->max));
  return s;
}

/* ---- all ---- */

static ethd_status read_all(ethd__text *t, ethd_solids **out, ethd_error *error) {
  size_t count = 0, material_count;
  const ethd_material *materials = ethd__text_materials(t, &material_count);
  ethd__written *objects = malloc((ethd__text_lines(t) + 1) * sizeof *objects);
  if (!objects) return ethd__error(error, ETHD_E_MEMORY, "solids");
  ethd_status status = ethd__check_materials(materials, material_count, error);
  if (!status) status = read_objects(t, objects, &count, error);
  if (!status) *out = build(objects, count, materials, material_count);
  free(objects);
  if (!status && !*out) status = ethd__error(error, ETHD_E_MEMORY, "solids");
  return status;
}

ETHD__FP_APART static ethd_status parse(const char *text, size_t length, ethd_solids **out, ethd_error *error) {
  ethd__text *t;
  *out = NULL;
  ethd_status status = ethd__text_open(text, length, &ethd__space, &t, error);
  if (!status) status = read_all(t, out, error);
  ethd__text_close(t);
  return status;
}

ethd_status ethd_solids_parse(const char *text, size_t length, ethd_solids **out, ethd_error *error) {
  ETHD__FP_RETURN(ethd_status, parse(text, length, out, error));
}

void ethd_solids_destroy(ethd_solids *solids) { free(solids); }
