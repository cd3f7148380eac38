/* RK4 for x'' = f(t, x, x'), with changes of touch located and steps refined where friction turns. */
#include "sim/body.h"

#define LOCATED 1e-12    /* s */
#define TURNING 18e-3    /* m/s: beyond it tanh(v / 3 mm/s) is +-1 within 1e-5 */
#define TURN_STEP 0.6e-3 /* m/s per reference step of 50 us, while friction turns */
#define REFERENCE 50e-6  /* s */
#define REFINED_MAX 64

static void accelerate(const ethd__body *b, const ethd__piece *piece, double t, const ethd__state *s,
                       double *out) {
  ethd__motion hand = ethd__piece_at(piece, t);
  ethd__body_accelerate(b, s->touch, &hand, s->q, s->v, out);
}

/* k1: accelerations at t. */
static void rk4(const ethd__body *b, const ethd__piece *piece, double t, double h, const ethd__state *s,
                const double *k1, ethd__state *out) {
  int n = b->dof;
  *out = *s;
  double q[ETHD__DOF_MAX], v2[ETHD__DOF_MAX], v3[ETHD__DOF_MAX], v4[ETHD__DOF_MAX];
  double k2[ETHD__DOF_MAX], k3[ETHD__DOF_MAX], k4[ETHD__DOF_MAX];
  ethd__motion hand = ethd__piece_at(piece, t + h / 2);
  for (int i = 0; i < n; i++) {
    q[i] = s->q[i] + h / 2 * s->v[i];
    v2[i] = s->v[i] + h / 2 * k1[i];
  }
  ethd__body_accelerate(b, s->touch, &hand, q, v2, k2);
  for (int i = 0; i < n; i++) {
    q[i] = s->q[i] + h / 2 * v2[i];
    v3[i] = s->v[i] + h / 2 * k2[i];
  }
  ethd__body_accelerate(b, s->touch, &hand, q, v3, k3);
  hand = ethd__piece_at(piece, t + h);
  for (int i = 0; i < n; i++) {
    q[i] = s->q[i] + h * v3[i];
    v4[i] = s->v[i] + h * k3[i];
  }
  ethd__body_accelerate(b, s->touch, &hand, q, v4, k4);
  for (int i = 0; i < n; i++) {
    out->q[i] = s->q[i] + h / 6 * (s->v[i] + 2 * (v2[i] + v3[i]) + v4[i]);
    out->v[i] = s->v[i] + h / 6 * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
  }
}

/* Shortest step, to LOCATED, after which touch has changed. */
static double locate(const ethd__body *b, const ethd__piece *piece, double t, double h, const ethd__state *s,
                     const double *k1) {
  double low = 0, high = h;
  while (high - low > LOCATED) {
    double middle = (low + high) / 2;
    ethd__state trial;
    rk4(b, piece, t, middle, s, k1, &trial);
    if (ethd__body_touch(b, &trial) == s->touch)
      low = middle;
    else
      high = middle;
  }
  return high;
}

/* k1 comes in as the accelerations at t. */
static void step(const ethd__body *b, const ethd__piece *piece, double t, double h, double *k1,
                 ethd__state *s) {
  for (;;) {
    ethd__state next;
    rk4(b, piece, t, h, s, k1, &next);
    next.touch = ethd__body_touch(b, &next);
    if (next.touch == s->touch) {
      *s = next;
      return;
    }
    double done = locate(b, piece, t, h, s, k1);
    rk4(b, piece, t, done, s, k1, &next);
    next.touch = ethd__body_touch(b, &next);
    *s = next;
    t += done;
    h -= done;
    if (!(h > 0)) return;
    accelerate(b, piece, t, s, k1);
  }
}

/* Into how many steps h is cut: friction turns within some mm/s, which strong motors pass in microseconds.
   Proportional, not to a tolerance: halving h halves every step. */
static int refinement(const ethd__body *b, double h, const ethd__state *s, const double *a) {
  double finest = 1;
  for (int j = 0; j < 2; j++) {
    double l = b->link[j], w[2], aw[2];
    ethd__body_joints(b, s->v, w);
    ethd__body_joints(b, a, aw);
    double slip = fabs(l * w[j]), gain = fabs(l * aw[j]);
    if (slip < TURNING + gain * h) finest = fmax(finest, ceil(gain * (REFERENCE / TURN_STEP)));
  }
  return (int)fmin(finest, REFINED_MAX);
}

void ethd__body_advance(const ethd__body *b, const ethd__piece *piece, double t, double h, ethd__state *s) {
  double k1[ETHD__DOF_MAX];
  accelerate(b, piece, t, s, k1);
  int n = refinement(b, h, s, k1);
  for (int i = 0; i < n; i++) {
    double begin = h * i / n, end = h * (i + 1) / n;
    if (i) accelerate(b, piece, t + begin, s, k1);
    step(b, piece, t + begin, end - begin, k1, s);
  }
}
