/* Terms of a product: z_k = sum x_i y_(k-i); of y = x': y_k = (k+1) x_(k+1). So each equation of body.c gives
   term k of an acceleration from the terms up to k of angles and speeds, and functions come from their own:

     u = tanh(s w):         u' = s w' (1 - u^2)
     (C, S) = e^(i th):     C' = -th' S, S' = th' C
     D = sqrt(r . r):       sum D_i D_(k-i) = (r . r)_k */
#include "sim/series.h"

#include "ethd/maths.h"

typedef ethd__two two;

#define ORDER_MIN 4

/* What is needed on the way only. */
typedef struct work {
  const ethd__body *body;
  ethd__series *out;
  int turned, related; /* terms of the geometry that are known */
  int turning;         /* 0: friction is constant */
  two inertia, inverse_inertia, length, friction, viscous, sharpness;
  two slip[ETHD__TERMS], slip_a[ETHD__TERMS], link_a[ETHD__TERMS]; /* slip: speed of what rubs */
  two rub[ETHD__TERMS], unlike[ETHD__TERMS];                       /* u, 1 - u^2 */
  two cosine[ETHD__TERMS], sine[ETHD__TERMS], square_v[ETHD__TERMS];
  double along[ETHD__TERMS], across[ETHD__TERMS]; /* H cos and H sin of th2 - th1 */
  two apart[ETHD__TERMS], force[ETHD__TERMS];     /* from ring to finger; on the ring */
  double inverse_mass;                            /* of the finger */
  double swing;                                   /* of the hand's terms beyond 3 */
  double inverse_distance, square[ETHD__TERMS], distance[ETHD__TERMS],
      push[ETHD__TERMS]; /* push: force over distance */
} work;

static const double INVERSE[ETHD__TERMS + 1] = {
    0,       1.0,      1.0 / 2,  1.0 / 3,  1.0 / 4,  1.0 / 5,  1.0 / 6,  1.0 / 7, 1.0 / 8,
    1.0 / 9, 1.0 / 10, 1.0 / 11, 1.0 / 12, 1.0 / 13, 1.0 / 14, 1.0 / 15, 1.0 / 16};

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
static inline two joint(const ethd__body *b, two link) {
  return b->serial ? (two){link[0], link[1] - link[0]} : link;
}

/* ---- geometry ---- */

static void rotate(work *w, int k) {
  if (k <= w->turned) return;
  w->turned = k;
  two c = w->out->link_v[0] * w->sine[k - 1], s = w->out->link_v[0] * w->cosine[k - 1];
  for (int i = 1; i < k; i++) {
    c += w->out->link_v[i] * w->sine[k - 1 - i];
    s += w->out->link_v[i] * w->cosine[k - 1 - i];
  }
  w->cosine[k] = -c * ethd__both(INVERSE[k]);
  w->sine[k] = s * ethd__both(INVERSE[k]);
}

static void relate(work *w, int k) {
  if (k <= w->related) return;
  w->related = k;
  rotate(w, k);
  if (k > 3)
    w->out->hand[k] = w->out->hand[k - 2] * ethd__both(w->swing * (INVERSE[k] * INVERSE[k - 1]));
  two ring = {ethd__sum(w->length * w->cosine[k]), ethd__sum(w->length * w->sine[k])};
  w->apart[k] = w->out->hand[k] + w->out->aside[k] - ring;
  w->square[k] = ethd__sum(product(w->apart, w->apart, k));
}

static void measure(work *w, int k) {
  if (k == 0) {
    w->distance[0] = sqrt(w->square[0]);
    w->inverse_distance = 1 / w->distance[0];
    w->out->beyond[0] = w->distance[0] - w->body->gap;
    return;
  }
  double s = w->square[k];
  for (int i = 1; i < k; i++) s -= w->distance[i] * w->distance[k - i];
  w->out->beyond[k] = w->distance[k] = s / 2 * w->inverse_distance;
  w->out->leaving[k - 1] = w->body->pad_damping * (k * w->distance[k]) + (k == 1);
}

/* Force over distance = K p (1 + c p') / D; on the ring along r. Needs the geometry's terms up to k + 1.
 */
