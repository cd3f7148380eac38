#include "ethd/finger_fit.h"

#include <math.h>

#include "fit_methods.h"

#define C1 0.92387953251128675613 /* cos(pi/8) */
#define C2 0.70710678118654752440
#define C3 0.38268343236508977173

static const ethd_vec directions[ETHD_RAYS] = {
    {1, 0},  {C1, C3},   {C2, C2},   {C3, C1},   {0, 1},  {-C3, C1}, {-C2, C2}, {-C1, C3},
    {-1, 0}, {-C1, -C3}, {-C2, -C2}, {-C3, -C1}, {0, -1}, {C3, -C1}, {C2, -C2}, {C1, -C3},
};

static void collect(const ethd_fit *fit, const double r[ETHD_RAYS], ethd__points *out) {
  out->count = out->used = 0;
  for (uint32_t k = 0; k < ETHD_RAYS; k++) {
    if (!(fabs(r[k]) < fit->ring_radius)) continue;
    out->p[out->count] = ethd_vec_scale(fit->ring_radius - r[k], directions[k]);
    out->ray[out->count++] = k;
    out->used |= 1u << k;
  }
}

/* From e = |p - c|^2 - R_f^2, small wherever the finger is what it is said to be, so that the variance
   keeps its digits. */
static void describe(const ethd_fit *fit, const ethd__points *points, ethd_vec centre,
                     ethd_finger *out) {
  double square = fit->finger_radius * fit->finger_radius, n = 0, sum = 0, sum2 = 0;
  for (uint32_t i = 0; i < points->count; i++) {
    ethd_vec u = ethd_vec_sub(points->p[i], centre);
    double e = ethd_vec_dot(u, u) - square;
    if (!(points->used >> points->ray[i] & 1)) continue;
    n += 1;
    sum += e;
    sum2 += e * e;
  }
  double mean = sum / n;
  out->centre = centre;
  out->radius = sqrt(square + mean);
  out->residual = sqrt(fmax(0, sum2 / n - mean * mean)) / (2 * out->radius);
  out->used = points->used;
  out->reserved = 0;
}

static int find(const ethd_fit *fit, ethd__points *points, ethd_vec *centre) {
  switch (fit->method) {
  case ETHD_FIT_VERTEX_MEAN:
    return ethd__fit_vertex_mean(points, centre);
  case ETHD_FIT_CENTROID:
    return ethd__fit_centroid(points, centre);
  case ETHD_FIT_ROBUST:
    return ethd__fit_robust(fit, points, centre);
  default:
    return ethd__fit_kasa(points, centre);
  }
}

ethd_status ethd_fit_step(const ethd_fit *fit, const double r[ETHD_RAYS], ethd_finger *out) {
  ethd__points points;
  ethd_vec centre;
  collect(fit, r, &points);
  if (!find(fit, &points, &centre)) return ETHD_STALE;
  if (!(ethd_vec_norm(centre) < fit->ring_radius)) return ETHD_STALE;
  describe(fit, &points, centre, out);
  return ETHD_OK;
}

void ethd_fit_rays(double ring_radius, double finger_radius, ethd_vec centre, double r[ETHD_RAYS]) {
  for (int k = 0; k < ETHD_RAYS; k++) {
    double along = ethd_vec_dot(directions[k], centre), across = ethd_vec_cross(directions[k], centre);
    double reach = along + sqrt(fmax(0, (finger_radius - across) * (finger_radius + across)));
    r[k] = fabs(across) <= finger_radius && reach > 0 ? ring_radius - reach : (double)NAN;
  }
}
