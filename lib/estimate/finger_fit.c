#include "ethd/estimate.h"
#include "fp_mode.h"

#include <math.h>

#include "estimate/fit_methods.h"

#define C1 0.92387953251128675613 /* cos(pi/8) */
#define C2 0.70710678118654752440
#define C3 0.38268343236508977173

static const two cosines[ETHD__PAIRS] = {{1, C1},   {C2, C3},   {0, -C3}, {-C2, -C1},
                                         {-1, -C1}, {-C2, -C3}, {0, C3},  {C2, C1}};
static const two sines[ETHD__PAIRS] = {{0, C3},  {C2, C1},   {1, C1},   {C2, C3},
                                       {0, -C3}, {-C2, -C1}, {-1, -C1}, {-C2, -C3}};

static void collect(const ethd_fit *fit, const double r[ETHD_RAYS], ethd__points *out) {
  for (int i = 0; i < ETHD__PAIRS; i++) {
    two free = {r[2 * i], r[2 * i + 1]};
    out->counts[i] = (two_bits)(two_abs(free) < fit->ring_radius);
    two reach = two_where(out->counts[i], fit->ring_radius - free);
    out->x[i] = reach * cosines[i];
    out->y[i] = reach * sines[i];
  }
  out->used = ethd__points_used(out->counts);
}

/* Computes radius and residual from e = |p - c|^2 - R_f^2. It is small if the finger has the given radius, and the
   variance of small numbers is accurate. If all points are in the ring's centre, rounding leaves no radius. */
static void describe(const ethd_fit *fit, const ethd__points *points, ethd_vec centre, ethd_finger *out) {
  double square = fit->finger_radius * fit->finger_radius, n = ethd__count(points->used);
  two sum = {0, 0}, sum2 = {0, 0};
  for (int i = 0; i < ETHD__PAIRS; i++) {
    two x = points->x[i] - centre.x, y = points->y[i] - centre.y;
    two e = two_where(points->counts[i], x * x + y * y - square);
    sum += e;
    sum2 += e * e;
  }
  double mean = two_sum(sum) / n, radius2 = fmax(0, square + mean);
  out->centre = centre;
  out->radius = sqrt(radius2);
  out->residual = radius2 > 0 ? sqrt(fmax(0, two_sum(sum2) / n - mean * mean) / radius2) / 2 : 0;
  out->used = points->used;
  out->reserved = 0;
}

static bool find(const ethd_fit *fit, ethd__points *points, ethd_vec *centre) {
  switch (fit->method) { /* unreachable: a method that isn't listed */
  case ETHD_FIT_VERTEX_MEAN: return ethd__fit_vertex_mean(points, centre);
  case ETHD_FIT_CENTROID: return ethd__fit_centroid(points, centre);
  case ETHD_FIT_ROBUST: return ethd__fit_robust(fit, points, centre);
  case ETHD_FIT_KASA:
  case ETHD_FIT_COUNT: break;
  }
  return ethd__fit_kasa(points, centre);
}

static inline ethd_status finish(const ethd_fit *fit, ethd__points *points, ethd_finger *out) {
  ethd_vec centre;
  if (!find(fit, points, &centre)) return ETHD_STATUS_STALE;
  if (!(ethd_vec_dot(centre, centre) < fit->ring_radius * fit->ring_radius)) return ETHD_STATUS_STALE;
  describe(fit, points, centre, out);
  return ETHD_OK;
}

ETHD__FP_APART static ethd_status fit_step(const ethd_fit *fit, const double r[ETHD_RAYS], ethd_finger *out) {
  ethd__points points;
  collect(fit, r, &points);
  return finish(fit, &points, out);
}

ethd_status ethd_fit_step(const ethd_fit *fit, const double r[ETHD_RAYS], ethd_finger *out) {
  ETHD__FP_RETURN(ethd_status, fit_step(fit, r, out));
}

ethd_status ethd__fit_moving(const ethd_fit *fit, const double r[ETHD_RAYS], const double lag[ETHD_RAYS], ethd_vec v,
                             ethd_finger *out) {
  ethd__points points;
  collect(fit, r, &points);
  for (int i = 0; i < ETHD__PAIRS; i++) {
    two passed = two_where(points.counts[i], (two){lag[2 * i], lag[2 * i + 1]});
    points.x[i] += passed * v.x;
    points.y[i] += passed * v.y;
  }
  return finish(fit, &points, out);
}

ETHD__FP_APART static void fit_rays(double ring_radius, double finger_radius, ethd_vec centre, double r[ETHD_RAYS]) {
  for (int k = 0; k < ETHD_RAYS; k++) {
    ethd_vec u = {cosines[k / 2][k % 2], sines[k / 2][k % 2]};
    double along = ethd_vec_dot(u, centre), across = ethd_vec_cross(u, centre);
    double reach = along + sqrt(fmax(0, (finger_radius - across) * (finger_radius + across)));
    r[k] = fabs(across) <= finger_radius && reach > 0 ? ring_radius - reach : (double)NAN;
  }
}

void ethd_fit_rays(double ring_radius, double finger_radius, ethd_vec centre, double r[ETHD_RAYS]) {
  ETHD__FP_DO(fit_rays(ring_radius, finger_radius, centre, r));
}
