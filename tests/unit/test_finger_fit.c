/* Ring fits against brute force and hand-made polygons. Their errors beside the Cramer-Rao bound: tests/bench_quick.sh. */
#include "ethd/estimate.h"

#include <string.h>

#include "unit/draw.h"
#include "unit/suite.h"

#define RING 12e-3
#define FINGER 7.5e-3
#define PI 3.14159265358979323846

enum { TRIALS = 20000 };

static ethd_fit prepared(ethd_fit_method method) {
  double p[ETHD_PARAMS_MAX];
  ethd_fit fit;
  const ethd_method *m = &ethd_fit_methods[method];
  ethd_params_default(m->params, m->param_count, p);
  ck_assert_int_eq(ethd_fit_prepare(method, p, RING, FINGER, &fit, NULL), ETHD_OK);
  return fit;
}

static ethd_vec point(const double *r, int k) {
  return (ethd_vec){(RING - r[k]) * cos(PI * k / 8), (RING - r[k]) * sin(PI * k / 8)};
}

/* Uniform over the disc of 4 mm. */
static ethd_vec some_centre(uint64_t i) {
  double r = 4e-3 * sqrt(draw(2 * i, 0, 1)), a = draw(2 * i + 1, 0, 2 * PI);
  return (ethd_vec){r * cos(a), r * sin(a)};
}

static void noisy(double *r, uint64_t i, double range) {
  for (int k = 0; k < ETHD_RAYS; k++) r[k] += draw((i << 5) + (uint64_t)k, -range, range);
}

static double distance(ethd_vec a, ethd_vec b) { return ethd_vec_norm(ethd_vec_sub(a, b)); }

/* ---- geometry ---- */

TEST(test_rays_end_on_the_finger) {
  for (uint64_t i = 0; i < 2000; i++) {
    double r[ETHD_RAYS];
    ethd_vec c = some_centre(i);
    ethd_fit_rays(RING, FINGER, c, r);
    for (int k = 0; k < ETHD_RAYS; k++) {
      ck_assert_double_eq_tol(distance(point(r, k), c), FINGER, 1e-17);
      /* The finger lies on the inner side: there is nothing of it between there and the ring. */
      ck_assert_double_gt(distance((ethd_vec){RING * cos(PI * k / 8), RING * sin(PI * k / 8)}, c), FINGER);
    }
  }
}

TEST(test_rays_that_miss) {
  double r[ETHD_RAYS];
  ethd_fit_rays(RING, 2e-3, (ethd_vec){5e-3, 0}, r);
  /* asin(2/5) = 23.6 deg: only rays 0 and +-22.5 deg meet it, and none from the other side. */
  for (int k = 0; k < ETHD_RAYS; k++) ck_assert_int_eq(!isnan(r[k]), k <= 1 || k == 15);
  ck_assert_double_eq_tol(r[0], RING - 7e-3, 1e-17);
}

/* Without noise both circles are exact, whatever rays are missing. */
TEST_LOOP(test_circles_are_exact, 0, 2) {
  ethd_fit fit = prepared(_i ? ETHD_FIT_ROBUST : ETHD_FIT_KASA);
  for (uint64_t i = 0; i < 5000; i++) {
    double r[ETHD_RAYS];
    ethd_vec c = some_centre(i);
    ethd_finger finger;
    uint32_t mask = 0xffff;
    if (i % 2) mask = (uint32_t)draw_bits(i) & 0xffff;
    if (__builtin_popcount(mask) < 3) mask |= 0x0421;
    ethd_fit_rays(RING, FINGER, c, r);
    for (int k = 0; k < ETHD_RAYS; k++)
      if (!(mask >> k & 1)) r[k] = NAN;
    ck_assert_int_eq(ethd_fit_step(&fit, r, &finger), ETHD_OK);
    ck_assert_double_le(distance(finger.centre, c), 1e-12);
    ck_assert_double_eq_tol(finger.radius, FINGER, 1e-12);
    ck_assert_double_le(finger.residual, 1e-12);
    ck_assert_uint_eq(finger.used, mask);
  }
}

