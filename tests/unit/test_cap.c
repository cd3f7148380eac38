/* The fingertip in a cap, against rays in long double, a Jacobian of differences, and the variance of trials. */
#include <stdio.h>
#include <string.h>

#include "draw.h"
#include "ethd/cap.h"
#include "unit/suite.h"

#define R 8e-3 /* m: the finger's */

/* The distance along a ray to a sphere, by the quadratic equation; NaN: it misses. */
static long double distance(const ethd_cap_ray *ray, const long double at[4]) {
  const long double w[3] = {ray->from.x - at[0], ray->from.y - at[1], ray->from.z - at[2]};
  const long double d[3] = {ray->along.x, ray->along.y, ray->along.z};
  long double dd = 0, wd = 0, ww = 0;
  for (int i = 0; i < 3; i++) dd += d[i] * d[i], wd += w[i] * d[i], ww += w[i] * w[i];
  return (-wd - sqrtl(wd * wd - dd * (ww - at[3] * at[3]))) / dd;
}

/* A half sphere of 14 mm with its opening down: a ray from the top and rings of 5, 6 and 8, all disturbed by `wild`. */
static ethd_cap cap_of(bool seeks_radius, double wild, uint64_t seed) {
  static const int rings[] = {1, 5, 6, 8};
  ethd_cap cap = {.seeks_radius = seeks_radius,
                  .finger_radius = R,
                  .reach = 14e-3,
                  .gate = 1.2e-3,
                  .rim = {0, 0, -2e-3},
                  .out = {0, 0, -1},
                  .rim_margin = 1e-3};
  for (int ring = 0; ring < 4; ring++)
    for (int i = 0; i < rings[ring]; i++) {
      const double polar = 0.5 * ring, turn = 6.28318530717958648 * (i + 0.3 * ring) / rings[ring];
      const ethd_vec3 up = {sin(polar) * cos(turn), sin(polar) * sin(turn), cos(polar)};
      const uint64_t at = seed * 1000 + 10 * cap.count;
      ethd_vec3 along = {wild * draw_normal(at) - up.x, wild * draw_normal(at + 1) - up.y,
                         wild * draw_normal(at + 2) - up.z};
      along = ethd_vec3_scale(1 / ethd_vec3_norm(along), along);
      const double out = 14e-3 * (1 + wild * draw_normal(at + 3));
      cap.rays[cap.count++] = (ethd_cap_ray){ethd_vec3_scale(out, up), along};
    }
  ethd_error error;
  ck_assert_msg(ethd_cap_check(&cap, &error) == ETHD_OK, "%s", error.name);
  return cap;
}

/* A finger up to 3 mm from the origin; if its radius is sought, up to 1.5 mm from the nominal one. */
static void finger_of(const ethd_cap *cap, uint64_t seed, long double at[4]) {
  for (int i = 0; i < 3; i++) at[i] = draw(seed * 4 + (uint64_t)i, -1.7e-3, 1.7e-3);
  at[3] = cap->seeks_radius ? draw(seed * 4 + 3, R - 1.5e-3, R + 1.5e-3) : R;
}

static double off(const ethd_cap_finger *f, const long double at[4]) {
  const long double x = f->centre.x - at[0], y = f->centre.y - at[1], z = f->centre.z - at[2];
  return (double)sqrtl(x * x + y * y + z * z);
}

/* ---- without noise ---- */

TEST_LOOP(test_exact, 0, 2) {
  double worst = 0, worst_radius = 0;
  int dropped = 0;
  for (uint64_t i = 0; i < 5000; i++) {
    const ethd_cap cap = cap_of(_i, 0.1, i);
    long double at[4];
    double r[ETHD_CAP_RAYS_MAX], inverse[ETHD_CAP_RAYS_MAX];
    finger_of(&cap, i, at);
    ethd_cap_rays(&cap, (ethd_vec3){(double)at[0], (double)at[1], (double)at[2]}, (double)at[3], inverse);
    for (uint32_t k = 0; k < cap.count; k++) {
      r[k] = (double)distance(&cap.rays[k], at);
      ck_assert(isnan(r[k]) ? isnan(inverse[k]) : fabs(r[k] - inverse[k]) <= 1e-15);
    }
    const uint32_t lies = (uint32_t)(draw_bits(i) % cap.count); /* one ray in three trials */
    if (i % 3 == 0) r[lies] += draw(i, 0, 1) < 0.5 ? 4e-3 : -4e-3;
    ethd_cap_finger f;
    ck_assert_int_eq(ethd_cap_step(&cap, r, &f), ETHD_OK);
    worst = fmax(worst, off(&f, at));
    worst_radius = fmax(worst_radius, fabs(f.radius - (double)at[3]));
    ck_assert_double_le(f.residual, 1e-12);
    if (i % 3 == 0) ck_assert(!(f.used >> lies & 1));
    for (uint32_t k = 0; k < cap.count; k++) dropped += !(f.used >> k & 1);
  }
  printf("worst error %.1e m, of the radius %.1e m; %d rays of 5000 trials not used\n", worst, worst_radius, dropped);
  ck_assert_double_le(worst, 1e-12);
  ck_assert_double_le(worst_radius, 1e-12);
  ck_assert_int_le(dropped, 5000 / 3 + 5000 / 2);
}

