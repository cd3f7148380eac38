/* The rows of all shapes, and their closed forms. No function here needs the system, so both [main] and [rt] may use
   them. */
#include "scene/shapes.h"

#include <float.h>
#include <string.h>

#include "error.h"
#include "ethd/maths.h"

static ethd_vec vec(double x, double y) {
  ethd_vec r = {x, y};
  return r;
}

static void set(ethd_touch *out, double distance, ethd_vec point, ethd_vec n) {
  out->distance = distance;
  out->point = point;
  out->n = n;
}

/* ---- half-plane {nx, ny, c} ---- */

static ethd_status check_normal(const ethd_object_def *def, ethd_error *error) {
  double length = ethd_vec_norm(vec(def->numbers[0], def->numbers[1]));
  if (fabs(length - 1) <= 1e-6) return ETHD_OK;
  return ethd__refuse(error, ETHD_E_RANGE, "halfplane |n|", (ethd__found){length, 1 - 1e-6, 1 + 1e-6});
}

static void keep_unit(double *p) {
  double length = sqrt(p[0] * p[0] + p[1] * p[1]);
  if (fabs(length - 1) <= 4 * DBL_EPSILON) return; /* an already normalised normal stays as it is */
  for (int i = 0; i < 3; i++) p[i] /= length;
}

static void halfplane(const double *p, ethd_vec x, ethd_touch *out) ETHD_RT {
  ethd_vec n = vec(p[0], p[1]);
  double d = p[2] - ethd_vec_dot(n, x);
  set(out, d, ethd_vec_add(x, ethd_vec_scale(d, n)), n);
}

/* ---- circle {x, y, r} and capsule {x1, y1, x2, y2, r} ---- */

/* Finds the nearest point of the disc about c. At its centre, where n is undefined, n is `any`. */
static void disc(ethd_vec c, double r, ethd_vec any, ethd_vec x, ethd_touch *out) {
  ethd_vec gap = ethd_vec_sub(c, x);
  double distance = ethd_vec_norm(gap);
  ethd_vec n = distance > ETHD__TINY ? ethd_vec_scale(1 / distance, gap) : any;
  set(out, distance - r, ethd_vec_sub(c, ethd_vec_scale(r, n)), n);
}

static void circle(const double *p, ethd_vec x, ethd_touch *out) ETHD_RT {
  disc(vec(p[0], p[1]), p[2], vec(1, 0), x, out);
}

static void capsule(const double *p, ethd_vec x, ethd_touch *out) ETHD_RT {
  ethd_vec a = vec(p[0], p[1]), b = vec(p[2], p[3]), e = ethd_vec_sub(b, a), u = ethd_vec_sub(x, a);
  double ee = ethd_vec_dot(e, e), along = ethd_vec_dot(e, u), length = sqrt(ee);
  bool round = !(length > ETHD__TINY);
  ethd_vec left = round ? vec(1, 0) : vec(-e.y / length, e.x / length);
  if (round || along <= 0 || along >= ee) {
    disc(along <= 0 ? a : b, p[4], left, x, out);
    return;
  }
  double across = ethd_vec_cross(e, u) / length;
  ethd_vec n = ethd_vec_scale(across >= 0 ? -1 : 1, left);
  ethd_vec core = ethd_vec_add(a, ethd_vec_scale(along / ee, e));
  set(out, fabs(across) - p[4], ethd_vec_sub(core, ethd_vec_scale(p[4], n)), n);
}

static ethd__disc circle_disc(const double *p, size_t k) {
  (void)k;
  return (ethd__disc){vec(p[0], p[1]), p[2]};
}

static ethd__disc capsule_disc(const double *p, size_t k) { return (ethd__disc){vec(p[2 * k], p[2 * k + 1]), p[4]}; }

/* ---- box {x, y, half_w, half_h, angle, cos, sin} ---- */

static void keep_turn(double *p) { ethd_sincos(p[4], &p[6], &p[5]); }

/* The corners, as discs of radius 0. */
static ethd__disc box_disc(const double *p, size_t k) {
  double u = k & 1 ? p[2] : -p[2], v = k & 2 ? p[3] : -p[3];
  return (ethd__disc){vec(p[0] + (p[5] * u - p[6] * v), p[1] + (p[6] * u + p[5] * v)), 0};
}

/* Works in the box's frame, folded into its first quadrant: x is (u, v) from the centre, (du, dv) beyond the faces. */
static void box(const double *p, ethd_vec x, ethd_touch *out) ETHD_RT {
  double c = p[5], s = p[6];
  ethd_vec r = ethd_vec_sub(x, vec(p[0], p[1]));
  double u = c * r.x + s * r.y, v = c * r.y - s * r.x;
  double su = copysign(1, u), sv = copysign(1, v), du = fabs(u) - p[2], dv = fabs(v) - p[3];
  double d, nu, nv, pu = fabs(u), pv = fabs(v);
  if (du > 0 && dv > 0) {
    d = sqrt(du * du + dv * dv);
    nu = d > ETHD__TINY ? -du / d : -1;
    nv = d > ETHD__TINY ? -dv / d : 0;
    pu = p[2], pv = p[3];
  } else {
    bool across = du > dv;
    d = across ? du : dv;
    nu = across ? -1 : 0;
    nv = across ? 0 : -1;
    if (across)
      pu = p[2];
    else
      pv = p[3];
  }
  nu *= su, nv *= sv, pu *= su, pv *= sv;
  ethd_vec point = vec(p[0] + (c * pu - s * pv), p[1] + (s * pu + c * pv));
  set(out, d, point, vec(c * nu - s * nv, s * nu + c * nv));
}

