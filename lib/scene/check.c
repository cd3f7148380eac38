#include "scene/check.h"

#include <float.h>
#include <string.h>

#include "error.h"
#include "scene/scene.h"

#define POINTS_MAX (INT32_MAX / 2 - 1) /* a feature's number is twice a point's, plus 1 */

/* What each shape's numbers are. `sizes`: from this one on, up to `count`, they are lengths over 0. */
typedef struct form {
  size_t count, sizes;
  const char *names[5];
} form;

static const form forms[ETHD_SHAPE_COUNT] = {
    [ETHD_HALFPLANE] = {3, 3, {"halfplane nx", "halfplane ny", "halfplane c"}},
    [ETHD_CIRCLE] = {3, 2, {"circle x", "circle y", "circle r"}},
    [ETHD_CAPSULE] = {5, 4, {"capsule x1", "capsule y1", "capsule x2", "capsule y2", "capsule r"}},
    [ETHD_BOX] = {5, 2, {"box x", "box y", "box half_w", "box half_h", "box angle"}},
    [ETHD_POLYGON] = {6, 6, {"polygon x", "polygon y"}},
    [ETHD_SEGMENT] = {4, 4, {"segment x", "segment y"}},
    [ETHD_POLYLINE] = {4, 4, {"polyline x", "polyline y"}},
};

static ethd_status refuse_object(const ethd_object_def *def, ethd_status status, const char *name, double found,
                                 double min, double max, ethd_error *error) {
  ethd__refuse(error, status, name, found, min, max);
  if (error) error->line = def->line;
  return status;
}

static size_t append(char name[64], size_t at, const char *word) {
  while (*word && at < 63) name[at++] = *word++;
  name[at] = 0;
  return at;
}

static size_t append_number(char name[64], size_t at, size_t value) {
  char digits[24];
  size_t n = sizeof digits - 1;
  digits[n] = 0;
  do digits[--n] = (char)('0' + value % 10);
  while (value /= 10);
  return append(name, at, digits + n);
}

ethd_status ethd__check_count(ethd_shape shape, size_t count, ethd_status status, ethd_error *error) {
  size_t least = forms[shape].count;
  bool open = shape == ETHD_POLYGON || shape == ETHD_POLYLINE, pairs = !open || count % 2 == 0;
  if (count >= least && (open || count == least) && pairs) return ETHD_OK;
  char name[64];
  size_t n = append(name, 0, pairs ? "numbers after " : "an even count of numbers after ");
  append(name, n, ethd_shape_name(shape));
  return ethd__refuse(error, status, name, (double)count, (double)least, open ? INFINITY : (double)least);
}

static bool is_size(ethd_shape shape, size_t k) { return k >= forms[shape].sizes && !(shape == ETHD_BOX && k == 4); }

static ethd_status check_numbers(const ethd_object_def *def, ethd_error *error) {
  const form *f = &forms[def->shape];
  bool chain = ethd__is_chain(def->shape);
  for (size_t k = 0; k < def->count; k++) {
    double v = def->numbers[k], max = ETHD__COORDINATE_MAX;
    bool size = !chain && is_size(def->shape, k);
    if (fabs(v) <= max && (!size || v > 0)) continue;
    ethd_status status = isfinite(v) ? ETHD_E_RANGE : ETHD_E_NOT_FINITE;
    return refuse_object(def, status, f->names[chain ? k % 2 : k], v, size ? 0 : -max, max, error);
  }
  return ETHD_OK;
}

static ethd_status check_halfplane(const ethd_object_def *def, ethd_error *error) {
  ethd_vec n = {def->numbers[0], def->numbers[1]};
  double length = ethd_vec_norm(n);
  if (fabs(length - 1) <= 1e-6) return ETHD_OK;
  return refuse_object(def, ETHD_E_RANGE, "halfplane |n|", length, 1 - 1e-6, 1 + 1e-6, error);
}

/* Not told apart by rounding, or too near for their distance's square. */
static bool are_equal(ethd_vec a, ethd_vec b) {
  ethd_vec e = ethd_vec_sub(b, a);
  double largest = fmax(fmax(fabs(a.x), fabs(a.y)), fmax(fabs(b.x), fabs(b.y)));
  double length = ethd_vec_norm(e);
  return !(length > ETHD__TINY && length > 4 * DBL_EPSILON * largest);
}

static ethd_vec point(const double *numbers, size_t k) {
  ethd_vec p = {numbers[2 * k], numbers[2 * k + 1]};
  return p;
}

static ethd_status refuse_pair(const ethd_object_def *def, const char *what, size_t i, size_t j, const char *end,
                               ethd_error *error) {
  char name[64];
  size_t n = append(name, 0, ethd_shape_name(def->shape));
  n = append(name, n, what);
  n = append_number(name, n, i);
  n = append(name, n, " and ");
  n = append_number(name, n, j);
  append(name, n, end);
  return refuse_object(def, ETHD_E_GEOMETRY, name, NAN, NAN, NAN, error);
}

