/* The rows of all solids, and their closed forms. No function here needs the system, so both [main] and [rt] may use
   them. */
#include <float.h>

#include "solids/solids.h"

#define TINY 1e-140 /* m: squares of smaller lengths lose digits */

static ethd_vec3 vec(double x, double y, double z) {
  ethd_vec3 r = {x, y, z};
  return r;
}

static void copy(const double *given, size_t count, double *kept) {
  for (size_t k = 0; k < count; k++) kept[k] = given[k];
}

/* ---- half-space {nx, ny, nz, c} ---- */

static ethd_status check_normal(const double *p, ethd_error *error) {
  double length = ethd_vec3_norm(ethd_vec3_of(p));
  if (fabs(length - 1) <= 1e-6) return ETHD_OK;
  return ethd__refuse(error, ETHD_E_RANGE, "halfspace |n|", (ethd__found){length, 1 - 1e-6, 1 + 1e-6});
}

static void keep_unit(const double *given, size_t count, double *kept) {
  double length = ethd_vec3_norm(ethd_vec3_of(given));
  copy(given, count, kept);
  if (fabs(length - 1) <= 4 * DBL_EPSILON) return; /* as in the plane: an already normalised normal stays */
  for (size_t k = 0; k < count; k++) kept[k] /= length;
}

static void halfspace(const double *p, ethd_vec3 x, ethd__foot *out) ETHD_RT {
  ethd_vec3 n = ethd_vec3_of(p);
  double d = p[3] - ethd_vec3_dot(n, x);
  *out = (ethd__foot){d, ethd_vec3_add(x, ethd_vec3_scale(d, n)), n};
}

/* ---- sphere {x, y, z, r} ---- */

/* Finds the nearest point of the ball about c. At its centre, where n is undefined, n is `any`. */
static void ball(ethd_vec3 c, double r, ethd_vec3 any, ethd_vec3 x, ethd__foot *out) {
  ethd_vec3 gap = ethd_vec3_sub(c, x);
  double distance = ethd_vec3_norm(gap);
  ethd_vec3 n = distance > TINY ? ethd_vec3_scale(1 / distance, gap) : any;
  *out = (ethd__foot){distance - r, ethd_vec3_sub(c, ethd_vec3_scale(r, n)), n};
}

static void sphere(const double *p, ethd_vec3 x, ethd__foot *out) ETHD_RT {
  ball(ethd_vec3_of(p), p[3], vec(1, 0, 0), x, out);
}

static ethd__bounds sphere_bounds(const double *p) { return (ethd__bounds){ethd_vec3_of(p), vec(p[3], p[3], p[3])}; }

/* ---- capsule {x1, y1, z1, x2, y2, z2, r, unit vector from the first end to the second, their distance} ---- */

static void keep_axis(const double *given, size_t count, double *kept) {
  ethd_vec3 e = ethd_vec3_sub(ethd_vec3_of(given + 3), ethd_vec3_of(given));
  double length = ethd_vec3_norm(e);
  bool is_ball = !(length > TINY);
  copy(given, count, kept);
  ethd_vec3_put(is_ball ? vec(1, 0, 0) : ethd_vec3_scale(1 / length, e), kept + 7);
  kept[10] = is_ball ? 0 : length;
}

/* Returns a unit vector at right angles to u: the cross product with the axis that u is farthest from. */
static ethd_vec3 across(ethd_vec3 u) {
  ethd_vec3 a = vec(fabs(u.x), fabs(u.y), fabs(u.z));
  ethd_vec3 axis = a.x <= a.y && a.x <= a.z ? vec(1, 0, 0) : a.y <= a.z ? vec(0, 1, 0) : vec(0, 0, 1);
  ethd_vec3 w = ethd_vec3_cross(u, axis);
  return ethd_vec3_scale(1 / ethd_vec3_norm(w), w);
}

/* The distance from the axis is the length of a cross product, which is accurate near the axis. */
static void capsule(const double *p, ethd_vec3 x, ethd__foot *out) ETHD_RT {
  ethd_vec3 a = ethd_vec3_of(p), u = ethd_vec3_of(p + 7), r = ethd_vec3_sub(x, a), w = ethd_vec3_cross(u, r);
  double along = ethd_vec3_dot(u, r), off = ethd_vec3_norm(w);
  if (along <= 0 || along >= p[10] || !(off > TINY)) {
    ethd_vec3 centre = along <= 0       ? a
                       : along >= p[10] ? ethd_vec3_of(p + 3)
                                        : ethd_vec3_add(a, ethd_vec3_scale(along, u));
    ball(centre, p[6], across(u), x, out);
    return;
  }
  ethd_vec3 n = ethd_vec3_cross(u, w);
  n = ethd_vec3_scale(1 / ethd_vec3_norm(n), n);
  ethd_vec3 core = ethd_vec3_add(a, ethd_vec3_scale(along, u));
  *out = (ethd__foot){off - p[6], ethd_vec3_sub(core, ethd_vec3_scale(p[6], n)), n};
}

static ethd__bounds capsule_bounds(const double *p) {
  ethd_vec3 a = ethd_vec3_of(p), b = ethd_vec3_of(p + 3), e = ethd_vec3_scale(0.5, ethd_vec3_sub(b, a));
  return (ethd__bounds){ethd_vec3_add(a, e), vec(fabs(e.x) + p[6], fabs(e.y) + p[6], fabs(e.z) + p[6])};
}

/* ---- box {x, y, z, half_x, half_y, half_z, its three axes in the frame} ---- */