/* ---- the table ---- */

/* clang-format off */
#define POINTS .cycle = 2, .numbers = {{"x", ETHD__COORDINATE}, {"y", ETHD__COORDINATE}}
#define LIST .step = 2, .most = SIZE_MAX

const ethd__shape ethd__shapes[ETHD_SHAPE_COUNT] = {
    [ETHD_SHAPE_HALFPLANE] = {
        .form = {.name = "halfplane", .text = "NX NY C", .count = 3,
                 .numbers = {{"nx", ETHD__DIRECTION}, {"ny", ETHD__DIRECTION}, {"c", ETHD__COORDINATE}}},
        .check = check_normal, .keep = keep_unit, .nearest = halfplane},
    [ETHD_SHAPE_CIRCLE] = {
        .form = {.name = "circle", .text = "X Y R", .count = 3,
                 .numbers = {{"x", ETHD__COORDINATE}, {"y", ETHD__COORDINATE}, {"r", ETHD__LENGTH}}},
        .discs = 1, .disc = circle_disc, .nearest = circle},
    [ETHD_SHAPE_CAPSULE] = {
        .form = {.name = "capsule", .text = "X1 Y1 X2 Y2 R", .count = 5,
                 .numbers = {{"x1", ETHD__COORDINATE}, {"y1", ETHD__COORDINATE}, {"x2", ETHD__COORDINATE},
                             {"y2", ETHD__COORDINATE}, {"r", ETHD__LENGTH}}},
        .discs = 2, .disc = capsule_disc, .nearest = capsule},
    [ETHD_SHAPE_BOX] = {
        .form = {.name = "box", .text = "X Y HALF_W HALF_H ANGLE", .count = 5,
                 .numbers = {{"x", ETHD__COORDINATE}, {"y", ETHD__COORDINATE}, {"half_w", ETHD__LENGTH},
                             {"half_h", ETHD__LENGTH}, {"angle", ETHD__DIRECTION}}},
        .keep = keep_turn, .added = 2, .discs = 4, .disc = box_disc, .nearest = box},
    [ETHD_SHAPE_POLYGON] = {
        .form = {.name = "polygon", .text = "X1 Y1 X2 Y2 X3 Y3 ...", .count = 6, POINTS, LIST},
        .is_chain = true, .is_closed = true},
    [ETHD_SHAPE_SEGMENT] = {
        .form = {.name = "segment", .text = "X1 Y1 X2 Y2", .count = 4, POINTS},
        .is_chain = true},
    [ETHD_SHAPE_POLYLINE] = {
        .form = {.name = "polyline", .text = "X1 Y1 X2 Y2 ...", .count = 4, POINTS, LIST},
        .is_chain = true},
};
/* clang-format on */

static const ethd__form *form(size_t shape) { return &ethd__shapes[shape].form; }

const ethd__world ethd__plane = {"the plane", ETHD_SHAPE_COUNT, form};

static bool is_shape(ethd_shape shape) { return (unsigned)shape < ETHD_SHAPE_COUNT; }

const char *ethd_shape_name(ethd_shape shape) { return is_shape(shape) ? ethd__shapes[shape].form.name : ""; }

const char *ethd_shape_form(ethd_shape shape) { return is_shape(shape) ? ethd__shapes[shape].form.text : ""; }

void ethd__keep(const ethd_object_def *o, double *kept) {
  const ethd__shape *s = &ethd__shapes[o->shape];
  memcpy(kept, o->numbers, o->count * sizeof *kept);
  if (s->is_closed) memcpy(kept + o->count, o->numbers, 2 * sizeof *kept);
  if (s->keep) s->keep(kept);
}

static void nearest_of_chain(const ethd_scene *scene, const ethd__object *o, ethd_vec x, ethd_touch *out) {
  ethd__chain chain = ethd__chain_of(scene, o);
  ethd__chain_nearest(&chain, x, out);
  ethd__label(o, out);
}

void ethd__object_nearest(const ethd_scene *scene, const ethd__object *o, ethd_vec x, ethd_touch *out) {
  if (o->edges) {
    nearest_of_chain(scene, o, x, out);
    return;
  }
  out->feature = out->side = 0;
  out->object = o->id;
  out->material = o->material;
  ethd__shapes[o->shape].nearest(ethd__numbers(scene, o), x, out);
}
