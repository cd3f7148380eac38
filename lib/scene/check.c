#include "scene/check.h"

#include <float.h>

#include "scene/shapes.h"

#define POINTS_MAX (INT32_MAX / 2 - 1) /* a vertex is feature 2 k + 1, which must fit into an int32_t */

static ethd_status refuse_object(const ethd_object_def *def, ethd_status status, const char *name, ethd__found found,
                                 ethd_error *error) {
  ethd__refuse(error, status, name, found);
  if (error) error->line = def->line;
  return status;
}

static size_t append_number(char name[64], size_t at, size_t value) {
  char digits[24];
  size_t n = sizeof digits - 1;
  digits[n] = 0;
  do digits[--n] = (char)('0' + value % 10);
  while (value /= 10);
  return ethd__append(name, at, digits + n);
}

/* Returns true if two points differ only by rounding, or the square of their distance would underflow. */
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

/* "polygon: edges 0 and 2 meet" */
static ethd_status refuse_pair(const ethd_object_def *def, const char *what, const size_t pair[2], const char *fault,
                               ethd_error *error) {
  char name[64];
  size_t n = ethd__append(name, 0, ethd_shape_name(def->shape));
  n = ethd__append(name, n, what);
  n = append_number(name, n, pair[0]);
  n = ethd__append(name, n, " and ");
  n = append_number(name, n, pair[1]);
  ethd__append(name, n, fault);
  return refuse_object(def, ETHD_E_GEOMETRY, name, ethd__unsaid, error);
}

static ethd_status check_simple(const ethd_object_def *def, void *room, ethd_error *error) {
  size_t n = def->count / 2, meet[2] = {0, 0};
  if (ethd__is_simple(def->numbers, n, room, meet)) return ETHD_OK;
  return refuse_pair(def, ": edges ", meet, " meet", error);
}

static ethd_status check_chain(const ethd_object_def *def, void *room, ethd_error *error) {
  size_t n = def->count / 2;
  /* unreachable: in a test, since it needs 17 GB of numbers */
  if (n > POINTS_MAX) return refuse_object(def, ETHD_E_FULL, "points", (ethd__found){(double)n, 0, POINTS_MAX}, error);
  for (size_t k = 0; k < n; k++) {
    size_t next = k + 1 < n ? k + 1 : 0, pair[2] = {k, next};
    if (!next && !ethd__shapes[def->shape].is_closed) break;
    if (are_equal(point(def->numbers, k), point(def->numbers, next)))
      return refuse_pair(def, ": points ", pair, " are equal", error);
  }
  return ethd__shapes[def->shape].is_closed ? check_simple(def, room, error) : ETHD_OK;
}

static ethd_status check_object(const ethd_scene_def *def, const ethd_object_def *o, void *room, ethd_error *error) {
  if ((unsigned)o->shape >= ETHD_SHAPE_COUNT)
    return refuse_object(o, ETHD_E_UNKNOWN, "shape", (ethd__found){(double)o->shape, 0, ETHD_SHAPE_COUNT - 1}, error);
  if (!o->numbers) return refuse_object(o, ETHD_E_ARGUMENT, "numbers", ethd__unsaid, error);
  if (o->material < -1 || o->material >= (int32_t)def->material_count)
    return refuse_object(o, ETHD_E_RANGE, "material", (ethd__found){o->material, -1, (double)def->material_count - 1},
                         error);
  const ethd__shape *shape = &ethd__shapes[o->shape];
  ethd_status status = ethd__check_count(&shape->form, o->count, ETHD_E_ARGUMENT, error);
  if (!status) status = ethd__check_numbers(&shape->form, o->numbers, o->count, error);
  if (!status && shape->check) status = shape->check(o, error);
  if (!status && shape->is_chain) status = check_chain(o, room, error);
  if (status && error) error->line = o->line;
  return status;
}

size_t ethd__check_room(const ethd_scene_def *def) {
  size_t most = 0;
  for (size_t i = 0; i < def->object_count && def->objects; i++) {
    const ethd_object_def *o = &def->objects[i];
    bool closed = (unsigned)o->shape < ETHD_SHAPE_COUNT && ethd__shapes[o->shape].is_closed;
    if (closed && o->count / 2 > most && o->count / 2 <= POINTS_MAX) most = o->count / 2;
  }
  return ethd__simple_room(most) + 1;
}

ethd_status ethd__check_scene(const ethd_scene_def *def, void *room, ethd_error *error) {
  if ((def->object_count && !def->objects) || (def->material_count && !def->materials))
    return ethd__error(error, ETHD_E_ARGUMENT, "scene");
  if (def->object_count > INT32_MAX) /* unreachable: in a test, since it needs 80 GB of objects */
    return ethd__refuse(error, ETHD_E_FULL, "objects", (ethd__found){(double)def->object_count, 0, INT32_MAX});
  ethd_status status = ethd__check_materials(def->materials, def->material_count, error);
  for (size_t i = 0; i < def->object_count && !status; i++) status = check_object(def, &def->objects[i], room, error);
  return status;
}
