#include "scene/scene.h"

static ethd_vec vec(double x, double y) {
  ethd_vec r = {x, y};
  return r;
}

static void set(ethd_touch *out, double distance, ethd_vec point, ethd_vec n) {
  out->distance = distance;
  out->point = point;
  out->n = n;
}

static void halfplane(const double *p, ethd_vec x, ethd_touch *out) {
  ethd_vec n = vec(p[0], p[1]);
  double d = p[2] - ethd_vec_dot(n, x);
  set(out, d, ethd_vec_add(x, ethd_vec_scale(d, n)), n);
}

/* A disc about c; `any` is n at its centre. */
static void disc(ethd_vec c, double r, ethd_vec any, ethd_vec x, ethd_touch *out) {
  ethd_vec gap = ethd_vec_sub(c, x);
  double distance = ethd_vec_norm(gap);
  ethd_vec n = distance > ETHD__TINY ? ethd_vec_scale(1 / distance, gap) : any;
  set(out, distance - r, ethd_vec_sub(c, ethd_vec_scale(r, n)), n);
}

static void circle(const double *p, ethd_vec x, ethd_touch *out) { disc(vec(p[0], p[1]), p[2], vec(1, 0), x, out); }

static void capsule(const double *p, ethd_vec x, ethd_touch *out) {
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

/* In the box's frame, folded into its first quadrant: (u, v) from the centre, (du, dv) beyond the faces. */
static void box(const double *p, ethd_vec x, ethd_touch *out) {
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

static void chain(const ethd_scene *scene, const ethd__object *o, ethd_vec x, ethd_touch *out) {
  ethd__chain c = ethd__chain_of(scene, o);
  ethd__chain_nearest(&c, x, out);
}

void ethd__object_nearest(const ethd_scene *scene, const ethd__object *o, ethd_vec x, ethd_touch *out) {
  const double *p = ethd__numbers(scene, o);
  out->feature = out->side = 0;
  switch ((ethd_shape)o->shape) {
  case ETHD_HALFPLANE: halfplane(p, x, out); break;
  case ETHD_CIRCLE: circle(p, x, out); break;
  case ETHD_CAPSULE: capsule(p, x, out); break;
  case ETHD_BOX: box(p, x, out); break;
  case ETHD_POLYGON:
  case ETHD_SEGMENT:
  case ETHD_POLYLINE:
  case ETHD_SHAPE_COUNT: chain(scene, o, x, out); break;
  }
  ethd__label(o, out);
}
