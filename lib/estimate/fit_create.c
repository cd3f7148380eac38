/* Tables and checks of the ring fits. [main] */
#include <string.h>

#include "error.h"
#include "estimate/fit_methods.h"

static const ethd_param robust[] = {
    [ROBUST_GATE] = {"gate", "m", 1e-5, 1e-2, 1.2e-3,
                     "largest distance of a ray from the circle: its noise and the radius' error"},
};

const ethd_method ethd_fit_methods[ETHD_FIT_COUNT] = {
    [ETHD_FIT_KASA] = {"kasa", "circle by algebraic least squares", NULL, 0},
    [ETHD_FIT_VERTEX_MEAN] = {"vertex-mean", "mean of the polygon's vertices, half the true offset", NULL, 0},
    [ETHD_FIT_CENTROID] = {"centroid", "centroid of the polygon's area", NULL, 0},
    [ETHD_FIT_ROBUST] = {"robust", "circle of known radius, outliers left out", robust, sizeof robust / sizeof *robust},
};

#define RADIUS_MIN 1e-4 /* m */
#define RADIUS_MAX 1.0

static ethd_status check(ethd_fit_method method, const double *p, double ring_radius, double finger_radius,
                         ethd_error *error) {
  if ((uint32_t)method >= ETHD_FIT_COUNT)
    return ethd__refuse(error, ETHD_E_UNKNOWN, "method", (ethd__found){(double)method, 0, ETHD_FIT_COUNT - 1});
  const ethd_method *m = &ethd_fit_methods[method];
  ethd_status status = ethd__check_number(error, "ring_radius", ring_radius, RADIUS_MIN, RADIUS_MAX);
  if (!status) status = ethd__check_number(error, "finger_radius", finger_radius, RADIUS_MIN, ring_radius);
  if (!status) status = ethd_params_check(m->params, m->param_count, p, error);
  return status;
}

ethd_status ethd_fit_prepare(ethd_fit_method method, const double *p, double ring_radius, double finger_radius,
                             ethd_fit *out, ethd_error *error) {
  ethd_status status = check(method, p, ring_radius, finger_radius, error);
  if (status) return status;
  memset(out, 0, sizeof *out);
  out->method = method;
  out->ring_radius = ring_radius;
  out->finger_radius = finger_radius;
  for (uint32_t i = 0; i < ethd_fit_methods[method].param_count; i++) out->p[i] = p[i];
  return ETHD_OK;
}