static two press(work *w, int k) {
  double s = w->body->pad_stiffness * product_1(w->out->beyond, w->out->leaving, k);
  for (int i = 1; i <= k; i++) s -= w->distance[i] * w->push[k - i];
  w->push[k] = s * w->inverse_distance;
  two f = ethd__both(w->push[0]) * w->apart[k];
  for (int i = 1; i <= k; i++) f += ethd__both(w->push[i]) * w->apart[k - i];
  w->force[k] = f;
  two torque = ethd__both(0);
  for (int i = 0; i <= k; i++)
    torque +=
        w->cosine[i] * ethd__both(w->force[k - i][1]) - w->sine[i] * ethd__both(w->force[k - i][0]);
  return w->length * torque;
}

/* ---- accelerations ---- */

static two rub(work *w, int k) {
  if (k == 0) {
    for (int j = 0; j < 2; j++) w->rub[0][j] = ethd_tanh(w->sharpness[j] * w->slip[0][j]);
    w->unlike[0] = 1 - w->rub[0] * w->rub[0];
    w->turning = ethd__sum(w->unlike[0]) > 0;
  } else if (!w->turning) {
    return w->viscous * w->slip[k];
  } else {
    w->rub[k] = w->sharpness * ethd__both(INVERSE[k]) * product(w->slip_a, w->unlike, k - 1);
    w->unlike[k] = -product(w->rub, w->rub, k);
  }
  return w->friction * w->rub[k] + w->viscous * w->slip[k];
}

