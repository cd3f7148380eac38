/* Kalman filters of position, velocity and acceleration, with one covariance for all axes. cv is the same filter with
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

/* Indices of the covariances of position and of velocity with all three. */
static const int covariances[2][3] = {{XX, XV, XA}, {XV, VV, VA}};

/* Computes gains and covariance of one axis for a measurement of its state `o`: 0 is the position, 1 the velocity.
   `square` is the squared innovation of all axes together. */
static inline bool measure(double p[6], int o, double square, double noise, double gate, double k[3]) {
  const int *c = covariances[o], own = c[o], first = c[1 - o], last = c[2];
  double variance = p[own] + noise * noise;
  if (!(square <= gate * gate * variance)) return false;
  for (int i = 0; i < 3; i++) k[i] = p[c[i]] / variance;
  double left = noise * noise / variance;
  p[o ? XX : VV] -= k[1 - o] * p[first];
  p[o ? XA : VA] -= k[1 - o] * p[last];
  p[AA] -= k[2] * p[last];
  p[own] *= left;
  p[first] *= left;
  p[last] *= left;
  return true;
}

bool ethd__filter_gains(ethd_filter_state *s, double square, double noise, double gate, double k[3]) {
  return measure(s->cov, 0, square, noise, gate, k);
}

bool ethd__filter_v_gains(ethd_filter_state *s, double square, double noise, double gate, double k[3]) {
  return measure(s->cov, 1, square, noise, gate, k);
}