TEST(test_two_rays_with_known_radius) {
  ethd_fit robust = prepared(ETHD_FIT_ROBUST), kasa = prepared(ETHD_FIT_KASA);
  for (int k = 1; k < ETHD_RAYS; k++) {
    double all[ETHD_RAYS], r[ETHD_RAYS];
    ethd_vec c = {0.4e-3, -0.7e-3};
    ethd_finger finger = {.radius = 42};
    ethd_fit_rays(RING, FINGER, c, all);
    for (int i = 0; i < ETHD_RAYS; i++) r[i] = i == 0 || i == k ? all[i] : NAN;
    ck_assert_int_eq(ethd_fit_step(&kasa, r, &finger), ETHD_STATUS_STALE);
    ck_assert(finger.radius == 42);
    if (k == 8) continue; /* opposite: the centre may move across them */
    ck_assert_int_eq(ethd_fit_step(&robust, r, &finger), ETHD_OK);
    ck_assert_double_le(distance(finger.centre, c), 1e-6);
  }
}

/* Where the first step from the ring's middle goes, by the normal equations of two points: how far from the line
   between them it ends, times their distance. */
static double beside_after_a_step(ethd_vec u, ethd_vec v) {
  double det = ethd_vec_cross(u, v), g = (ethd_vec_dot(u, u) - FINGER * FINGER) / 2,
         h = (ethd_vec_dot(v, v) - FINGER * FINGER) / 2;
  ethd_vec s = {(g * v.y - h * u.y) / det, (h * u.x - g * v.x) / det};
  return ethd_vec_cross(ethd_vec_sub(u, s), ethd_vec_sub(v, s));
}

/* Two points farther apart than a finger is wide, so that the first step ends on the line between them: there nothing
   holds the centre across it, and there is no answer. */
TEST(test_two_rays_too_far_apart) {
  ethd_fit fit = prepared(ETHD_FIT_ROBUST);
  double low = 0, high = RING - 5e-3, r[ETHD_RAYS];
  ethd_vec u = {RING, 0}, way = {cos(6 * PI / 8), sin(6 * PI / 8)};
  int falls = beside_after_a_step(u, ethd_vec_scale(RING - low, way)) > 0;
  for (int i = 0; i < 60; i++) {
    double middle = (low + high) / 2;
    *((beside_after_a_step(u, ethd_vec_scale(RING - middle, way)) > 0) == falls ? &low : &high) = middle;
  }
  ck_assert_double_lt(low, RING - 5.1e-3);
  ethd_finger finger = {.radius = 42};
  for (int k = 0; k < ETHD_RAYS; k++) r[k] = NAN;
  r[0] = 0;
  r[6] = low;
  ck_assert_int_eq(ethd_fit_step(&fit, r, &finger), ETHD_STATUS_STALE);
  ck_assert(finger.radius == 42);
}

/* ---- least squares, against a search that knows nothing of normal equations ---- */

typedef struct problem {
  const double *r;
  uint32_t used;
  long double radius; /* 0: sought */
} problem;

static long double cost(const problem *p, const long double v[3]) {
  long double sum = 0;
  for (int k = 0; k < ETHD_RAYS; k++) {
    if (!(p->used >> k & 1)) continue;
    long double rho = (long double)RING - p->r[k], a = 3.14159265358979323846264338327950288L * k / 8;
    long double dx = rho * cosl(a) - v[0], dy = rho * sinl(a) - v[1], radius = p->radius > 0 ? p->radius : v[2];
    long double e = dx * dx + dy * dy - radius * radius;
    sum += e * e;
  }
  return sum;
}

/* Steps along the axes, halved when none helps. */
static void search(const problem *p, long double v[3]) {
  long double best = cost(p, v);
  for (long double step = 1e-3L; step > 1e-10L;) {
    int better = 0;
    for (int k = 0; k < 6; k++) {
      long double w[3] = {v[0], v[1], v[2]};
      w[k / 2] += k % 2 ? step : -step;
      long double c = cost(p, w);
      if (c < best) best = c, memcpy(v, w, sizeof w), better = 1;
    }
    if (!better) step /= 2;
  }
}

