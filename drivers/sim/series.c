/* Terms of a product are sums of products, z_k = sum x_i y_(k-i); those of y = x' are y_k = (k+1) x_(k+1).
   So each equation of body.c gives term k of an acceleration from the terms up to k of angles and speeds.
   Functions come from their differential equations:

     u = tanh(s w):         u' = s w' (1 - u^2)
     (C, S) = e^(i th):     C' = -th' S, S' = th' C
     D = sqrt(r . r):       sum D_i D_(k-i) = (r . r)_k
*/
#include "sim/series.h"

#include "ethd/maths.h"

typedef ethd__two two;

/* What is needed on the way only. */
typedef struct work {
  const ethd__body *body;
  ethd__series *out;
  two inertia, inverse_inertia, length, friction, viscous, sharpness;
  two slip[ETHD__TERMS], slip_a[ETHD__TERMS], link_a[ETHD__TERMS]; /* slip: speed of what rubs */
  two rub[ETHD__TERMS], unlike[ETHD__TERMS];                       /* u, 1 - u^2 */
  two cosine[ETHD__TERMS], sine[ETHD__TERMS], square_v[ETHD__TERMS];
  double along[ETHD__TERMS], across[ETHD__TERMS]; /* H cos and H sin of th2 - th1 */
  two apart[ETHD__TERMS], force[ETHD__TERMS];     /* from ring to finger; on the ring */
  double square[ETHD__TERMS], distance[ETHD__TERMS], push[ETHD__TERMS]; /* push: force over distance */
} work;

static const double INVERSE[ETHD__TERMS + 1] = {0,       1.0,     1.0 / 2,  1.0 / 3,  1.0 / 4,  1.0 / 5,
                                                1.0 / 6, 1.0 / 7, 1.0 / 8,  1.0 / 9,  1.0 / 10, 1.0 / 11,
                                                1.0 / 12, 1.0 / 13, 1.0 / 14, 1.0 / 15, 1.0 / 16};

static inline two both(double x) { return (two){x, x}; }
static inline two pair(const double *x) { return (two){x[0], x[1]}; }
static inline two swapped(two x) { return (two){x[1], x[0]}; }
static inline double sum(two x) { return x[0] + x[1]; }
static inline double size(two x) { return fabs(x[0]) + fabs(x[1]); }

/* Term k of x y. */
static inline two product(const two *x, const two *y, int k) {
  two s = x[0] * y[k];
  for (int i = 1; i <= k; i++) s += x[i] * y[k - i];
  return s;
}

static inline double product_1(const double *x, const double *y, int k) {
  double s = x[0] * y[k];
  for (int i = 1; i <= k; i++) s += x[i] * y[k - i];
  return s;
}

/* From the links' absolute angles, or what derives from them, to the joints'. */
static inline two joint(const ethd__body *b, two link) { return b->serial ? (two){link[0], link[1] - link[0]} : link; }

/* ---- geometry ---- */

static void rotate(work *w, int k) {
  two c = w->out->link_v[0] * w->sine[k - 1], s = w->out->link_v[0] * w->cosine[k - 1];
  for (int i = 1; i < k; i++) {
    c += w->out->link_v[i] * w->sine[k - 1 - i];
    s += w->out->link_v[i] * w->cosine[k - 1 - i];
  }
  w->cosine[k] = -c * INVERSE[k];
  w->sine[k] = s * INVERSE[k];
}

static void relate(work *w, int k) {
  two ring = {sum(w->length * w->cosine[k]), sum(w->length * w->sine[k])};
  w->apart[k] = w->out->hand[k] + w->out->aside[k] - ring;
  w->square[k] = sum(product(w->apart, w->apart, k));
}

static void measure(work *w, int k) {
  if (k == 0) {
    w->distance[0] = sqrt(w->square[0]);
    w->out->beyond[0] = w->distance[0] - w->body->gap;
    return;
  }
  double s = w->square[k];
  for (int i = 1; i < k; i++) s -= w->distance[i] * w->distance[k - i];
  w->out->beyond[k] = w->distance[k] = s / (2 * w->distance[0]);
  w->out->leaving[k - 1] = w->body->pad_damping * (k * w->distance[k]) + (k == 1);
}

/* Force over distance = K p (1 + c p') / D; on the ring along r. Needs the geometry's terms up to k + 1. */
static two press(work *w, int k) {
  double s = w->body->pad_stiffness * product_1(w->out->beyond, w->out->leaving, k);
  for (int i = 1; i <= k; i++) s -= w->distance[i] * w->push[k - i];
  w->push[k] = s / w->distance[0];
  two f = both(w->push[0]) * w->apart[k];
  for (int i = 1; i <= k; i++) f += both(w->push[i]) * w->apart[k - i];
  w->force[k] = f;
  double x[2] = {0, 0};
  for (int j = 0; j < 2; j++)
    for (int i = 0; i <= k; i++)
      x[j] += w->cosine[i][j] * w->force[k - i][1] - w->sine[i][j] * w->force[k - i][0];
  return w->length * pair(x);
}