static ethd_status check_simple(const ethd_object_def *def, void *room, ethd_error *error) {
  size_t n = def->count / 2, meet[2] = {0, 0};
  if (ethd__is_simple(def->numbers, n, room, meet)) return ETHD_OK;
  return refuse_pair(def, ": edges ", meet[0], meet[1], " meet", error);
}

static ethd_status check_chain(const ethd_object_def *def, void *room, ethd_error *error) {
  size_t n = def->count / 2;
  if (n > POINTS_MAX) return refuse_object(def, ETHD_E_FULL, "points", (double)n, 0, POINTS_MAX, error);
  for (size_t k = 0; k < n; k++) {
    size_t next = k + 1 < n ? k + 1 : 0;
    if (!next && def->shape != ETHD_POLYGON) break;
    if (are_equal(point(def->numbers, k), point(def->numbers, next)))
      return refuse_pair(def, ": points ", k, next, " are equal", error);
  }
  return def->shape == ETHD_POLYGON ? check_simple(def, room, error) : ETHD_OK;
}

static ethd_status check_object(const ethd_scene_def *def, const ethd_object_def *o, void *room, ethd_error *error) {
  if ((int)o->shape < 0 || o->shape >= ETHD_SHAPE_COUNT)
    return refuse_object(o, ETHD_E_UNKNOWN, "shape", (double)o->shape, 0, ETHD_SHAPE_COUNT - 1, error);
  if (!o->numbers) return refuse_object(o, ETHD_E_ARGUMENT, "numbers", NAN, NAN, NAN, error);
  if (o->material < -1 || o->material >= (int32_t)def->material_count)
    return refuse_object(o, ETHD_E_RANGE, "material", o->material, -1, (double)def->material_count - 1, error);
  ethd_status status = ethd__check_count(o->shape, o->count, ETHD_E_ARGUMENT, error);
  if (status) {
    if (error) error->line = o->line;
    return status;
  }
  status = check_numbers(o, error);
  if (status) return status;
  if (o->shape == ETHD_HALFPLANE) return check_halfplane(o, error);
  return ethd__is_chain(o->shape) ? check_chain(o, room, error) : ETHD_OK;
}

static ethd_status refuse_material(const ethd_material *m, ethd_status status, const char *name, double found,
                                   double max, ethd_error *error) {
  ethd__refuse(error, status, name, found, isnan(max) ? NAN : 0, max);
  if (error) error->line = m->line;
  return status;
}

static bool is_name(const char name[ETHD_NAME_MAX]) { return name[0] && memchr(name, 0, ETHD_NAME_MAX); }

static ethd_status check_material(const ethd_scene_def *def, size_t i, ethd_error *error) {
  const ethd_material *m = &def->materials[i];
  if (!is_name(m->name)) return refuse_material(m, ETHD_E_ARGUMENT, "material", NAN, NAN, error);
  for (size_t k = 0; k < i; k++)
    if (ethd__same(m->name, def->materials[k].name))
      return refuse_material(m, ETHD_E_DUPLICATE, m->name, NAN, NAN, error);
  if (m->count > ETHD_PARAMS_MAX) return refuse_material(m, ETHD_E_FULL, m->name, m->count, ETHD_PARAMS_MAX, error);
  for (uint32_t k = 0; k < m->count; k++) {
    const char *name = m->values[k].name;
    if (!is_name(name)) return refuse_material(m, ETHD_E_ARGUMENT, m->name, NAN, NAN, error);
    if (!isfinite(m->values[k].value))
      return refuse_material(m, ETHD_E_NOT_FINITE, name, m->values[k].value, NAN, error);
    for (uint32_t l = 0; l < k; l++)
      if (ethd__same(name, m->values[l].name)) return refuse_material(m, ETHD_E_DUPLICATE, name, NAN, NAN, error);
  }
  return ETHD_OK;
}

size_t ethd__check_room(const ethd_scene_def *def) {
  size_t most = 0;
  for (size_t i = 0; i < def->object_count && def->objects; i++) {
    const ethd_object_def *o = &def->objects[i];
    if (o->shape == ETHD_POLYGON && o->count / 2 > most && o->count / 2 <= POINTS_MAX) most = o->count / 2;
  }
  return ethd__simple_room(most) + 1;
}

ethd_status ethd__check_scene(const ethd_scene_def *def, void *room, ethd_error *error) {
  if ((def->object_count && !def->objects) || (def->material_count && !def->materials))
    return ethd__refuse(error, ETHD_E_ARGUMENT, "scene", NAN, NAN, NAN);
  if (def->material_count > ETHD_MATERIALS_MAX)
    return refuse_material(&def->materials[ETHD_MATERIALS_MAX], ETHD_E_FULL, "materials", (double)def->material_count,
                           ETHD_MATERIALS_MAX, error);
  if (def->object_count > INT32_MAX)
    return ethd__refuse(error, ETHD_E_FULL, "objects", (double)def->object_count, 0, INT32_MAX);
  ethd_status status = ETHD_OK;
  for (size_t i = 0; i < def->material_count && !status; i++) status = check_material(def, i, error);
  for (size_t i = 0; i < def->object_count && !status; i++) status = check_object(def, &def->objects[i], room, error);
  return status;
}