TEST_LOOP(test_least_squares, 0, 2) {
  int robust = _i;
  ethd_fit fit = prepared(robust ? ETHD_FIT_ROBUST : ETHD_FIT_KASA);
  for (uint64_t i = 0; i < 40; i++) {
    double r[ETHD_RAYS];
    ethd_finger finger;
    ethd_fit_rays(RING, FINGER, some_centre(i), r);
    noisy(r, i, 0.3e-3);
    if (i % 2) r[i % 16] = r[(i + 3) % 16] = r[(i + 4) % 16] = NAN;
    if (robust && i % 4 > 1) r[5] += 3e-3;
    if (robust && i % 4 == 3) r[11] -= 3e-3;
    ck_assert_int_eq(ethd_fit_step(&fit, r, &finger), ETHD_OK);
    long double v[3] = {0, 0, FINGER};
    search(&(problem){r, finger.used, robust ? FINGER : 0}, v);
    ck_assert_double_le(distance(finger.centre, (ethd_vec){(double)v[0], (double)v[1]}), robust ? 1e-6 : 2e-8);
    if (!robust) ck_assert_double_eq_tol(finger.radius, (double)v[2], 2e-8);
    if (robust && i % 4 > 1) ck_assert_uint_eq(finger.used >> 5 & 1, 0);
    if (robust && i % 4 == 3) ck_assert_uint_eq(finger.used >> 11 & 1, 0);
  }
}

/* A ray is left out by its distance from the circle, and then from radius and residual as well. */
TEST(test_gate) {
  ethd_fit fit = prepared(ETHD_FIT_ROBUST);
  const double off[] = {0.8e-3, -0.8e-3, 1.8e-3, -1.8e-3, 4e-3, -4e-3};
  for (int i = 0; i < 6; i++)
    for (int k = 0; k < ETHD_RAYS; k++) {
      double r[ETHD_RAYS];
      ethd_finger finger;
      ethd_vec c = {1e-3, -0.5e-3};
      int out = fabs(off[i]) > 1.2e-3;
      ethd_fit_rays(RING, FINGER, c, r);
      r[k] += off[i];
      ck_assert_int_eq(ethd_fit_step(&fit, r, &finger), ETHD_OK);
      ck_assert_uint_eq(finger.used, 0xffffu & ~((uint32_t)out << k));
      ck_assert(out == (distance(finger.centre, c) < 1e-6));
      ck_assert(out == (fabs(finger.radius - FINGER) < 1e-6));
      ck_assert(out == (finger.residual < 1e-6));
    }
}

/* Three rays side by side say little, but where kasa gets lost the known radius doesn't. */
TEST(test_three_rays_side_by_side) {
  ethd_fit fit = prepared(ETHD_FIT_ROBUST);
  double sum = 0;
  for (uint64_t i = 0; i < TRIALS; i++) {
    double r[ETHD_RAYS];
    ethd_finger finger;
    ethd_vec c = some_centre(i);
    ethd_fit_rays(RING, FINGER, c, r);
    noisy(r, i, 0.3e-3);
    for (uint64_t k = 0; k < 13; k++) r[(i + k) % 16] = NAN;
    ck_assert_int_eq(ethd_fit_step(&fit, r, &finger), ETHD_OK);
    sum += distance(finger.centre, c) * distance(finger.centre, c);
  }
  ck_assert_double_le(1e3 * sqrt(sum / TRIALS), 0.40);
}

/* ---- polygons ---- */

static void kite(double r[ETHD_RAYS]) {
  for (int k = 0; k < ETHD_RAYS; k++) r[k] = NAN;
  r[0] = RING - 8e-3; /* (8, 0), (0, 4), (-4, 0), (0, -4) mm */
  r[4] = r[8] = r[12] = RING - 4e-3;
}

TEST(test_polygons_by_hand) {
  ethd_fit mean = prepared(ETHD_FIT_VERTEX_MEAN), area = prepared(ETHD_FIT_CENTROID);
  double r[ETHD_RAYS];
  ethd_finger finger;
  kite(r);
  ck_assert_int_eq(ethd_fit_step(&mean, r, &finger), ETHD_OK);
  ck_assert_double_le(distance(finger.centre, (ethd_vec){1e-3, 0}), 1e-17);
  /* Squared distances from (1, 0): 49, 17, 25, 17, mean 27; off it by 22, -10, -2, -10. */
  ck_assert_double_eq_tol(finger.radius, sqrt(27) * 1e-3, 1e-17);
  ck_assert_double_eq_tol(finger.residual, sqrt((22 * 22 + 2 * 10 * 10 + 2 * 2) / 4.0) / (2 * sqrt(27)) * 1e-3, 1e-17);
  /* Two triangles: 32 mm^2 about (8/3, 0), 16 mm^2 about (-4/3, 0). */
  ck_assert_int_eq(ethd_fit_step(&area, r, &finger), ETHD_OK);
  ck_assert_double_le(distance(finger.centre, (ethd_vec){4e-3 / 3, 0}), 1e-17);
  ck_assert_uint_eq(finger.used, 0x1111);
}

