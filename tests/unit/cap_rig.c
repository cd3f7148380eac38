#include "unit/cap_rig.h"

#include <check.h>

#include "unit/draw.h"

#define REACH 0.05 /* m */

cap_rig cap_rig_of(double radius, double finger_radius, ethd_vec3 axis, double rim) {
  static const int rings[] = {1, 5, 11, 15};
  cap_rig rig = {.axis = axis, .noise = 0.05e-3};
  ethd_cap *cap = &rig.cap;
  *cap = (ethd_cap){.finger_radius = finger_radius, .reach = REACH, .gate = 1e-3, .out = ethd_vec3_scale(-1, axis)};
  cap->rim = ethd_vec3_scale(rim, cap->out);
  const ethd_vec3 aside = fabs(axis.x) < 0.6 ? (ethd_vec3){1, 0, 0} : (ethd_vec3){0, 1, 0};
  ethd_vec3 a = ethd_vec3_cross(axis, aside);
  a = ethd_vec3_scale(1 / ethd_vec3_norm(a), a);
  const ethd_vec3 b = ethd_vec3_cross(axis, a);
  for (int ring = 0; ring < 4; ring++)
    for (int i = 0; i < rings[ring]; i++) {
      const double polar = 0.5 * ring, turn = 6.28318530717958648 * (i + 0.3 * ring) / rings[ring];
      ethd_vec3 up = ethd_vec3_scale(cos(polar), axis);
      up = ethd_vec3_add(up, ethd_vec3_scale(sin(polar) * cos(turn), a));
      up = ethd_vec3_add(up, ethd_vec3_scale(sin(polar) * sin(turn), b));
      cap->rays[cap->count++] = (ethd_cap_ray){ethd_vec3_scale(radius, up), ethd_vec3_scale(-1, up)};
    }
  ethd_error error;
  ck_assert_msg(ethd_cap_check(cap, &error) == ETHD_OK, "%s", error.name);
  return rig;
}

/* The distance along a ray to the sphere by the quadratic equation; NaN: it misses, and leaves through the rim. */
static double distance(const ethd_cap_ray *ray, ethd_vec3 centre, double radius) {
  const ethd_vec3 w = ethd_vec3_sub(ray->from, centre);
  const double along = ethd_vec3_dot(w, ray->along), inside = along * along - ethd_vec3_dot(w, w) + radius * radius;
  return inside < 0 ? (double)NAN : -along - sqrt(inside);
}

ethd_status cap_rig_read(cap_rig *rig, ethd_vec3 finger, ethd_cap_finger *out) {
  double r[ETHD_CAP_RAYS_MAX];
  for (uint32_t k = 0; k < rig->cap.count; k++)
    r[k] = distance(&rig->cap.rays[k], finger, rig->cap.finger_radius) + rig->noise * draw_normal(rig->drawn++);
  return ethd_cap_step(&rig->cap, r, out);
}