/* Rodrigues' formula: a matrix of the rotation by |r| about r, whose columns are the axes. */
static void keep_turn(const double *given, size_t count, double *kept) {
  ethd_vec3 r = count > 6 ? ethd_vec3_of(given + 6) : vec(0, 0, 0);
  double angle = ethd_vec3_norm(r), s, c, *axes = kept + 6;
  copy(given, 6, kept);
  ethd_sincos(angle, &s, &c);
  ethd_vec3 a = angle > TINY ? ethd_vec3_scale(1 / angle, r) : r, t = ethd_vec3_scale(1 - c, a);
  ethd_vec3_put(vec(c + t.x * a.x, t.x * a.y + s * a.z, t.x * a.z - s * a.y), axes);
  ethd_vec3_put(vec(t.x * a.y - s * a.z, c + t.y * a.y, t.y * a.z + s * a.x), axes + 3);
  ethd_vec3_put(vec(t.x * a.z + s * a.y, t.y * a.z - s * a.x, c + t.z * a.z), axes + 6);
}

/* Returns the vector of the frame that has these coordinates along the box's axes. */
static ethd_vec3 of_box(const double *axes, const double v[3]) {
  return vec(axes[0] * v[0] + axes[3] * v[1] + axes[6] * v[2], axes[1] * v[0] + axes[4] * v[1] + axes[7] * v[2],
             axes[2] * v[0] + axes[5] * v[1] + axes[8] * v[2]);
}

/* Works in the box's frame, folded into its first octant: x is at[k] along axis k, beyond[k] past the face. */
static void box(const double *p, ethd_vec3 x, ethd__foot *out) ETHD_RT {
  const double *half = p + 3, *axes = p + 6;
  ethd_vec3 r = ethd_vec3_sub(x, ethd_vec3_of(p));
  double sign[3], at[3], beyond[3], n[3] = {0, 0, 0}, d = 0;
  int outside = 0, face = 0;
  for (int k = 0; k < 3; k++) {
    double v = ethd_vec3_dot(ethd_vec3_of(axes + 3 * k), r);
    sign[k] = copysign(1, v);
    at[k] = fabs(v);
    beyond[k] = at[k] - half[k];
    if (beyond[k] >= beyond[face]) face = k;
    if (!(beyond[k] > 0)) continue;
    outside++;
    d += beyond[k] * beyond[k];
    at[k] = half[k];
  }
  d = sqrt(d);
  if (outside < 2 || !(d > TINY)) { /* nearest to a face */
    d = beyond[face];
    at[face] = half[face];
    n[face] = -sign[face];
  } else {
    for (int k = 0; k < 3; k++)
      if (beyond[k] > 0) n[k] = -sign[k] * beyond[k] / d;
  }
  for (int k = 0; k < 3; k++) at[k] *= sign[k];
  *out = (ethd__foot){d, ethd_vec3_add(ethd_vec3_of(p), of_box(axes, at)), of_box(axes, n)};
}

static ethd__bounds box_bounds(const double *p) {
  const double *axes = p + 6;
  double half[3];
  for (int k = 0; k < 3; k++) half[k] = fabs(axes[k]) * p[3] + fabs(axes[3 + k]) * p[4] + fabs(axes[6 + k]) * p[5];
  return (ethd__bounds){ethd_vec3_of(p), ethd_vec3_of(half)};
}

/* ---- the table ---- */

/* clang-format off */
#define XYZ {"x", ETHD__COORDINATE}, {"y", ETHD__COORDINATE}, {"z", ETHD__COORDINATE}

const ethd__solid_shape ethd__solid_shapes[ETHD__SOLID_SHAPES] = {
    {.form = {.name = "halfspace", .text = "NX NY NZ C", .count = 4,
              .numbers = {{"nx", ETHD__DIRECTION}, {"ny", ETHD__DIRECTION}, {"nz", ETHD__DIRECTION},
                          {"c", ETHD__COORDINATE}}},
     .kept = 4, .check = check_normal, .keep = keep_unit, .nearest = halfspace},
    {.form = {.name = "sphere", .text = "X Y Z R", .count = 4, .numbers = {XYZ, {"r", ETHD__LENGTH}}},
     .kept = 4, .keep = copy, .bounds = sphere_bounds, .nearest = sphere},
    {.form = {.name = "capsule", .text = "X1 Y1 Z1 X2 Y2 Z2 R", .count = 7,
              .numbers = {{"x1", ETHD__COORDINATE}, {"y1", ETHD__COORDINATE}, {"z1", ETHD__COORDINATE},
                          {"x2", ETHD__COORDINATE}, {"y2", ETHD__COORDINATE}, {"z2", ETHD__COORDINATE},
                          {"r", ETHD__LENGTH}}},
     .kept = 11, .keep = keep_axis, .bounds = capsule_bounds, .nearest = capsule},
    {.form = {.name = "box", .text = "X Y Z HALF_X HALF_Y HALF_Z [RX RY RZ]", .count = 6, .step = 3, .most = 9,
              .numbers = {XYZ, {"half_x", ETHD__LENGTH}, {"half_y", ETHD__LENGTH}, {"half_z", ETHD__LENGTH},
                          {"rx", ETHD__DIRECTION}, {"ry", ETHD__DIRECTION}, {"rz", ETHD__DIRECTION}}},
     .kept = 15, .keep = keep_turn, .bounds = box_bounds, .nearest = box},
};
/* clang-format on */

static const ethd__form *form(size_t shape) { return &ethd__solid_shapes[shape].form; }

const ethd__world ethd__space = {"space", ETHD__SOLID_SHAPES, form};
