/* The ring of on-off light barriers: the table against counting by an own geometry, all patterns, what the sensor's
   decoded centre is worth; the nail's plate. */
#include <stdlib.h>

#include "finger/nail.h"
#include "finger/zones.h"
#include "unit/rig.h"

#define R 0.012
#define F 0.0075
#define PI 3.14159265358979323846

/* Marches along the barrier's ray from the ring inward: another way than the closed form. */
static double marched(double angle, ethd_vec centre) {
  for (double d = 0; d < 2 * R; d += 5e-6) {
    double x = (R - d) * cos(angle) - centre.x, y = (R - d) * sin(angle) - centre.y;
    if (x * x + y * y <= F * F) return d;
  }
  return (double)INFINITY;
}

static double draw(double a, double b) { return a + (b - a) * (double)rand() / RAND_MAX; }

static ethd_vec draw_centre(void) {
  ethd_vec c;
  do c = (ethd_vec){draw(F - R, R - F), draw(F - R, R - F)};
  while (hypot(c.x, c.y) > R - F);
  return c;
}

TEST_LOOP(test_distance, 8, 17) {
  ethd__zones z;
  srand(1);
  ethd__zones_prepare((uint32_t)_i, 3.5e-3, R, F, 0, &z);
  for (int i = 0; i < 40; i++) {
    ethd_vec c = draw_centre();
    uint32_t k = (uint32_t)i % z.count;
    double d = ethd__zones_distance(&z, F, c, k), m = marched(2 * PI * k / _i, c);
    ck_assert((isinf(d) && isinf(m)) || fabs(d - m) < 1e-5);
  }
}

static uint32_t lit_of(const ethd__zones *z, ethd_vec c) {
  uint32_t lit = 0;
  for (uint32_t k = 0; k < z->count; k++) lit |= (uint32_t)(marched(2 * PI * k / z->count, c) <= z->reach) << k;
  return lit;
}

/* Centres anywhere: the mean error is 0, and its sd what the sensor says, by number of lit barriers. */
TEST_LOOP(test_table, 8, 17) {
  ethd__zones z;
  double n[17] = {0}, along[17] = {0}, square[17] = {0}, told[17] = {0};
  srand(2);
  ethd__zones_prepare((uint32_t)_i, 3.5e-3, R, F, 0, &z);
  for (int i = 0; i < 2500; i++) {
    ethd_vec c = draw_centre(), seen;
    uint32_t lit = lit_of(&z, c), count = (uint32_t)__builtin_popcount(lit);
    double noise;
    if (!ethd__zones_centre(&z, lit, &seen, &noise)) {
      ck_assert_uint_gt(count, 0); /* a number that the grid of the table hardly has */
      continue;
    }
    double ex = c.x - seen.x, ey = c.y - seen.y, length = hypot(seen.x, seen.y);
    n[count]++;
    along[count] += length > 0 ? (ex * seen.x + ey * seen.y) / length : ex;
    square[count] += (ex * ex + ey * ey) / 2;
    told[count] = noise;
  }
  int judged = 0;
  for (int l = 0; l <= _i; l++) {
    if (n[l] < 150) continue;
    judged++;
    double sd = sqrt(square[l] / n[l]);
    ck_assert_double_le(fabs(along[l] / n[l]), 4 * sd / sqrt(n[l]));
    ck_assert_double_eq_tol(sd / told[l], 1, 0.1);
  }
  ck_assert_int_ge(judged, 2);
  /* dark: a disc that reaches to where the first barrier is lit, sd of an axis a quarter of its diameter */
  ck_assert_double_ge(z.noise[0], (R - F - z.reach) / 2 * 0.99);
  ck_assert_double_le(z.noise[0], (R - F - z.reach) / 2 * 1.35);
}

/* Every pattern there is: rows of neighbours that a finger can light give a centre within the ring, toward their
   middle; all else is refused. */
TEST_LOOP(test_patterns, 8, 17) {
  ethd__zones z;
  ethd__zones_prepare((uint32_t)_i, 3.5e-3, R, F, 1e-4, &z);
  uint32_t good = 0, rows = 0;
  for (uint32_t lit = 0; lit < UINT32_C(1) << _i; lit++) {
    ethd_vec c = {7, 7};
    double noise = 7, sx = 0, sy = 0;
    uint32_t changes = 0;
    for (int k = 0; k < _i; k++) {
      changes += (lit >> k & 1) != (lit >> (k + 1) % _i & 1);
      sx += (lit >> k & 1) * cos(2 * PI * k / _i), sy += (lit >> k & 1) * sin(2 * PI * k / _i);
    }
    rows += changes <= 2;
    if (!ethd__zones_centre(&z, lit, &c, &noise)) continue;
    good++;
    ck_assert_uint_le(changes, 2);
    ck_assert(hypot(c.x, c.y) <= R - F && noise >= 1e-4 && noise < R);
    ck_assert_double_ge(c.x * sx + c.y * sy, 0);
    ck_assert_double_eq_tol(c.x * sy - c.y * sx, 0, 1e-12);
  }
  ck_assert_uint_gt(good, 2 * (uint32_t)_i);
  ck_assert_uint_lt(good, rows);
  ethd_vec c;
  double noise;
  ck_assert(!ethd__zones_centre(&z, UINT32_C(1) << _i, &c, &noise)); /* a barrier that isn't there */
}

TEST(test_nail) {
  const ethd__nail nail = {{0, 1}, 5e-3, 10e-3};
  const double bad[] = {-1e-9, 10.001e-3, (double)NAN, (double)INFINITY};
  ethd_vec c = {7, 7};
  ck_assert(ethd__nail_centre(&nail, 4e-3, &c));
  ck_assert(c.x == 0 && fabs(c.y - 1e-3) < 1e-18);
  ck_assert_double_eq_tol(ethd__nail_distance(&nail, (ethd_vec){3e-3, 1e-3}), 4e-3, 1e-18);
  for (int i = 0; i < 4; i++) ck_assert(!ethd__nail_centre(&nail, bad[i], &c));
}