/* ---- noise ---- */

/* The Cramer-Rao bound from central differences, and Gauss-Jordan. */
static void bound_of(const ethd_cap *cap, const long double at[4], double noise, long double sd[3]) {
  const int n = cap->seeks_radius ? 4 : 3;
  long double m[4][8] = {{0}};
  for (uint32_t k = 0; k < cap->count; k++) {
    long double g[4];
    for (int i = 0; i < n; i++) {
      long double a[4], b[4];
      memcpy(a, at, sizeof a), memcpy(b, at, sizeof b);
      a[i] += 1e-8L, b[i] -= 1e-8L;
      g[i] = (distance(&cap->rays[k], a) - distance(&cap->rays[k], b)) / 2e-8L;
    }
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++) m[i][j] += g[i] * g[j];
  }
  for (int i = 0; i < n; i++) m[i][4 + i] = 1;
  for (int i = 0; i < n; i++) {
    const long double pivot = m[i][i];
    for (int j = 0; j < 8; j++) m[i][j] /= pivot;
    for (int k = 0; k < n; k++) {
      const long double by = m[k][i];
      for (int j = 0; j < 8 && k != i; j++) m[k][j] -= by * m[i][j];
    }
  }
  for (int i = 0; i < 3; i++) sd[i] = noise * sqrtl(m[i][4 + i]);
}

enum { TRIALS = 20000 };

/* The estimate reaches the bound: its variance over TRIALS is that of the bound within four sd of such a variance,
   which is sqrt(2 / TRIALS) of it. */
TEST_LOOP(test_variance, 0, 4) {
  const double noise = 0.02e-3;
  const ethd_cap cap = cap_of(_i % 2, 0.05, 7);
  long double at[4] = {0, 0, 0, R}, least[3];
  if (_i / 2) at[0] = 2e-3, at[1] = -1e-3, at[2] = 1e-3;
  ethd_vec3 sd;
  bound_of(&cap, at, noise, least);
  ck_assert_int_eq(ethd_cap_bound(&cap, (ethd_vec3){(double)at[0], (double)at[1], (double)at[2]}, noise, &sd), ETHD_OK);
  double bound[3], square[3] = {0, 0, 0};
  ethd_vec3_put(sd, bound);
  for (int i = 0; i < 3; i++) ck_assert_double_eq_tol(bound[i] / (double)least[i], 1, 1e-9);
  for (uint64_t t = 0; t < TRIALS; t++) {
    double r[ETHD_CAP_RAYS_MAX];
    for (uint32_t k = 0; k < cap.count; k++)
      r[k] = (double)distance(&cap.rays[k], at) + noise * draw_normal(t * ETHD_CAP_RAYS_MAX + k);
    ethd_cap_finger f;
    ck_assert_int_eq(ethd_cap_step(&cap, r, &f), ETHD_OK);
    ck_assert_uint_eq(f.used, (1u << cap.count) - 1);
    const double e[3] = {f.centre.x - (double)at[0], f.centre.y - (double)at[1], f.centre.z - (double)at[2]};
    for (int i = 0; i < 3; i++) square[i] += e[i] * e[i] / TRIALS;
  }
  for (int i = 0; i < 3; i++) {
    const double ratio = square[i] / (bound[i] * bound[i]);
    printf("%s, %s, axis %d: bound %.2f um, variance / bound^2 = %.4f\n", _i % 2 ? "radius sought" : "radius known",
           _i / 2 ? "aside" : "at rest", i, 1e6 * bound[i], ratio);
    ck_assert_double_eq_tol(ratio, 1, 4 * sqrt(2. / TRIALS));
  }
}

