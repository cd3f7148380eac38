/* Simple polygons against a check of every pair of edges in whole numbers, and exact orientation. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "scene/check.h"
#include "scene/scene.h"
#include "unit/draw.h"
#include "unit/suite.h"

static uint64_t drawn;

static uint64_t any(void) { return draw_bits(drawn++); }

static long area(const long *a, const long *b, const long *c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static int within(const long *a, const long *b, const long *p) {
  return p[0] >= (a[0] < b[0] ? a[0] : b[0]) && p[0] <= (a[0] > b[0] ? a[0] : b[0]) &&
         p[1] >= (a[1] < b[1] ? a[1] : b[1]) && p[1] <= (a[1] > b[1] ? a[1] : b[1]);
}

static int on(const long *a, const long *b, const long *p) { return area(a, b, p) == 0 && within(a, b, p); }

static int meet_anywhere(const long *a, const long *b, const long *c, const long *d) {
  long p = area(a, b, c), q = area(a, b, d), r = area(c, d, a), s = area(c, d, b);
  if (((p > 0 && q < 0) || (p < 0 && q > 0)) && ((r > 0 && s < 0) || (r < 0 && s > 0))) return 1;
  return on(a, b, c) || on(a, b, d) || on(c, d, a) || on(c, d, b);
}

/* Neighbours may share their one point and no other: neither far end lies on the other edge. */
static int meet_wrongly(const long (*p)[2], size_t n, size_t i, size_t j) {
  size_t i1 = (i + 1) % n, j1 = (j + 1) % n;
  if (i1 == j) return on(p[i], p[i1], p[j1]) || on(p[j], p[j1], p[i]);
  if (j1 == i) return on(p[j], p[j1], p[i1]) || on(p[i], p[i1], p[j]);
  return meet_anywhere(p[i], p[i1], p[j], p[j1]);
}

static int is_simple_by_pairs(const long (*p)[2], size_t n) {
  for (size_t i = 0; i < n; i++)
    for (size_t j = i + 1; j < n; j++)
      if (meet_wrongly(p, n, i, j)) return 0;
  return 1;
}

TEST(test_grid_polygons) {
  enum { MOST = 9, CASES = 300000 };
  int simple = 0;
  drawn = 1000000;
  for (int c = 0; c < CASES; c++) {
    long p[MOST][2], size = 2 + (long)(any() % 5);
    double points[2 * MOST];
    size_t n = 3 + any() % (MOST - 2), meet[2] = {99, 99};
    int repeats = 0;
    for (size_t k = 0; k < n; k++)
      for (int i = 0; i < 2; i++) points[2 * k + (size_t)i] = (double)(p[k][i] = (long)(any() % (uint64_t)size));
    for (size_t k = 0; k < n; k++) {
      const long *a = p[k], *b = p[(k + 1) % n];
      repeats |= a[0] == b[0] && a[1] == b[1];
    }
    if (repeats) continue; /* refused before the sweep */
    char room[1024];
    ck_assert_uint_le(ethd__simple_room(n), sizeof room);
    int expected = is_simple_by_pairs((const long(*)[2])p, n);
    int found = ethd__is_simple(points, n, (void *)((uintptr_t)(room + 15) & ~(uintptr_t)15), meet);
    ck_assert_msg(found == expected, "case %d: %d, by pairs %d", c, found, expected);
    if (!found) {
      ck_assert_uint_lt(meet[0], n);
      ck_assert_uint_lt(meet[1], n);
      ck_assert_uint_ne(meet[0], meet[1]);
    }
    simple += found;
  }
  ck_assert_int_gt(simple, CASES / 100);
}

/* A star of n rays about the origin is simple; with two points swapped it isn't. */
TEST(test_large_polygon) {
  enum { N = 100000 };
  double *points = malloc(2 * N * sizeof *points);
  void *room = malloc(ethd__simple_room(N));
  size_t meet[2];
  drawn = 2000000;
  for (size_t k = 0; k < N; k++) {
    double a = 2 * M_PI * (double)k / N, r = k % 2 ? 1e-3 : 0.5 + (double)(any() % 1000) / 1000;
    points[2 * k] = r * cos(a);
    points[2 * k + 1] = r * sin(a);
  }
  ck_assert(ethd__is_simple(points, N, room, meet));
  for (int i = 0; i < 2; i++) {
    double t = points[2 * 70000 + i];
    points[2 * 70000 + i] = points[2 * 70002 + i];
    points[2 * 70002 + i] = t;
  }
  ck_assert(!ethd__is_simple(points, N, room, meet));
  ck_assert(meet[0] >= 69998 && meet[0] <= 70003 && meet[1] >= 69998 && meet[1] <= 70003);
  free(room);
  free(points);
}

