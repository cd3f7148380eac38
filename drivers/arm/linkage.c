#include "arm/linkage.h"

static ethd_vec3 sum_of(double a, ethd_vec3 u, double b, ethd_vec3 v) {
  return ethd_vec3_add(ethd_vec3_scale(a, u), ethd_vec3_scale(b, v));
}

/* Rotate a frame about its own z or x. */
static void turn_z(ethd__axes *f, double sine, double cosine) {
  const ethd_vec3 x = f->x;
  f->x = sum_of(cosine, x, sine, f->y);
  f->y = sum_of(cosine, f->y, -sine, x);
}

static void turn_x(ethd__axes *f, double sine, double cosine) {
  const ethd_vec3 y = f->y;
  f->y = sum_of(cosine, y, sine, f->z);
  f->z = sum_of(cosine, f->z, -sine, y);
}

static void move(ethd__axes *f, double x, double z) { f->at = ethd_vec3_add(f->at, sum_of(x, f->x, z, f->z)); }

/* Returns a vector of the frame in R_0. */
static ethd_vec3 seen(const ethd__axes *f, ethd_vec3 v) {
  return ethd_vec3_add(sum_of(v.x, f->x, v.y, f->y), ethd_vec3_scale(v.z, f->z));
}

ethd__axes ethd__axes_at(const double place[3], const double turned[3]) {
  double s[3], c[3];
  for (int i = 0; i < 3; i++) ethd_sincos(turned[i], &s[i], &c[i]);
  /* Rz(yaw) Ry(pitch) Rx(roll) */
  return (ethd__axes){
      .x = {c[2] * c[1], s[2] * c[1], -s[1]},
      .y = {c[2] * s[1] * s[0] - s[2] * c[0], s[2] * s[1] * s[0] + c[2] * c[0], c[1] * s[0]},
      .z = {c[2] * s[1] * c[0] + s[2] * s[0], s[2] * s[1] * c[0] - c[2] * s[0], c[1] * c[0]},
      .at = ethd_vec3_of(place),
  };
}

void ethd__linkage_make(ethd__dh convention, const ethd__dh_row *rows, uint32_t count, const ethd__axes *base,
                        ethd_vec3 tool, ethd_vec3 facing, ethd__linkage *out) {
  const uint32_t later = convention == ETHD__DH_MODIFIED;
  *out = (ethd__linkage){.count = count, .base = *base, .tool = tool, .facing = facing};
  if (later) {
    double sine, cosine;
    ethd_sincos(rows[0].alpha, &sine, &cosine);
    move(&out->base, rows[0].a, 0);
    turn_x(&out->base, sine, cosine);
  }
  for (uint32_t i = 0; i < count; i++) {
    out->link[i].d = rows[i].d;
    out->link[i].offset = rows[i].offset;
    out->link[i].cosine = 1;
    if (i + later >= count) continue;
    out->link[i].a = rows[i + later].a;
    ethd_sincos(rows[i + later].alpha, &out->link[i].sine, &out->link[i].cosine);
  }
}

void ethd__linkage_place(const ethd__linkage *linkage, const double *q, ethd__tool *out) {
  ethd__axes f = linkage->base;
  ethd_vec3 at[ETHD_JOINTS_MAX];
  for (uint32_t i = 0; i < linkage->count; i++) {
    double sine, cosine;
    at[i] = f.at;
    out->axis[i] = f.z;
    ethd_sincos(q[i] + linkage->link[i].offset, &sine, &cosine);
    turn_z(&f, sine, cosine);
    move(&f, linkage->link[i].a, linkage->link[i].d);
    turn_x(&f, linkage->link[i].sine, linkage->link[i].cosine);
  }
  out->x = ethd_vec3_add(f.at, seen(&f, linkage->tool));
  out->facing = seen(&f, linkage->facing);
  for (uint32_t i = 0; i < linkage->count; i++) out->j[i] = ethd_vec3_cross(out->axis[i], ethd_vec3_sub(out->x, at[i]));
}

ethd_vec3 ethd__linkage_sum(const ethd_vec3 *columns, const double *dq, uint32_t count) {
  ethd_vec3 sum = {0, 0, 0};
  for (uint32_t i = 0; i < count; i++) sum = ethd_vec3_add(sum, ethd_vec3_scale(dq[i], columns[i]));
  return sum;
}
