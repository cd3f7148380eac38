/* Kalman filters of position, velocity and acceleration, with one covariance for both axes. cv is the same filter with
   an acceleration that is known to be 0. P = [xx xv xa; . vv va; . . aa], z = x + noise. */
#include "estimate/filter_methods.h"

enum { XX, XV, XA, VV, VA, AA };

/* P <- F P F^T + g g^T,  F = [1 t ax; 0 1 av; 0 0 aa]. */
void ethd__filter_spread(const ethd_filter *f, ethd_filter_state *s, ethd__filter_motion w) {
  double t = w.t, h = t * t / 2, drive = f->p[FILTER_DRIVE], *p = s->cov;
  bool jerk = f->method == ETHD_FILTER_CA;
  double gx = drive * (jerk ? h * t / 3 : h), gv = drive * (jerk ? h : t), ga = jerk ? drive * t : 0;
  double x = p[XX] + t * p[XV] + w.ax * p[XA], xv = p[XV] + t * p[VV] + w.ax * p[VA];
  double xa = p[XA] + t * p[VA] + w.ax * p[AA];
  double v = p[VV] + w.av * p[VA], va = p[VA] + w.av * p[AA];
  p[XX] = x + t * xv + w.ax * xa + gx * gx;
  p[XV] = xv + w.av * xa + gx * gv;
  p[XA] = w.aa * xa + gx * ga;
  p[VV] = v + w.av * va + gv * gv;
  p[VA] = w.aa * va + gv * ga;
  p[AA] = w.aa * w.aa * p[AA] + ga * ga;
}

bool ethd__filter_correct(const ethd_filter *f, ethd_filter_state *s, ethd_vec r, double noise) {
  double gate = f->p[FILTER_GATE], *p = s->cov;
  double variance = p[XX] + noise * noise;
  if (!(ethd_vec_dot(r, r) <= gate * gate * variance)) return false;
  double kx = p[XX] / variance, kv = p[XV] / variance, ka = p[XA] / variance;
  double left = noise * noise / variance, axis[2] = {r.x, r.y};
  for (int i = 0; i < 2; i++) {
    s->x[i] += kx * axis[i];
    s->v[i] += kv * axis[i];
    s->a[i] += ka * axis[i];
  }
  p[VV] -= kv * p[XV];
  p[VA] -= kv * p[XA];
  p[AA] -= ka * p[XA];
  p[XX] *= left;
  p[XV] *= left;
  p[XA] *= left;
  return true;
}