/* Torques on the links; the motors' terms k + 1 where they have their own. */
static two drive(work *w, int k) {
  const ethd__body *b = w->body;
  ethd__series *s = w->out;
  two torque = k ? ethd__both(0) : ethd__pair(b->torque), d;
  if (b->compliant) {
    d = ethd__pair(b->stiffness) * (s->motor[k] - joint(b, s->link[k])) +
        ethd__pair(b->damping) * (s->motor_v[k] - joint(b, s->link_v[k]));
    w->slip[k] = s->motor_v[k];
    w->slip_a[k] = (torque - rub(w, k) - d) / ethd__pair(b->motor_inertia);
    s->motor_v[k + 1] = w->slip_a[k] * INVERSE[k + 1];
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
  rotate(w, k);
  w->along[k] = w->across[k] = 0;
  for (int i = 0; i <= k; i++) {
    w->along[k] += h * (c[i][0] * c[k - i][1] + s[i][0] * s[k - i][1]);
    w->across[k] += h * (c[i][0] * s[k - i][1] - s[i][0] * c[k - i][1]);
  }
  w->square_v[k] = product(w->out->link_v, w->out->link_v, k);
  for (int i = 0; i <= k; i++)
    g += ethd__both(w->across[i]) * ethd__swapped(w->square_v[k - i]) * (two){1, -1};
  for (int i = 1; i <= k; i++) g -= ethd__both(w->along[i]) * ethd__swapped(w->link_a[k - i]);
  return (ethd__swapped(w->inertia) * g - ethd__both(w->along[0]) * ethd__swapped(g)) /
         ethd__both(w->inertia[0] * w->inertia[1] - w->along[0] * w->along[0]);
}

/* Positions' terms k + 1. */
static void integrate(work *w, int k) {
  ethd__series *s = w->out;
  s->link[k + 1] = s->link_v[k] * INVERSE[k + 1];
  s->aside[k + 1] = s->aside_v[k] * INVERSE[k + 1];
  if (w->body->compliant) s->motor[k + 1] = s->motor_v[k] * INVERSE[k + 1];
}

/* Speeds' terms k + 1 from what is known up to k. */
static void accelerate(work *w, ethd__touch touch, int k) {
  const ethd__body *b = w->body;
  ethd__series *s = w->out;
  two g = drive(w, k);
  integrate(w, k);
  two f = -(ethd__both(b->hand_stiffness) * s->aside[k] + ethd__both(b->hand_damping) * s->aside_v[k]);
  if (touch == ETHD__PRESSING) {
    relate(w, k + 1);
    measure(w, k + 1);
    g += press(w, k);
    f -= w->force[k];
  }
  w->link_a[k] = b->coupling != 0 ? couple(w, g, k) : g * w->inverse_inertia;
  if (!b->compliant) w->slip_a[k] = joint(b, w->link_a[k]);
  s->link_v[k + 1] = w->link_a[k] * INVERSE[k + 1];
  s->aside_v[k + 1] = f * ethd__both(INVERSE[k + 1] * w->inverse_mass);
}

/* ---- how many terms, how far ---- */

static inline double speed(const work *w, int k) {
  const ethd__series *s = w->out;
  double m = ethd__size(w->length * s->link_v[k]) + ethd__size(s->aside_v[k]);
  return w->body->compliant ? m + ethd__size(w->length * s->motor_v[k]) : m;
}

static double power(double x, int k) {
  double y = 1;
  for (; k > 0; k--) y *= x;
  return y;
}

/* How far pad and ring can come nearer to each other within the step: every term in full. */
static double travel(const work *w, const ethd__piece *piece, double h) {
  const ethd__series *s = w->out;
  double reach = 0;
  for (int k = s->order + 1; k > 0; k--)
    reach = h * (ethd__size(w->length * s->link[k]) + ethd__size(s->aside[k]) + reach);
  return reach + ethd__piece_travel(piece, s->hand[1], h);
}

static void geometry_begins(work *w, const double *angle) {
  double sine[2], cosine[2];
  ethd__body_waves(w->body, angle, sine, cosine);
  w->sine[0] = ethd__pair(sine);
  w->cosine[0] = ethd__pair(cosine);
  w->turned = 0;
  w->related = -1;
  relate(w, 0);
}

/* Apart, far from each other: nothing to watch. */
static void watch(work *w, const ethd__piece *piece, const ethd__motion *hand, ethd__touch touch) {
  ethd__series *s = w->out;
  int last = s->order + 1;
  if (touch == ETHD__APART) {
    double slack = w->body->gap - sqrt(w->square[0]);
    s->watched = 0;
    if (slack > travel(w, piece, s->step)) return;
    ethd__piece_terms(piece, hand, s->hand);
  }
  s->watched = last;
  for (int k = w->related + 1; k <= last; k++) {
    relate(w, k);
    if (touch != ETHD__APART) measure(w, k);
  }
  if (touch != ETHD__APART) return;
  s->beyond[0] = w->square[0] - w->body->gap * w->body->gap;
  for (int k = 1; k <= last; k++) s->beyond[k] = w->square[k];
}

static void begin(const ethd__body *b, const ethd__motion *hand, const ethd__state *state,
                  ethd__series *s) {
  s->link[0] = ethd__pair(state->q + ETHD__LINK);
  s->link_v[0] = ethd__pair(state->v + ETHD__LINK);
  s->hand[0] = (two){hand->x.x, hand->x.y};
  s->hand[1] = (two){hand->v.x, hand->v.y};
  s->aside[0] = ethd__pair(state->q + ETHD__FINGER) - s->hand[0];
  s->aside_v[0] = ethd__pair(state->v + ETHD__FINGER) - s->hand[1];
  if (!b->compliant) return;
  s->motor[0] = ethd__pair(state->q + ETHD__MOTOR);
  s->motor_v[0] = ethd__pair(state->v + ETHD__MOTOR);
}

/* Terms up to that which no longer counts, and where the last two of all do, a shorter step. */
static void expand(work *w, ethd__touch touch, double tolerance) {
  ethd__series *s = w->out;
  double h = s->step, reach = h, before = INFINITY, term = INFINITY;
  int k = 0;
  while (k < ETHD__ORDER_MAX && !(k >= ORDER_MIN && before <= tolerance && term <= tolerance)) {
    accelerate(w, touch, k++);
    before = term;
    term = reach * speed(w, k);
    reach *= h;
  }
  s->order = k;
  integrate(w, k);
  double last = speed(w, k), previous = speed(w, k - 1);
  while (!(term <= tolerance && before <= tolerance) && isfinite(term) && isfinite(before)) {
    h *= 0.75;
    term = last * power(h, k);
    before = previous * power(h, k - 1);
  }
  s->step = h;
}

void ethd__series_expand(const ethd__body *b, const ethd__piece *piece, double t, double step,
                         const ethd__state *state, ethd__series *out) {
  work w;
  ethd__motion hand = ethd__piece_at(piece, t);
  w.body = b;
  w.out = out;
  w.inverse_mass = 1 / b->finger_mass;
  w.swing = -piece->w * piece->w;
  w.inertia = ethd__pair(b->inertia);
  w.inverse_inertia = 1 / w.inertia;
  w.length = ethd__pair(b->link);
  w.friction = ethd__pair(b->friction);
  w.viscous = ethd__pair(b->viscous);
  w.sharpness = ethd__pair(b->sharpness);
  begin(b, &hand, state, out);
  geometry_begins(&w, state->q);
  if (state->touch != ETHD__APART) {
    ethd__piece_terms(piece, &hand, out->hand);
    measure(&w, 0);
  }
  out->step = step;
  expand(&w, state->touch, b->tolerance);
  watch(&w, piece, &hand, state->touch);
}