/* Shoelace about the origin. */
TEST(test_centroid_as_shoelace) {
  ethd_fit fit = prepared(ETHD_FIT_CENTROID);
  for (uint64_t i = 0; i < 1000; i++) {
    double r[ETHD_RAYS];
    ethd_finger finger;
    ethd_fit_rays(RING, FINGER, some_centre(i), r);
    noisy(r, i, 0.3e-3);
    r[i % 16] = r[(i + 1) % 16] = r[i * i % 16] = NAN;
    double area = 0, x = 0, y = 0;
    for (int k = 0, next; k < ETHD_RAYS; k++) {
      if (isnan(r[k])) continue;
      for (next = k + 1; isnan(r[next % 16]);) next++;
      ethd_vec p = point(r, k), q = point(r, next % 16);
      double cross = p.x * q.y - q.x * p.y;
      area += cross / 2;
      x += cross * (p.x + q.x) / 6;
      y += cross * (p.y + q.y) / 6;
    }
    ck_assert_int_eq(ethd_fit_step(&fit, r, &finger), ETHD_OK);
    ck_assert_double_le(distance(finger.centre, (ethd_vec){x / area, y / area}), 1e-16);
  }
}

/* The mean of 16 u u^T is half the identity. */
TEST(test_vertex_mean_has_gain_one_half) {
  ethd_fit fit = prepared(ETHD_FIT_VERTEX_MEAN);
  for (int i = 0; i < 50; i++) {
    double r[ETHD_RAYS], a = i * 0.13, offset = 1e-6;
    ethd_finger finger;
    ethd_fit_rays(RING, FINGER, (ethd_vec){offset * cos(a), offset * sin(a)}, r);
    ck_assert_int_eq(ethd_fit_step(&fit, r, &finger), ETHD_OK);
    ck_assert_double_le(distance(finger.centre, (ethd_vec){offset / 2 * cos(a), offset / 2 * sin(a)}), 1e-6 * offset);
  }
}

/* ---- rays that don't count, rays that don't suffice ---- */

TEST_LOOP(test_what_counts, 0, ETHD_FIT_COUNT) {
  const double edge[] = {RING, 1.5 * RING, INFINITY, -INFINITY, NAN, -RING, -1};
  ethd_fit fit = prepared((ethd_fit_method)_i);
  for (size_t e = 0; e < sizeof edge / sizeof *edge; e++) {
    double r[ETHD_RAYS], without[ETHD_RAYS];
    ethd_finger a, b;
    ethd_fit_rays(RING, FINGER, (ethd_vec){1e-3, 2e-3}, r);
    memcpy(without, r, sizeof r);
    r[3] = edge[e];
    without[3] = NAN;
    ck_assert_int_eq(ethd_fit_step(&fit, r, &a), ETHD_OK);
    ck_assert_int_eq(ethd_fit_step(&fit, without, &b), ETHD_OK);
    ck_assert_mem_eq(&a, &b, sizeof a);
    ck_assert_uint_eq(a.used, 0xfff7);
  }
  double r[ETHD_RAYS];
  ethd_finger finger;
  ethd_fit_rays(RING, FINGER, (ethd_vec){RING - FINGER + 0.1e-3, 0}, r); /* touches, 0.1 mm into the ring */
  ck_assert_double_lt(r[0], 0);
  ck_assert_int_eq(ethd_fit_step(&fit, r, &finger), ETHD_OK);
  ck_assert_uint_eq(finger.used & 1, 1);
  for (uint64_t i = 0; i < 1000; i++) { /* rays that end all but in the ring's centre: without size, but numbers */
    for (uint64_t k = 0; k < ETHD_RAYS; k++)
      r[k] = draw(k, 0, 1000) < (double)i ? NAN : RING - draw(16 * i + k, 0, 1e-12);
    if (ethd_fit_step(&fit, r, &finger) != ETHD_OK) continue;
    ck_assert(finger.radius >= 0 && finger.radius < 1e-9 && finger.residual >= 0 && finger.residual < 1e6);
  }
}