/* A comb whose diagonal teeth have bounds that all overlap. */
TEST(test_diagonal_comb) {
  enum { TEETH = 30000, N = 2 * TEETH + 1 };
  double *points = malloc(2 * N * sizeof *points);
  void *room = malloc(ethd__simple_room(N));
  size_t meet[2];
  for (size_t k = 0; k < TEETH; k++) {
    double x = (double)k / TEETH;
    points[4 * k] = x + 1, points[4 * k + 1] = 1;
    points[4 * k + 2] = x + 0.5 / TEETH, points[4 * k + 3] = 0;
  }
  points[2 * N - 2] = 3, points[2 * N - 1] = 2;
  ck_assert(ethd__is_simple(points, N, room, meet));
  points[4 * 1234 + 2] -= 1e-3, points[4 * 1234 + 3] -= 1e-3; /* one valley deeper: still simple */
  ck_assert(ethd__is_simple(points, N, room, meet));
  points[4 * 1234 + 2] += 2.0 / TEETH; /* and bent across its neighbours */
  ck_assert(!ethd__is_simple(points, N, room, meet));
  free(room);
  free(points);
}

/* a + k (b - a) in steps of powers of two is on the line; an ulp beside it isn't. */
TEST(test_orientation_is_exact) {
  drawn = 3000000;
  for (int c = 0; c < 100000; c++) {
    double ux = (double)(int64_t)(any() >> 20) * 0x1p-44, uy = (double)(int64_t)(any() >> 20) * 0x1p-44;
    ethd_vec a = {0x1p-10 * (double)(int)(any() % 1000), 0}, b = {ux, uy};
    ethd_vec o = {0, 0}, far = {8 * b.x, 8 * b.y};
    ck_assert_int_eq(ethd__orient(o, b, far), 0);
    ck_assert_int_eq(ethd__orient(far, o, b), 0);
    if (!(ux > 0 && uy > 0)) continue;
    ethd_vec above = {far.x, nextafter(far.y, INFINITY)}, below = {far.x, nextafter(far.y, 0)};
    ck_assert_int_eq(ethd__orient(o, b, above), 1);
    ck_assert_int_eq(ethd__orient(o, b, below), -1);
    ck_assert_int_eq(ethd__orient(b, o, above), -1);
    ck_assert_int_eq(ethd__orient(a, b, above), -ethd__orient(b, a, above));
  }
}

/* Whole numbers of 52 bits, nearly on a line, against 128 bits. */
TEST(test_orientation_of_whole_numbers) {
  __extension__ typedef __int128 wide;
  int zeros = 0, others = 0;
  drawn = 4000000;
  for (int c = 0; c < 100000; c++) {
    int64_t ux = (int64_t)(any() % (1 << 24)) - (1 << 23), uy = (int64_t)(any() % (1 << 24)) - (1 << 23);
    int64_t p[3][2];
    for (int k = 0; k < 3; k++) {
      int64_t t = (int64_t)(any() % (1 << 28)) - (1 << 27);
      p[k][0] = t * ux + (int64_t)(any() % 16 == 0);
      p[k][1] = t * uy + (int64_t)(any() % 16 == 0);
    }
    wide l = (wide)(p[1][0] - p[0][0]) * (p[2][1] - p[0][1]), r = (wide)(p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
    int expected = (l > r) - (l < r);
    ethd_vec v[3];
    for (int k = 0; k < 3; k++) v[k] = (ethd_vec){0x1p-40 * (double)p[k][0], 0x1p-40 * (double)p[k][1]};
    ck_assert_int_eq(ethd__orient(v[0], v[1], v[2]), expected);
    zeros += expected == 0;
    others += expected != 0;
  }
  ck_assert(zeros > 10000 && others > 10000);
}

/* Beside the diagonal, in steps of an ulp of 1/2 (Kettner et al. 2008): rounded differences get it wrong. */
TEST(test_orientation_beside_a_diagonal) {
  ethd_vec q = {12, 12}, r = {24, 24};
  for (int i = 0; i < 256; i++)
    for (int j = 0; j < 256; j++) {
      ethd_vec p = {0.5 + i * 0x1p-53, 0.5 + j * 0x1p-53};
      int expected = (p.y > p.x) - (p.y < p.x);
      ck_assert_int_eq(ethd__orient(p, q, r), expected);
      ck_assert_int_eq(ethd__orient(q, r, p), expected);
      ck_assert_int_eq(ethd__orient(r, q, p), -expected);
    }
}
