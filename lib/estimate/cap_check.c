/* Checks of a cap. [main] */
#include "error.h"
#include "estimate/fit_sphere.h"

#define LENGTH_MAX 1.0  /* m */
#define RADIUS_MIN 1e-4 /* m */
#define GATE_MIN 1e-5   /* m */
#define UNIT_ERROR 1e-6 /* of a direction's length */
#define LEAST 1e-12     /* m: a reach that isn't 0 */

static ethd_status check_place(ethd_error *error, const char *name, ethd_vec3 p) {
  ethd_status status = ethd__check_number(error, name, p.x, -LENGTH_MAX, LENGTH_MAX);
  if (!status) status = ethd__check_number(error, name, p.y, -LENGTH_MAX, LENGTH_MAX);
  if (!status) status = ethd__check_number(error, name, p.z, -LENGTH_MAX, LENGTH_MAX);
  return status;
}

static ethd_status check_direction(ethd_error *error, const char *name, ethd_vec3 d) {
  return ethd__check_number(error, name, ethd_vec3_norm(d), 1 - UNIT_ERROR, 1 + UNIT_ERROR);
}

static ethd_status check_numbers(const ethd_cap *cap, ethd_error *error) {
  ethd_status status = ethd__check_number(error, "count", cap->count, cap->seeks_radius ? 4 : 3, ETHD_CAP_RAYS_MAX);
  for (uint32_t k = 0; k < cap->count && !status; k++) {
    status = check_place(error, "from", cap->rays[k].from);
    if (!status) status = check_direction(error, "along", cap->rays[k].along);
  }
  if (!status) status = ethd__check_number(error, "finger_radius", cap->finger_radius, RADIUS_MIN, LENGTH_MAX);
  if (!status) status = ethd__check_number(error, "reach", cap->reach, LEAST, LENGTH_MAX);
  if (!status) status = ethd__check_number(error, "gate", cap->gate, GATE_MIN, LENGTH_MAX);
  if (!status) status = check_place(error, "rim", cap->rim);
  if (!status) status = check_direction(error, "out", cap->out);
  if (!status) status = ethd__check_number(error, "rim_margin", cap->rim_margin, 0, LENGTH_MAX);
  return status;
}

/* Rays in one plane can't determine the side of the plane on which a finger is. */
static bool in_one_plane(const ethd_cap *cap) {
  ethd__normal m = {.n = 3};
  ethd_vec3 mean = {0, 0, 0};
  for (uint32_t k = 0; k < cap->count; k++)
    mean = ethd_vec3_add(mean, ethd_vec3_scale(1. / cap->count, cap->rays[k].from));
  for (uint32_t k = 0; k < cap->count; k++) {
    double g[4] = {0};
    ethd_vec3_put(cap->rays[k].along, g);
    ethd__normal_add(&m, g, 0);
    ethd_vec3_put(ethd_vec3_scale(1 / cap->finger_radius, ethd_vec3_sub(cap->rays[k].from, mean)), g);
    ethd__normal_add(&m, g, 0);
  }
  return !ethd__normal_factorise(&m);
}

ethd_status ethd_cap_check(const ethd_cap *cap, ethd_error *error) {
  ethd_status status = check_numbers(cap, error);
  if (status) return status;
  ethd_vec3 sd;
  const bool determined = ethd_cap_bound(cap, (ethd_vec3){0, 0, 0}, 1, &sd) == ETHD_OK;
  if (in_one_plane(cap) || !determined) return ethd__refuse(error, ETHD_E_RANGE, "rays", ethd__unsaid);
  return ETHD_OK;
}
