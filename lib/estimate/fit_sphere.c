/* A sphere through the ends of rays: Gauss-Newton in its centre and, if sought, its radius.

   Ray k meets the sphere at the distance rho = -w.d - sqrt(R^2 - |w x d|^2), w = from - c. There the normal is n, and

     d rho = (n . dc + dR) / (n . d),   n . d = -sqrt(R^2 - |w x d|^2) / R < 0                                   */
#include "estimate/fit_sphere.h"

#include <math.h>
#include <string.h>

#include "fp_mode.h"

#define FLAT 1e-6          /* pivot over trace under which the rays don't determine the finger */
#define STEEPEST (-1. / 3) /* n . d over which a ray grazes the finger */
#define FIRST 2            /* steps with all rays */
#define CHOICES 6          /* first steps, before each of which the rays are chosen again */
#define STEPS 16           /* at most, the first ones included */
#define SETTLED 1e-10      /* m: the last step's length; the remaining error is about a hundredth of it */

/* ---- normal equations ---- */

void ethd__normal_add(ethd__normal *m, const double g[4], double e) {
  for (int i = 0; i < m->n; i++) {
    for (int j = 0; j <= i; j++) m->h[i][j] += g[i] * g[j];
    m->b[i] += g[i] * e;
  }
}

bool ethd__normal_factorise(ethd__normal *m) {
  double trace = 0;
  for (int i = 0; i < m->n; i++) trace += m->h[i][i];
  for (int j = 0; j < m->n; j++) {
    for (int k = 0; k < j; k++) m->h[j][j] -= m->h[j][k] * m->h[j][k] * m->h[k][k];
    if (!(m->h[j][j] > FLAT * trace)) return false;
    for (int i = j + 1; i < m->n; i++) {
      for (int k = 0; k < j; k++) m->h[i][j] -= m->h[i][k] * m->h[j][k] * m->h[k][k];
      m->h[i][j] /= m->h[j][j];
    }
  }
  return true;
}

/* Solves L D L^T s = b in place of b. */
static void solve(ethd__normal *m) {
  for (int i = 0; i < m->n; i++)
    for (int k = 0; k < i; k++) m->b[i] -= m->h[i][k] * m->b[k];
  for (int i = m->n - 1; i >= 0; i--) {
    m->b[i] /= m->h[i][i];
    for (int k = i + 1; k < m->n; k++) m->b[i] -= m->h[k][i] * m->b[k];
  }
}

/* ---- a ray and a sphere ---- */

typedef struct sphere {
  ethd_vec3 c;
  double radius;
} sphere;

/* The intersection of a ray and a sphere. */
typedef struct meeting {
  double rho, slope; /* m; n . d */
  ethd_vec3 n;
} meeting;

/* false: it misses the sphere. */
static bool meet(const ethd_cap_ray *ray, const sphere *s, meeting *out) {
  const ethd_vec3 w = ethd_vec3_sub(ray->from, s->c), across = ethd_vec3_cross(w, ray->along);
  const double left = s->radius * s->radius - ethd_vec3_dot(across, across);
  if (!(left >= 0)) return false;
  const double depth = sqrt(left);
  out->rho = -ethd_vec3_dot(w, ray->along) - depth;
  out->slope = -depth / s->radius;
  out->n = ethd_vec3_scale(1 / s->radius, ethd_vec3_add(w, ethd_vec3_scale(out->rho, ray->along)));
  return true;
}

/* Gives a ray's intersection; false: it misses the sphere or grazes it. */
static bool meets_well(const ethd_cap_ray *ray, const sphere *s, meeting *out) {
  return meet(ray, s, out) && out->slope < STEEPEST;
}

static void add_meeting(ethd__normal *m, const meeting *at, double e) {
  const double w = 1 / at->slope, g[4] = {w * at->n.x, w * at->n.y, w * at->n.z, w};
  ethd__normal_add(m, g, e);
}

/* ---- the fit ---- */

static ethd__normal nothing(const ethd_cap *cap) {
  ethd__normal m;
  memset(&m, 0, sizeof m);
  m.n = cap->seeks_radius ? 4 : 3;
  return m;
}

static ethd_vec3 end_of(const ethd_cap_ray *ray, double r) {
  return ethd_vec3_add(ray->from, ethd_vec3_scale(r, ray->along));
}

/* Solves the normal equations and moves the sphere, at most by half its radius; false: they don't determine a step, or
   no finger has such a radius. */
static bool step(const ethd_cap *cap, ethd__normal *m, sphere *s, double *moved) {
  if (!ethd__normal_factorise(m)) return false;
  solve(m);
  const ethd_vec3 by = ethd_vec3_of(m->b);
  const double length = sqrt(ethd_vec3_dot(by, by) + m->b[3] * m->b[3]), most = s->radius / 2;
  const double share = length > most ? most / length : 1;
  s->c = ethd_vec3_add(s->c, ethd_vec3_scale(share, by));
  s->radius += share * m->b[3];
  *moved = length;
  return s->radius > cap->finger_radius / 4 && s->radius < cap->finger_radius * 4;
}

/* Takes steps for the sum of (|p - c| - R)^2, which exists for any point. */
static bool first_steps(const ethd_cap *cap, const double *r, uint32_t there, sphere *s) {
  double moved;
  for (int pass = 0; pass < FIRST; pass++) {
    ethd__normal m = nothing(cap);
    for (uint32_t k = 0; k < cap->count; k++) {
      if (!(there >> k & 1)) continue;
      const ethd_vec3 u = ethd_vec3_sub(end_of(&cap->rays[k], r[k]), s->c);
      const double length = ethd_vec3_norm(u);
      if (!(length > 0)) continue; /* a point in the centre has no direction */
      const double g[4] = {u.x / length, u.y / length, u.z / length, 1};
      ethd__normal_add(&m, g, length - s->radius);
    }
    if (!step(cap, &m, s, &moved)) return false;
  }
  return true;
}