TEST_LOOP(test_too_little, 0, ETHD_FIT_COUNT) {
  ethd_fit fit = prepared((ethd_fit_method)_i);
  double r[ETHD_RAYS];
  ethd_finger finger = {.radius = 42};
  for (int k = 0; k < ETHD_RAYS; k++) r[k] = NAN;
  for (int k = 0; k < 2; k++) { /* none, then one */
    ck_assert_int_eq(ethd_fit_step(&fit, r, &finger), ETHD_STATUS_STALE);
    r[6] = 4e-3;
  }
  const int lines_tell = _i == ETHD_FIT_ROBUST || _i == ETHD_FIT_VERTEX_MEAN;
  for (int k = 1; k < ETHD_RAYS; k++) { /* three on a line, 5 mm from the ring's centre */
    for (int i = 0; i < ETHD_RAYS; i++) r[i] = NAN;
    r[k] = RING - 5e-3;
    r[k - 1] = r[(k + 1) % 16] = RING - 5e-3 / cos(PI / 8);
    ck_assert_int_eq(ethd_fit_step(&fit, r, &finger), lines_tell ? ETHD_OK : ETHD_STATUS_STALE);
    if (lines_tell) finger.radius = 42;
  }
  if (_i == ETHD_FIT_KASA) {
    r[15] -= 0.05e-3; /* nearly: the circle's centre lies far outside */
    ck_assert_int_eq(ethd_fit_step(&fit, r, &finger), ETHD_STATUS_STALE);
  }
  ck_assert(finger.radius == 42);
}

/* ---- set-up ---- */

TEST(test_tables) {
  for (int m = 0; m < ETHD_FIT_COUNT; m++) {
    const ethd_method *method = &ethd_fit_methods[m];
    ethd_fit a, b;
    double p[ETHD_PARAMS_MAX];
    ck_assert_int_eq(ethd_params_check_table(method->params, method->param_count, NULL), ETHD_OK);
    memset(&a, 0, sizeof a);
    memset(&b, 0xa5, sizeof b);
    ethd_params_default(method->params, method->param_count, p);
    ck_assert_int_eq(ethd_fit_prepare((ethd_fit_method)m, p, RING, FINGER, &a, NULL), ETHD_OK);
    ck_assert_int_eq(ethd_fit_prepare((ethd_fit_method)m, p, RING, FINGER, &b, NULL), ETHD_OK);
    ck_assert_mem_eq(&a, &b, sizeof a);
  }
}

TEST(test_refusals) {
  static const struct {
    int method;
    double gate, ring, finger;
    ethd_status status;
    const char *name;
  } bad[] = {
      {ETHD_FIT_ROBUST, 0, RING, FINGER, ETHD_E_RANGE, "gate"},
      {ETHD_FIT_ROBUST, NAN, RING, FINGER, ETHD_E_NOT_FINITE, "gate"},
      {ETHD_FIT_KASA, 0, NAN, FINGER, ETHD_E_NOT_FINITE, "ring_radius"},
      {ETHD_FIT_KASA, 0, 0, FINGER, ETHD_E_RANGE, "ring_radius"},
      {ETHD_FIT_KASA, 0, RING, 1.01 * RING, ETHD_E_RANGE, "finger_radius"},
      {ETHD_FIT_KASA, 0, RING, -FINGER, ETHD_E_RANGE, "finger_radius"},
      {ETHD_FIT_COUNT, 0, RING, FINGER, ETHD_E_UNKNOWN, "method"},
  };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    double p[ETHD_PARAMS_MAX] = {bad[i].gate};
    ethd_fit fit = {.ring_radius = 42};
    ethd_error error;
    ck_assert_int_eq(ethd_fit_prepare((ethd_fit_method)bad[i].method, p, bad[i].ring, bad[i].finger, &fit, &error),
                     bad[i].status);
    ck_assert_str_eq(error.name, bad[i].name);
    ck_assert(fit.ring_radius == 42);
  }
}
