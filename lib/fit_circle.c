/* Circles through points: algebraic least squares of |p - c|^2 - R^2, radius sought or known. */
#include <math.h>

#include "fit_methods.h"

#define FLAT 1e-9 /* determinant over squared trace under which points count as collinear */

/* a b | g  symmetric: [a b; b d] x = (g, h); 0 where it is singular. */
typedef struct normal {
  double a, b, d, g, h;
} normal;

static void normal_add(normal *m, ethd_vec n, double value) {
  m->a += n.x * n.x;
  m->b += n.x * n.y;
  m->d += n.y * n.y;
  m->g += n.x * value;
  m->h += n.y * value;
}

static int normal_solve(const normal *m, ethd_vec *out) {
  double det = m->a * m->d - m->b * m->b, trace = m->a + m->d;
  if (!(det > FLAT * trace * trace)) return 0;
  out->x = (m->d * m->g - m->b * m->h) / det;
  out->y = (m->a * m->h - m->b * m->g) / det;
  return 1;
}

/* About the points' mean the linear terms vanish, so centre and radius part:
     sum u u^T c = 1/2 sum |u|^2 u,   R^2 = |c|^2 + mean |u|^2.                                     */
int ethd__fit_kasa(const ethd__points *points, ethd_vec *centre, double *radius) {
  ethd_vec mean = {0, 0}, offset;
  normal m = {0, 0, 0, 0, 0};
  if (points->count < 3) return 0;
  for (uint32_t i = 0; i < points->count; i++) mean = ethd_vec_add(mean, points->p[i]);
  mean = ethd_vec_scale(1.0 / points->count, mean);
  for (uint32_t i = 0; i < points->count; i++) {
    ethd_vec u = ethd_vec_sub(points->p[i], mean);
    normal_add(&m, u, ethd_vec_dot(u, u) / 2);
  }
  if (!normal_solve(&m, &offset)) return 0;
  *centre = ethd_vec_add(mean, offset);
  *radius = sqrt(ethd_vec_dot(offset, offset) + (m.a + m.d) / points->count);
  return 1;
}

/* A finger of the known radius stands within the ring; a start that says otherwise is none. */
static ethd_vec start(const ethd_fit *fit, const ethd__points *points) {
  ethd_vec centre, middle = {0, 0};
  double radius;
  if (!ethd__fit_kasa(points, &centre, &radius)) return middle;
  return ethd_vec_norm(centre) <= fit->ring_radius - fit->finger_radius ? centre : middle;
}

/* Gauss-Newton on (|p - c|^2 - R^2) / (2 R), which is |p - c| - R to first order. */
static int improve(const ethd_fit *fit, ethd__points *points, double gate, ethd_vec *centre) {
  double radius = fit->finger_radius;
  normal m = {0, 0, 0, 0, 0};
  ethd_vec step;
  points->used = 0;
  for (uint32_t i = 0; i < points->count; i++) {
    ethd_vec u = ethd_vec_sub(points->p[i], *centre);
    double residual = (ethd_vec_dot(u, u) - radius * radius) / (2 * radius);
    if (!(fabs(residual) <= gate)) continue;
    normal_add(&m, u, residual);
    points->used |= 1u << points->ray[i];
  }
  if (!normal_solve(&m, &step)) return 0;
  *centre = ethd_vec_add(*centre, ethd_vec_scale(radius, step));
  return 1;
}

/* Two steps with all points, so that an outlier's pull on the start doesn't gate good ones; then two
   with the gate. */
int ethd__fit_robust(const ethd_fit *fit, ethd__points *points, ethd_vec *centre) {
  double gate = fit->p[ROBUST_GATE];
  *centre = start(fit, points);
  return improve(fit, points, INFINITY, centre) && improve(fit, points, INFINITY, centre) &&
         improve(fit, points, gate, centre) && improve(fit, points, gate, centre);
}