static int bits(uint32_t set) {
  int n = 0;
  for (; set; set &= set - 1) n++;
  return n;
}

/* Returns which of the rays that are `there` meet the sphere well and within the gate. */
static uint32_t choose(const ethd_cap *cap, const double *r, uint32_t there, const sphere *s) {
  uint32_t used = 0;
  meeting at;
  for (uint32_t k = 0; k < cap->count; k++)
    if (there >> k & 1 && meets_well(&cap->rays[k], s, &at) && fabs(r[k] - at.rho) <= cap->gate) used |= 1u << k;
  return used;
}

/* If a ray of a fixed choice no longer meets the sphere, it has no residual, and the fit fails. A fit of fewer than
   half of the rays fails too, since the others could agree on another finger. */
static bool later_steps(const ethd_cap *cap, const double *r, uint32_t there, sphere *s, uint32_t *used) {
  uint32_t before = 0;
  for (int pass = FIRST; pass < STEPS; pass++) {
    ethd__normal m = nothing(cap);
    double moved;
    meeting at;
    if (pass < FIRST + CHOICES) *used = choose(cap, r, there, s);
    for (uint32_t k = 0; k < cap->count; k++) {
      if (!(*used >> k & 1)) continue;
      if (!meets_well(&cap->rays[k], s, &at)) return false;
      add_meeting(&m, &at, r[k] - at.rho);
    }
    if (!step(cap, &m, s, &moved)) return false;
    if (*used == before && moved <= SETTLED) return 2 * bits(*used) >= bits(there);
    before = *used;
  }
  return false;
}

/* Starts from the mean of the centres that each ray would give if it met the finger at right angles. */
static bool start(const ethd_cap *cap, const double *r, uint32_t *there, sphere *s) {
  ethd_vec3 sum = {0, 0, 0};
  *there = 0;
  for (uint32_t k = 0; k < cap->count; k++) {
    if (!(fabs(r[k]) < cap->reach)) continue;
    *there |= 1u << k;
    sum = ethd_vec3_add(sum, end_of(&cap->rays[k], r[k] + cap->finger_radius));
  }
  const int n = bits(*there);
  if (n < (cap->seeks_radius ? 4 : 3)) return false;
  *s = (sphere){ethd_vec3_scale(1. / n, sum), cap->finger_radius};
  return true;
}

static void describe(const ethd_cap *cap, const double *r, const sphere *s, uint32_t used, ethd_cap_finger *out) {
  double squares = 0, off = 0, n = 0;
  meeting at;
  for (uint32_t k = 0; k < cap->count; k++) {
    if (!(used >> k & 1) || !meet(&cap->rays[k], s, &at)) continue;
    const ethd_vec3 u = ethd_vec3_sub(end_of(&cap->rays[k], r[k]), s->c);
    squares += ethd_vec3_dot(u, u);
    off += (r[k] - at.rho) * (r[k] - at.rho);
    n++;
  }
  out->centre = s->c;
  out->radius = cap->seeks_radius ? s->radius : sqrt(squares / n);
  out->residual = sqrt(off / n);
  out->used = used;
  out->gone = !(ethd_vec3_dot(ethd_vec3_sub(s->c, cap->rim), cap->out) <= cap->rim_margin);
}

ETHD__FP_APART static ethd_status cap_step(const ethd_cap *cap, const double *r, ethd_cap_finger *out) {
  sphere s;
  uint32_t there, used = 0;
  if (!start(cap, r, &there, &s) || !first_steps(cap, r, there, &s) || !later_steps(cap, r, there, &s, &used))
    return ETHD_STATUS_STALE;
  describe(cap, r, &s, used, out);
  return ETHD_OK;
}

ethd_status ethd_cap_step(const ethd_cap *cap, const double *r, ethd_cap_finger *out) {
  ETHD__FP_RETURN(ethd_status, cap_step(cap, r, out));
}

/* ---- the inverse, and the bound of the fit ---- */

ETHD__FP_APART static void cap_rays(const ethd_cap *cap, const sphere *s, double *r) {
  meeting at;
  for (uint32_t k = 0; k < cap->count; k++) r[k] = meet(&cap->rays[k], s, &at) ? at.rho : (double)NAN;
}

void ethd_cap_rays(const ethd_cap *cap, ethd_vec3 centre, double radius, double *r) {
  const uint64_t callers = ethd__fp_take();
  const sphere s = {centre, radius};
  cap_rays(cap, &s, r);
  ethd__fp_give(callers);
}

ETHD__FP_APART static ethd_status cap_bound(const ethd_cap *cap, ethd_vec3 centre, double noise, ethd_vec3 *sd) {
  const sphere s = {centre, cap->finger_radius};
  ethd__normal m = nothing(cap);
  double out[3];
  meeting at;
  for (uint32_t k = 0; k < cap->count; k++)
    if (meets_well(&cap->rays[k], &s, &at) && fabs(at.rho) < cap->reach) add_meeting(&m, &at, 0);
  if (!ethd__normal_factorise(&m)) return ETHD_STATUS_STALE;
  for (int i = 0; i < 3; i++) {
    memset(m.b, 0, sizeof m.b);
    m.b[i] = 1;
    solve(&m);
    out[i] = noise * sqrt(m.b[i]);
  }
  *sd = ethd_vec3_of(out);
  return ETHD_OK;
}

ethd_status ethd_cap_bound(const ethd_cap *cap, ethd_vec3 centre, double noise, ethd_vec3 *sd) {
  ETHD__FP_RETURN(ethd_status, cap_bound(cap, centre, noise, sd));
}