/* ---- accelerations ---- */

static two rub(work *w, int k) {
  if (k == 0) {
    for (int j = 0; j < 2; j++) w->rub[0][j] = ethd_tanh(w->sharpness[j] * w->slip[0][j]);
    w->unlike[0] = 1 - w->rub[0] * w->rub[0];
  } else {
    w->rub[k] = w->sharpness * both(INVERSE[k]) * product(w->slip_a, w->unlike, k - 1);
    w->unlike[k] = -product(w->rub, w->rub, k);
  }
  return w->friction * w->rub[k] + w->viscous * w->slip[k];
}

/* Torques on the links; the motors' terms k + 1 where they have their own. */
static two drive(work *w, int k) {
  const ethd__body *b = w->body;
  ethd__series *s = w->out;
  two torque = k ? both(0) : pair(b->torque), d;
  if (b->compliant) {
    d = pair(b->stiffness) * (s->motor[k] - joint(b, s->link[k])) +
        pair(b->damping) * (s->motor_v[k] - joint(b, s->link_v[k]));
    w->slip[k] = s->motor_v[k];
    w->slip_a[k] = (torque - rub(w, k) - d) / pair(b->motor_inertia);
    s->motor_v[k + 1] = w->slip_a[k] * INVERSE[k + 1];
    s->motor[k + 1] = s->motor_v[k] * INVERSE[k + 1];
  } else {
    w->slip[k] = joint(b, s->link_v[k]);
    d = torque - rub(w, k);
  }
  return b->serial ? (two){d[0] - d[1], d[1]} : d;
}

/* I1 a1 + along a2 = g1 + across w2^2, along a1 + I2 a2 = g2 - across w1^2. */
static two couple(work *w, two g, int k) {
  const ethd__two *c = w->cosine, *s = w->sine;
  double h = w->body->coupling;
  w->along[k] = w->across[k] = 0;
  for (int i = 0; i <= k; i++) {
    w->along[k] += h * (c[i][0] * c[k - i][1] + s[i][0] * s[k - i][1]);
    w->across[k] += h * (c[i][0] * s[k - i][1] - s[i][0] * c[k - i][1]);
  }
  w->square_v[k] = product(w->out->link_v, w->out->link_v, k);
  for (int i = 0; i <= k; i++) g += both(w->across[i]) * swapped(w->square_v[k - i]) * (two){1, -1};
  for (int i = 1; i <= k; i++) g -= both(w->along[i]) * swapped(w->link_a[k - i]);
  return (swapped(w->inertia) * g - both(w->along[0]) * swapped(g)) /
         both(w->inertia[0] * w->inertia[1] - w->along[0] * w->along[0]);
}

/* Speeds' terms k + 1 from what is known up to k. */
static void accelerate(work *w, ethd__touch touch, int k) {
  const ethd__body *b = w->body;
  ethd__series *s = w->out;
  two g = drive(w, k);
  s->link[k + 1] = s->link_v[k] * INVERSE[k + 1];
  s->aside[k + 1] = s->aside_v[k] * INVERSE[k + 1];
  two f = -(both(b->hand_stiffness) * s->aside[k] + both(b->hand_damping) * s->aside_v[k]);
  if (touch == ETHD__PRESSING) {
    rotate(w, k + 1);
    relate(w, k + 1);
    measure(w, k + 1);
    g += press(w, k);
    f -= w->force[k];
  } else if (b->coupling != 0 && k) {
    rotate(w, k);
  }
  w->link_a[k] = b->coupling != 0 ? couple(w, g, k) : g * w->inverse_inertia;
  if (!b->compliant) w->slip_a[k] = joint(b, w->link_a[k]);
  s->link_v[k + 1] = w->link_a[k] * INVERSE[k + 1];
  s->aside_v[k + 1] = f * both(INVERSE[k + 1] / b->finger_mass);
}

/* ---- how many terms, how far ---- */

static double speed(const work *w, int k) {
  const ethd__series *s = w->out;
  double m = size(w->length * s->link_v[k]) + size(s->aside_v[k]);
  return w->body->compliant ? m + size(w->length * s->motor_v[k]) : m;
}

static double power(double x, int k) {
  double y = 1;
  for (; k > 0; k--) y *= x;
  return y;
}