/* ---- what counts ---- */

/* Three rays (four if the radius is sought) determine a finger, one fewer don't; NaN, infinity and `reach` are missing. */
TEST_LOOP(test_few_rays, 0, 2) {
  const ethd_cap cap = cap_of(_i, 0, 1);
  const uint32_t some[] = {1, 3, 7, 12}, least = _i ? 4 : 3;
  for (uint32_t n = 2; n <= least; n++) {
    long double at[4] = {0.5e-3, -0.2e-3, 0.3e-3, R};
    double r[ETHD_CAP_RAYS_MAX];
    for (uint32_t k = 0; k < cap.count; k++) {
      const double missing[] = {(double)NAN, (double)INFINITY, -(double)INFINITY, 14e-3};
      r[k] = missing[k % 4];
    }
    for (uint32_t k = 0; k < n; k++) r[some[k]] = (double)distance(&cap.rays[some[k]], at);
    ethd_cap_finger f = {.radius = 42};
    ck_assert_int_eq(ethd_cap_step(&cap, r, &f), n < least ? ETHD_STATUS_STALE : ETHD_OK);
    if (n < least) ck_assert(f.radius == 42);
    if (n == least) ck_assert_double_le(off(&f, at), 1e-12);
  }
}

/* A ray that meets the finger at over 70.5 degrees doesn't count; what the finger touches does. */
TEST(test_grazing_and_touching) {
  for (int k = 0; k < 3; k++) {
    ethd_cap cap = cap_of(false, 0, 1);
    const double aside = R * sin((k == 1 ? 70.4 : 70.6) * 3.14159265358979324 / 180);
    cap.rays[cap.count++] = (ethd_cap_ray){{aside, 0, k ? 14e-3 : 7e-3}, {0, 0, -1}};
    if (!k) cap.rays[cap.count - 1].from.x = 0; /* begins 1 mm within the finger */
    const long double at[4] = {0, 0, 0, R};
    double r[ETHD_CAP_RAYS_MAX];
    ethd_cap_finger f;
    for (uint32_t i = 0; i < cap.count; i++) r[i] = (double)distance(&cap.rays[i], at);
    ck_assert(k || (r[cap.count - 1] < 0));
    ck_assert_int_eq(ethd_cap_step(&cap, r, &f), ETHD_OK);
    ck_assert_uint_eq(f.used >> (cap.count - 1) & 1, k < 2);
    ck_assert_double_le(off(&f, at), 1e-12);
  }
}

/* Random distances give a finger that explains half of those that count, or none. */
TEST(test_nonsense) {
  const ethd_cap cap = cap_of(true, 0.05, 3);
  int found = 0;
  for (uint64_t t = 0; t < 20000; t++) {
    double r[ETHD_CAP_RAYS_MAX];
    int count = 0;
    for (uint32_t k = 0; k < cap.count; k++) {
      r[k] = draw(t * ETHD_CAP_RAYS_MAX + k, -20e-3, 20e-3);
      count += fabs(r[k]) < cap.reach;
    }
    ethd_cap_finger f = {.radius = 42};
    const ethd_status status = ethd_cap_step(&cap, r, &f);
    ck_assert(status == ETHD_OK || status == ETHD_STATUS_STALE);
    ck_assert(status == ETHD_OK ? f.residual <= cap.gate && 2 * __builtin_popcount(f.used) >= count : f.radius == 42);
    ck_assert(status != ETHD_OK || (f.radius > R / 4 && f.radius < 4 * R));
    found += status == ETHD_OK;
  }
  printf("random rays: %d of 20000 give a finger\n", found);
  ck_assert_int_le(found, 200);
}

/* Over rim_margin beyond the rim there is no finger in the cap. */
TEST(test_gone) {
  const ethd_cap cap = cap_of(false, 0, 1);
  for (int k = 0; k < 2; k++) {
    const long double at[4] = {0, 0, k ? -3.0001e-3L : -2.9999e-3L, R};
    double r[ETHD_CAP_RAYS_MAX];
    ethd_cap_finger f;
    for (uint32_t i = 0; i < cap.count; i++) r[i] = (double)distance(&cap.rays[i], at);
    ck_assert_int_eq(ethd_cap_step(&cap, r, &f), ETHD_OK);
    ck_assert_int_eq(f.gone, k);
  }
}

