#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ethd/maths.h"
#include "svg/svg_parts.h"

#define SAME 1e-9 /* m: nearer points are one */
#define QUARTER 1.57079632679489661923

static bool fail(ethd__drawing *d, ethd_status status) {
  if (!d->status) d->status = status;
  return false;
}

/* Makes room for one more item. */
static bool grow(ethd__drawing *d, void *array, size_t count, size_t *room, size_t size) {
  void *old, *more;
  if (d->status) return false;
  if (count < *room) return true;
  memcpy(&old, array, sizeof old);
  size_t wanted = *room ? 2 * *room : 256;
  more = realloc(old, wanted * size);
  if (!more) return fail(d, ETHD_E_MEMORY);
  memcpy(array, &more, sizeof more);
  *room = wanted;
  return true;
}

static void put(ethd__drawing *d, double v) {
  if (d->number_count >= 2 * (size_t)ETHD_SVG_POINTS_MAX) fail(d, ETHD_E_FULL);
  if (grow(d, &d->numbers, d->number_count, &d->number_room, sizeof *d->numbers)) d->numbers[d->number_count++] = v;
}

/* Makes an object of all numbers since `chain`. */
static void finish(ethd__drawing *d, ethd_shape shape) {
  if (grow(d, &d->objects, d->object_count, &d->object_room, sizeof *d->objects))
    d->objects[d->object_count++] = (ethd__drawn){shape, d->chain, d->number_count - d->chain, d->line};
  d->chain = d->number_count;
}

void ethd__draw_object(ethd__drawing *d, ethd_shape shape, const double *numbers, size_t count) {
  for (size_t i = 0; i < count; i++) put(d, numbers[i]);
  finish(d, shape);
}

/* ---- chains ---- */

static bool same(const double *a, const double *b) { return fabs(a[0] - b[0]) <= SAME && fabs(a[1] - b[1]) <= SAME; }

void ethd__draw_point(ethd__drawing *d, ethd_vec p) {
  double at[2] = {p.x, p.y};
  if (d->number_count > d->chain && same(at, d->numbers + d->number_count - 2)) return;
  put(d, p.x);
  put(d, p.y);
}

void ethd__draw_end(ethd__drawing *d, bool closed, bool filled) {
  if (d->status) return;
  if (d->number_count == d->chain) { /* no point at all: there may be no memory yet */
    d->blank++;
    return;
  }
  const double *first = d->numbers + d->chain;
  while (closed && d->number_count > d->chain + 2 && same(first, d->numbers + d->number_count - 2))
    d->number_count -= 2;
  size_t points = (d->number_count - d->chain) / 2;
  if (points < 2) {
    d->number_count = d->chain;
    d->blank++;
  } else if (points == 2) {
    finish(d, ETHD_SHAPE_SEGMENT);
  } else if (closed && filled) {
    finish(d, ETHD_SHAPE_POLYGON);
  } else {
    double x = first[0], y = first[1];
    if (closed) put(d, x), put(d, y);
    finish(d, ETHD_SHAPE_POLYLINE);
  }
}

/* ---- curves ---- */

/* Turns a bound, which may be any number, into a whole number of edges. */
static int edges(ethd__drawing *d, double n) {
  if (n <= ETHD_SVG_POINTS_MAX) return n > 1 ? (int)ceil(n) : 1;
  fail(d, ETHD_E_FULL);
  return 1;
}

/* Returns how many edges a curve needs. An edge over 1/n of the parameter is at most max|P''| / 8 n^2 away, and |P''|
   is at most degree (degree - 1) times the largest second difference of the points (Wang 1984). */
static int edges_of_curve(ethd__drawing *d, const ethd_vec *p, int degree) {
  double most = 0;
  for (int i = 0; i + 2 <= degree; i++)
    most = fmax(most,
                ethd_vec_norm((ethd_vec){p[i].x - 2 * p[i + 1].x + p[i + 2].x, p[i].y - 2 * p[i + 1].y + p[i + 2].y}));
  return edges(d, sqrt(degree * (degree - 1) * most / (8 * d->tolerance)));
}

static ethd_vec between(ethd_vec a, ethd_vec b, double t) {
  return (ethd_vec){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
}

/* Evaluates a curve by de Casteljau's algorithm. */
static ethd_vec at(const ethd_vec *p, int degree, double t) {
  ethd_vec q[4];
  memcpy(q, p, ((size_t)degree + 1) * sizeof *p);
  for (int k = degree; k > 0; k--)
    for (int i = 0; i < k; i++) q[i] = between(q[i], q[i + 1], t);
  return q[0];
}

void ethd__draw_curve(ethd__drawing *d, const ethd_vec *p, int degree) {
  int n = edges_of_curve(d, p, degree);
  for (int k = 1; k < n && !d->status; k++) ethd__draw_point(d, at(p, degree, (double)k / n));
  ethd__draw_point(d, p[degree]);
}

/* |P''| is at most the longer half axis, which is at most the root of u.u + v.v. A quarter has at least two edges. */
void ethd__draw_arc(ethd__drawing *d, ethd_vec centre, ethd_vec u, ethd_vec v, double from, double turn) {
  double axis = sqrt(ethd_vec_dot(u, u) + ethd_vec_dot(v, v)), most = fabs(turn);
  double step = fmin(sqrt(8 * d->tolerance / axis), QUARTER / 2);
  int n = edges(d, most / step);
  for (int k = 0; k < n && !d->status; k++) {
    double c, s;
    ethd_sincos(from + turn * k / n, &s, &c);
    ethd__draw_point(d, ethd_vec_add(centre, ethd_vec_add(ethd_vec_scale(c, u), ethd_vec_scale(s, v))));
  }
}
