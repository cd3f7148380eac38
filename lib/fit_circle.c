/* Circles through points: least squares of |p - c|^2 - R^2, radius sought or known.

   All of it stands in the moments of u = p - origin: one pass over the points, then any number of
   steps, for a shift of the origin by s needs the moments only:

     sum |u - s|^2 (u - s) = sum |u|^2 u - 2 sum u u^T s + |s|^2 sum u - s sum |u - s|^2            */
#include <math.h>

#include "fit_methods.h"

#define FLAT 1e-9 /* determinant over squared trace under which points count as collinear */

typedef struct moments {
  double n, x, y, xx, xy, yy, zx, zy; /* z = |u|^2 */
} moments;

static void add(moments *m, ethd_vec u) {
  double z = ethd_vec_dot(u, u);
  m->n += 1;
  m->x += u.x;
  m->y += u.y;
  m->xx += u.x * u.x;
  m->xy += u.x * u.y;
  m->yy += u.y * u.y;
  m->zx += z * u.x;
  m->zy += z * u.y;
}

static void shift(moments *m, ethd_vec s) {
  moments o = *m;
  double ss = ethd_vec_dot(s, s);
  m->x = o.x - o.n * s.x;
  m->y = o.y - o.n * s.y;
  m->xx = o.xx - (o.x + m->x) * s.x;
  m->xy = o.xy - o.x * s.y - m->y * s.x;
  m->yy = o.yy - (o.y + m->y) * s.y;
  double z = m->xx + m->yy;
  m->zx = o.zx - 2 * (o.xx * s.x + o.xy * s.y) + ss * o.x - s.x * z;
  m->zy = o.zy - 2 * (o.xy * s.x + o.yy * s.y) + ss * o.y - s.y * z;
}

/* sum u u^T s = (g, h); 0 for points on one line, and for fewer than two. */
static int solve(const moments *m, double g, double h, ethd_vec *s) {
  double det = m->xx * m->yy - m->xy * m->xy, trace = m->xx + m->yy;
  if (!(det > FLAT * trace * trace)) return 0;
  s->x = (m->yy * g - m->xy * h) / det;
  s->y = (m->xx * h - m->xy * g) / det;
  return 1;
}

static moments of_all(const ethd__points *points) {
  moments m = {0};
  for (uint32_t i = 0; i < points->count; i++) add(&m, points->p[i]);
  return m;
}

/* About the mean the linear terms vanish, so that the centre parts from the radius:
     sum u u^T s = 1/2 sum |u|^2 u;   R^2 is then the mean of |p - c|^2.
   The moments move to the centre. */
static int kasa(moments *m, ethd_vec *centre) {
  ethd_vec mean = {m->x / m->n, m->y / m->n}, s;
  shift(m, mean);
  if (!solve(m, m->zx / 2, m->zy / 2, &s)) return 0;
  *centre = ethd_vec_add(mean, s);
  shift(m, s);
  return 1;
}

int ethd__fit_kasa(const ethd__points *points, ethd_vec *centre) {
  moments m = of_all(points);
  return kasa(&m, centre);
}

/* Gauss-Newton from the moments' origin: sum u u^T s = 1/2 sum (|u|^2 - R^2) u. */
static int step(moments *m, double radius, ethd_vec *centre) {
  ethd_vec s;
  double square = radius * radius;
  if (!solve(m, (m->zx - square * m->x) / 2, (m->zy - square * m->y) / 2, &s)) return 0;
  *centre = ethd_vec_add(*centre, s);
  shift(m, s);
  return 1;
}

/* (|u|^2 - R^2) / (2 R) is |u| - R nearly. */
static int is_near(const ethd_fit *fit, double square) {
  double radius = fit->finger_radius;
  return fabs(square - radius * radius) <= 2 * radius * fit->p[ROBUST_GATE];
}

/* Moments about the centre of the points within the gate. */
static moments of_near(const ethd_fit *fit, ethd__points *points, ethd_vec centre) {
  moments m = {0};
  points->used = 0;
  for (uint32_t i = 0; i < points->count; i++) {
    ethd_vec u = ethd_vec_sub(points->p[i], centre);
    if (!is_near(fit, ethd_vec_dot(u, u))) continue;
    add(&m, u);
    points->used |= 1u << points->ray[i];
  }
  return m;
}

/* Kasa's centre is a start if it is a finger's: within the ring, the radius within the gate. Few rays or
   an outlier make others; the ring's middle is never far. */
static moments start(const ethd_fit *fit, const ethd__points *points, ethd_vec *centre) {
  moments all = of_all(points), m = all;
  if (kasa(&m, centre) && is_near(fit, (m.xx + m.yy) / m.n) &&
      ethd_vec_norm(*centre) <= fit->ring_radius - fit->finger_radius)
    return m;
  *centre = (ethd_vec){0, 0};
  return all;
}

/* Two steps with all points first, so that an outlier's pull on the start doesn't gate good ones. */
int ethd__fit_robust(const ethd_fit *fit, ethd__points *points, ethd_vec *centre) {
  double radius = fit->finger_radius;
  moments m = start(fit, points, centre);
  int found = step(&m, radius, centre) && step(&m, radius, centre);
  for (int pass = 0; pass < 2 && found; pass++) {
    m = of_near(fit, points, *centre);
    found = step(&m, radius, centre);
  }
  return found;
}
