/* Circles through points: least squares of |p - c|^2 - R^2, radius sought or known.

   All results follow from the moments of u = p - origin. They take one pass over the points; after that each step is
   cheap, since moving the origin by s doesn't need the points:

     sum |u - s|^2 (u - s) = sum |u|^2 u - 2 sum u u^T s + |s|^2 sum u - s sum |u - s|^2            */
#include <math.h>
#include <string.h>

#include "estimate/fit_methods.h"

#define SHORT 1e-4 /* squared step over squared radius at which a fit ends: an error of 1/20000 of the radius remains */
#define FLAT 1e-9  /* determinant over squared trace under which the points count as on one line */

typedef struct moments {
  double n, x, y, xx, xy, yy, zx, zy; /* z = |u|^2 */
} moments;

static inline void shift(moments *m, ethd_vec s) {
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

/* Solves sum u u^T s = (g, h) for s; returns false if the points lie on one line or are fewer than two. */
static inline bool solve(const moments *m, double g, double h, ethd_vec *s) {
  double det = m->xx * m->yy - m->xy * m->xy, trace = m->xx + m->yy;
  if (!(det > FLAT * trace * trace)) return false;
  s->x = (m->yy * g - m->xy * h) / det;
  s->y = (m->xx * h - m->xy * g) / det;
  return true;
}

/* Returns the moments of the points that count, about `origin`. */
static inline moments of(const ethd__points *points, ethd_vec origin) {
  two x = {0, 0}, y = x, xx = x, xy = x, yy = x, zx = x, zy = x;
  for (int i = 0; i < ETHD__PAIRS; i++) {
    two u = two_where(points->counts[i], points->x[i] - origin.x);
    two v = two_where(points->counts[i], points->y[i] - origin.y);
    two uu = u * u, vv = v * v, z = uu + vv;
    x += u;
    y += v;
    xx += uu;
    xy += u * v;
    yy += vv;
    zx += z * u;
    zy += z * v;
  }
  return (moments){ethd__count(points->used),
                   two_sum(x),
                   two_sum(y),
                   two_sum(xx),
                   two_sum(xy),
                   two_sum(yy),
                   two_sum(zx),
                   two_sum(zy)};
}

/* Fits Kasa's circle and moves the moments to its centre. About the mean the linear terms vanish, which separates the
   centre from the radius:
     sum u u^T s = 1/2 sum |u|^2 u;   R^2 is then the mean of |p - c|^2. */
static inline bool kasa(moments *m, ethd_vec *centre) {
  ethd_vec mean = {m->x / m->n, m->y / m->n}, s;
  shift(m, mean);
  if (!solve(m, m->zx / 2, m->zy / 2, &s)) return false;
  *centre = ethd_vec_add(mean, s);
  shift(m, s);
  return true;
}

bool ethd__fit_kasa(const ethd__points *points, ethd_vec *centre) {
  moments m = of(points, (ethd_vec){0, 0});
  return kasa(&m, centre);
}

/* Takes a Gauss-Newton step from the moments' origin: sum u u^T s = 1/2 sum (|u|^2 - R^2) u. */
static inline bool step(moments *m, double radius, ethd_vec *centre, double *moved) {
  ethd_vec s;
  double square = radius * radius;
  if (!solve(m, (m->zx - square * m->x) / 2, (m->zy - square * m->y) / 2, &s)) return false;
  *centre = ethd_vec_add(*centre, s);
  *moved = ethd_vec_dot(s, s);
  shift(m, s);
  return true;
}

/* Returns the gate for |u|^2 - R^2; divided by 2 R this is nearly |u| - R, to which the parameter applies. */
static inline double gate(const ethd_fit *fit) { return 2 * fit->finger_radius * fit->p[ROBUST_GATE]; }

/* Adds a point to the moments, or with sign -1 takes it out. */
static inline void add(moments *m, double sign, ethd_vec u) {
  double z = ethd_vec_dot(u, u), x = sign * u.x, y = sign * u.y;
  m->n += sign;
  m->x += x;
  m->y += y;
  m->xx += x * u.x;
  m->xy += x * u.y;
  m->yy += y * u.y;
  m->zx += z * x;
  m->zy += z * y;
}

/* Chooses again, among the rays `there`, those within the gate; returns false if the choice is unchanged. If one point
   was added or removed, it updates the moments about the centre, else it sums all again. */
static inline bool choose(const ethd_fit *fit, const two_bits there[ETHD__PAIRS], ethd__points *points, ethd_vec centre,
                          moments *m) {
  double square = fit->finger_radius * fit->finger_radius, most = gate(fit);
  uint32_t before = points->used;
  for (int i = 0; i < ETHD__PAIRS; i++) {
    two u = points->x[i] - centre.x, v = points->y[i] - centre.y;
    points->counts[i] = there[i] & (two_bits)(two_abs(u * u + v * v - square) <= most);
  }
  points->used = ethd__points_used(points->counts);
  uint32_t changed = before ^ points->used;
  if (!changed) return false;
  if ((changed & (changed - 1)) == 0)
    add(m, points->used > before ? 1 : -1, ethd_vec_sub(ethd__point(points, __builtin_ctz(changed)), centre));
  else
    *m = of(points, centre);
  return true;
}

/* Starts from Kasa's circle if it can be the finger: within the ring, and of the right radius to within the gate. Few
   rays or an outlier may give another circle; then the start is a step from the ring's centre, which is never far from
   the finger. */
static inline bool start(const ethd_fit *fit, const ethd__points *points, moments *m, ethd_vec *centre) {
  moments all = of(points, (ethd_vec){0, 0});
  double square = fit->finger_radius * fit->finger_radius, gap = fit->ring_radius - fit->finger_radius;
  *m = all;
  if (kasa(m, centre) && fabs(m->xx + m->yy - square * m->n) <= gate(fit) * m->n &&
      ethd_vec_dot(*centre, *centre) <= gap * gap)
    return true;
  double moved;
  *m = all;
  *centre = (ethd_vec){0, 0};
  return step(m, fit->finger_radius, centre, &moved);
}

/* The first step uses all points, so that a start disturbed by an outlier doesn't gate good points. A step s leaves an
   error of about |s|^2 / 2 R, so a short step with the same points is the last. */
bool ethd__fit_robust(const ethd_fit *fit, ethd__points *points, ethd_vec *centre) {
  two_bits there[ETHD__PAIRS];
  double radius = fit->finger_radius, moved = 0;
  moments m;
  memcpy(there, points->counts, sizeof there);
  bool found = start(fit, points, &m, centre) && step(&m, radius, centre, &moved);
  for (int pass = 0; pass < 2 && found; pass++) {
    if (!choose(fit, there, points, *centre, &m) && moved <= SHORT * radius * radius) break;
    found = step(&m, radius, centre, &moved);
  }
  return found;
}