/* A finger of another radius than the known one shows in the radius. */
TEST(test_other_radius) {
  const ethd_cap cap = cap_of(false, 0, 1);
  const long double at[4] = {0, 0, 0, R + 0.5e-3L};
  double r[ETHD_CAP_RAYS_MAX];
  ethd_cap_finger f;
  for (uint32_t i = 0; i < cap.count; i++) r[i] = (double)distance(&cap.rays[i], at);
  ck_assert_int_eq(ethd_cap_step(&cap, r, &f), ETHD_OK);
  ck_assert_double_ge(f.radius, R + 0.1e-3);
}

/* ---- checks ---- */

TEST(test_refused) {
  const ethd_cap good = cap_of(true, 0, 1);
  ethd_error error;
  ethd_cap c;
#define REFUSED(change, status, field)                    \
  do {                                                    \
    c = good;                                             \
    change;                                               \
    ck_assert_int_eq(ethd_cap_check(&c, &error), status); \
    ck_assert_str_eq(error.name, field);                  \
    ck_assert_int_eq(ethd_cap_check(&c, NULL), status);   \
  } while (0)
  REFUSED(c.count = 3, ETHD_E_RANGE, "count");
  REFUSED(c.count = 33, ETHD_E_RANGE, "count");
  REFUSED(c.rays[5].from.x = 1.01, ETHD_E_RANGE, "from");
  REFUSED(c.rays[19].from.y = -1.01, ETHD_E_RANGE, "from");
  REFUSED(c.rays[0].from.z = (double)NAN, ETHD_E_NOT_FINITE, "from");
  REFUSED(c.rays[0].along.z = -1.000002, ETHD_E_RANGE, "along");
  REFUSED(c.rays[0].along.z = -0.999998, ETHD_E_RANGE, "along");
  REFUSED(c.rays[0].along.z = (double)NAN, ETHD_E_NOT_FINITE, "along");
  REFUSED(c.finger_radius = 0.9e-4, ETHD_E_RANGE, "finger_radius");
  REFUSED(c.reach = 0, ETHD_E_RANGE, "reach");
  REFUSED(c.gate = 0.9e-5, ETHD_E_RANGE, "gate");
  REFUSED(c.rim.x = (double)INFINITY, ETHD_E_RANGE, "rim");
  REFUSED(c.rim.z = (double)NAN, ETHD_E_NOT_FINITE, "rim");
  REFUSED(c.out.z = -2, ETHD_E_RANGE, "out");
  REFUSED(c.rim_margin = -1e-3, ETHD_E_RANGE, "rim_margin");
  REFUSED(c.count = 6; for (int k = 0; k < 6; k++) c.rays[k] = good.rays[0], ETHD_E_RANGE, "rays"); /* one ray */
  REFUSED(c.finger_radius = 1e-3;
          for (int k = 0; k < 20; k++) c.rays[k].from.x += 0.5, ETHD_E_RANGE, "rays"); /* aside */
  c = good;
  c.rays[0].along.z = -1.0000009;
  ck_assert_int_eq(ethd_cap_check(&c, &error), ETHD_OK);
  c.seeks_radius = false, c.count = 3; /* the top and two sides */
  ck_assert_int_eq(ethd_cap_check(&c, &error), ETHD_OK);
  c.count = 2;
  ck_assert_int_eq(ethd_cap_check(&c, &error), ETHD_E_RANGE);
  for (int k = 0; k < 20; k++) { /* a ring of rays above the finger's middle: in one plane */
    const double turn = 6.28318530717958648 * k / 20;
    c.rays[k].from = (ethd_vec3){14e-3 * cos(turn), 14e-3 * sin(turn), 3e-3};
    c.rays[k].along = (ethd_vec3){-cos(turn), -sin(turn), 0};
  }
  c.count = 20;
  ck_assert_int_eq(ethd_cap_check(&c, &error), ETHD_E_RANGE);
  ck_assert_str_eq(error.name, "rays");
  ethd_vec3 sd = {42, 0, 0};
  ck_assert_int_eq(ethd_cap_bound(&good, (ethd_vec3){0.5, 0, 0}, 1e-3, &sd), ETHD_STATUS_STALE);
  ck_assert(sd.x == 42);
}
