/* The idea: within a step every quantity of the motion is a power series about the step's beginning t0, x(t) = sum
   x_k (t - t0)^k, and the equations of motion give its terms one after the other. The terms up to k of angles and
   speeds give term k of each acceleration by the equations of body.c; term k of an acceleration gives term k + 1 of
   the speed, because y = x' means y_k = (k+1) x_(k+1); and so on to the order that the tolerance asks for. A step is
   as long as its last terms stay below the tolerance (Jorba and Zou 2005). Products are sums over terms (terms.h),
   and a function's terms follow from the differential equation that it solves:

     u = tanh(s w):         u' = s w' (1 - u^2)
     (C, S) = e^(i th):     C' = -th' S, S' = th' C
     D = sqrt(r . r):       sum D_i D_(k-i) = (r . r)_k */
#include "sim/series.h"

#include "ethd/maths.h"
#include "sim/terms.h"

/* Intermediate terms. A number stands in both halves of a pair where it multiplies pairs. */
typedef struct expansion {
  const ethd__body *body;
  ethd__series *out;
  int related;  /* number of the geometry's terms that are known */
  bool turning; /* false: friction is constant */
  ethd__two inverse_inertia, length, friction, viscous, sharpness;
  ethd__two slip[ETHD__TERMS], slip_a[ETHD__TERMS], link_a[ETHD__TERMS]; /* slip: speed at which friction acts */
  ethd__two rub[ETHD__TERMS], unlike[ETHD__TERMS];                       /* u, 1 - u^2 */
  ethd__two cosine[ETHD__TERMS], sine[ETHD__TERMS], square_v[ETHD__TERMS];
  double along[ETHD__TERMS], across[ETHD__TERMS];                                /* H cos and H sin of th2 - th1 */
  ethd__two apart[ETHD__TERMS], half_square[ETHD__TERMS], distance[ETHD__TERMS]; /* from ring to finger */
  ethd__two push[ETHD__TERMS], force_x[ETHD__TERMS], force_y[ETHD__TERMS];       /* on the ring; push: over distance */
  ethd__two inverse_distance, stiffness; /* the pad's; stiffness over distance */
  double inverse_mass;                   /* of the finger */
  double swing;                          /* -w^2 of the hand's path, for its terms from ETHD__PATH_TERMS on */
  double tolerance; /* m/s: terms that change less end the series, and the step is so short that the last ones do */
  int order_max;
} expansion;

/* ---- geometry ---- */

ETHD__INLINE void rotate(expansion *w, int k) {
  const ethd__two *v = w->out->link_v;
  w->cosine[k] = -ethd__product(v, w->sine, k - 1) * ethd__both(ETHD__INVERSE[k]);
  w->sine[k] = ethd__product(v, w->cosine, k - 1) * ethd__both(ETHD__INVERSE[k]);
}

/* Computes term k of the vector from ring to finger. */
ETHD__INLINE void relate(expansion *w, int k) {
  if (k > 0) rotate(w, k);
  if (k >= ETHD__PATH_TERMS)
    w->out->hand[k] = w->out->hand[k - 2] * ethd__both(w->swing * (ETHD__INVERSE[k] * ETHD__INVERSE[k - 1]));
  ethd__two x = w->length * w->cosine[k], y = w->length * w->sine[k];
  w->apart[k] = (w->out->hand[k] + w->out->aside[k]) - (ethd__two){ethd__sum(x), ethd__sum(y)};
  w->half_square[k] = ethd__both(ethd__sum(ethd__half_square(w->apart, k)));
  w->related = k;
}

/* Computes term k > 0 of the distance D from that of r r / 2, and term k - 1 of 1 + c D'. */
ETHD__INLINE void measure(expansion *w, int k) {
  ethd__two d = (w->half_square[k] - ethd__half_middle(w->distance, k)) * w->inverse_distance;
  ethd__two e = ethd__both(w->body->pad_damping * k) * d;
  w->out->beyond[k] = w->distance[k] = d;
  w->out->leaving[k - 1] = k == 1 ? e + ethd__both(1) : e;
}

static void geometry_begins(expansion *w, const ethd__piece *piece, const ethd__sim_motion *hand) {
  ethd__body_waves(w->body, w->out->link[0], w->sine, w->cosine);
  ethd__piece_terms(piece, hand, w->out->hand);
  relate(w, 0);
  w->distance[0] = ethd__both(sqrt(2 * w->half_square[0][0]));
}

static void measuring_begins(expansion *w) {
  w->inverse_distance = 1 / w->distance[0];
  w->stiffness = ethd__both(w->body->pad_stiffness) * w->inverse_distance;
  w->out->beyond[0] = w->distance[0] - ethd__both(w->body->gap);
}

/* Returns term k of the links' torques over their lengths. The force on the ring is along r; over distance it is
   K p (1 + c p') / D. Needs the geometry's terms up to k + 1. */
ETHD__INLINE ethd__two press(expansion *w, int k) {
  ethd__two s = w->stiffness * ethd__product(w->out->leaving, w->out->beyond, k);
  if (k > 0) s -= (ethd__middle(w->distance, w->push, k) + w->distance[k] * w->push[0]) * w->inverse_distance;
  w->push[k] = s;
  ethd__two force = ethd__product(w->push, w->apart, k);
  w->force_x[k] = ethd__both(force[0]);
  w->force_y[k] = ethd__both(force[1]);
  return ethd__product(w->force_y, w->cosine, k) - ethd__product(w->force_x, w->sine, k);
}

/* ---- accelerations ---- */

ETHD__INLINE ethd__two rub(expansion *w, int k) {
  if (k == 0) {
    ethd__two u = w->sharpness * w->slip[0];
    w->rub[0] = (ethd__two){ethd_tanh(u[0]), ethd_tanh(u[1])};
    w->unlike[0] = 1 - w->rub[0] * w->rub[0];
    w->turning = ethd__sum(w->unlike[0]) > 0;
  } else if (!w->turning) {
    return w->viscous * w->slip[k];
  } else {
    w->rub[k] = w->sharpness * ethd__both(ETHD__INVERSE[k]) * ethd__product(w->slip_a, w->unlike, k - 1);
    w->unlike[k] = -2 * ethd__half_square(w->rub, k);
  }
  return w->friction * w->rub[k] + w->viscous * w->slip[k];
}

/* Plants differ in these cases; the series are compiled for each. `touch` changes from step to step. */
typedef struct physics {
  bool serial, compliant, coupled;
  ethd__touch touch;
} physics;

/* Computes the torques on the links, and, if the motors have their own coordinates, their terms k + 1. */
ETHD__INLINE ethd__two drive(expansion *w, physics has, int k) {
  const ethd__body *b = w->body;
  ethd__series *s = w->out;
  ethd__two torque = k ? ethd__both(0) : ethd__pair(b->torque), d;
  if (has.compliant) {
    d = ethd__pair(b->stiffness) * (s->motor[k] - ethd__joint(has.serial, s->link[k])) +
        ethd__pair(b->damping) * (s->motor_v[k] - ethd__joint(has.serial, s->link_v[k]));
    w->slip[k] = s->motor_v[k];
    w->slip_a[k] = (torque - rub(w, k) - d) / ethd__pair(b->motor_inertia);
    s->motor_v[k + 1] = w->slip_a[k] * ETHD__INVERSE[k + 1];
  } else {
    w->slip[k] = ethd__joint(has.serial, s->link_v[k]);
    d = torque - rub(w, k);
  }
  return has.serial ? (ethd__two){d[0] - d[1], d[1]} : d;
}

/* Solves I1 a1 + along a2 = g1 + across w2^2, along a1 + I2 a2 = g2 - across w1^2 for term k of a. */
static ethd__two couple(expansion *w, ethd__two g, int k) {
  const ethd__two *c = w->cosine, *s = w->sine;
  ethd__two inertia = ethd__pair(w->body->inertia);
  double h = w->body->coupling;
  if (w->related < k) relate(w, k);
  w->along[k] = w->across[k] = 0;
  for (int i = 0; i <= k; i++) {
    w->along[k] += h * (c[i][0] * c[k - i][1] + s[i][0] * s[k - i][1]);
    w->across[k] += h * (c[i][0] * s[k - i][1] - s[i][0] * c[k - i][1]);
  }
  w->square_v[k] = ethd__product(w->out->link_v, w->out->link_v, k);
  for (int i = 0; i <= k; i++) g += ethd__both(w->across[i]) * ethd__swapped(w->square_v[k - i]) * (ethd__two){1, -1};
  for (int i = 1; i <= k; i++) g -= ethd__both(w->along[i]) * ethd__swapped(w->link_a[k - i]);
  return (ethd__swapped(inertia) * g - ethd__both(w->along[0]) * ethd__swapped(g)) /
         ethd__both(inertia[0] * inertia[1] - w->along[0] * w->along[0]);
}

/* Computes the positions' terms k + 1. */
ETHD__INLINE void integrate(expansion *w, physics has, int k) {
  ethd__series *s = w->out;
  s->link[k + 1] = s->link_v[k] * ETHD__INVERSE[k + 1];
  s->aside[k + 1] = s->aside_v[k] * ETHD__INVERSE[k + 1];
  if (has.compliant) s->motor[k + 1] = s->motor_v[k] * ETHD__INVERSE[k + 1];
}

/* Computes the speeds' terms k + 1 from the terms up to k. */
ETHD__INLINE void accelerate(expansion *w, physics has, int k) {
  const ethd__body *b = w->body;
  ethd__series *s = w->out;
  ethd__two g = drive(w, has, k);
  integrate(w, has, k);
  ethd__two f = -(ethd__both(b->hand_stiffness) * s->aside[k] + ethd__both(b->hand_damping) * s->aside_v[k]);
  if (has.touch == ETHD__PRESSING) {
    relate(w, k + 1);
    measure(w, k + 1);
    ethd__two pressed = press(w, k); /* sets the forces that the next line reads */
    g += w->length * pressed;
    f -= (ethd__two){w->force_x[k][0], w->force_y[k][0]};
  }
  w->link_a[k] = has.coupled ? couple(w, g, k) : g * w->inverse_inertia;
  if (!has.compliant) w->slip_a[k] = ethd__joint(has.serial, w->link_a[k]);
  s->link_v[k + 1] = w->link_a[k] * ETHD__INVERSE[k + 1];
  s->aside_v[k + 1] = f * ethd__both(ETHD__INVERSE[k + 1] * w->inverse_mass);
}

/* ---- number of terms, length of a step ---- */

ETHD__INLINE double speed(const expansion *w, physics has, int k) {
  const ethd__series *s = w->out;
  double m = ethd__size(w->length * s->link_v[k]) + ethd__size(s->aside_v[k]);
  return has.compliant ? m + ethd__size(w->length * s->motor_v[k]) : m;
}

/* Computes terms until one no longer counts, and shortens the step if even the last two count. Returns a bound on the
   ring's speed plus that of the finger relative to its path. */
ETHD__INLINE double expand(expansion *w, physics has) {
  ethd__series *s = w->out;
  double tolerance = w->tolerance, h = s->step, reach, most, before, term;
  accelerate(w, has, 0);
  accelerate(w, has, 1);
  accelerate(w, has, 2);
  accelerate(w, has, 3);
  most = speed(w, has, 0) + h * (speed(w, has, 1) + h * speed(w, has, 2));
  reach = h * h * h;
  before = reach * speed(w, has, 3);
  reach *= h;
  term = reach * speed(w, has, 4);
  most += before + term;
  int k = ETHD__ORDER_MIN;
  while (k < w->order_max && !(before <= tolerance && term <= tolerance)) {
    accelerate(w, has, k++);
    before = term;
    reach *= h;
    term = reach * speed(w, has, k);
    most += term;
  }
  s->order = k;
  integrate(w, has, k);
  double less = 0.75;
  for (int i = 2; i < k; i++) less *= 0.75;
  while (!(term <= tolerance && before <= tolerance) && isfinite(term) && isfinite(before)) {
    h *= 0.75;
    term *= 0.75 * less;
    before *= less;
  }
  s->step = h;
  return most;
}

/* The paper's arm, rigid or elastic, has compiled cases of its own, because it runs most. */
static double expand_kind(expansion *w, physics has) {
  if (has.serial || has.coupled) return expand(w, has);
  if (has.compliant && has.touch == ETHD__PRESSING)
    return expand(w, (physics){.compliant = true, .touch = ETHD__PRESSING});
  if (has.compliant) return expand(w, (physics){.compliant = true, .touch = ETHD__APART});
  if (has.touch == ETHD__PRESSING) return expand(w, (physics){.touch = ETHD__PRESSING});
  return expand(w, (physics){.touch = ETHD__APART});
}

/* ---- touch ---- */

static void watch_apart(expansion *w) {
  ethd__series *s = w->out;
  s->watched = s->order + 1;
  while (w->related < s->watched) relate(w, w->related + 1);
  s->beyond[0] = w->half_square[0] - ethd__both(w->body->gap * w->body->gap / 2);
  for (int k = 1; k <= s->watched; k++) s->beyond[k] = w->half_square[k];
}

static void watch_touching(expansion *w, ethd__touch touch) {
  ethd__series *s = w->out;
  int measured = s->order * (touch == ETHD__PRESSING);
  s->watched = s->order + 1;
  while (w->related < s->watched) relate(w, w->related + 1);
  for (int k = measured + 1; k <= s->watched; k++) measure(w, k);
}

/* While pad and ring are known to be apart, their distance is computed only if they may have come near. */
static void keep_clear(expansion *w, const ethd__piece *piece, const ethd__sim_motion *hand, double clearance,
                       double most) {
  ethd__series *s = w->out;
  double travel = s->step * most + ethd__piece_travel(piece, hand, s->step);
  s->watched = 0;
  s->clearance = clearance - travel;
  if (s->clearance > 0) return;
  if (w->related < 0) geometry_begins(w, piece, hand);
  s->clearance = w->body->gap - w->distance[0][0] - travel;
  if (s->clearance > 0) return;
  s->clearance = 0;
  watch_apart(w);
}

static void begin(const ethd__sim_motion *hand, const ethd__sim_state *state, ethd__series *s) {
  s->link[0] = ethd__pair(state->q + ETHD__LINK);
  s->link_v[0] = ethd__pair(state->v + ETHD__LINK);
  s->aside[0] = ethd__pair(state->q + ETHD__FINGER) - (ethd__two){hand->x.x, hand->x.y};
  s->aside_v[0] = ethd__pair(state->v + ETHD__FINGER) - (ethd__two){hand->v.x, hand->v.y};
  s->motor[0] = ethd__pair(state->q + ETHD__MOTOR);
  s->motor_v[0] = ethd__pair(state->v + ETHD__MOTOR);
}

void ethd__series_expand(const ethd__body *b, const ethd__piece *piece, const ethd__sim_motion *hand, double step,
                         const ethd__sim_state *state, ethd__series *out) {
  physics has = {b->serial, b->compliant, b->coupling != 0, state->touch};
  expansion w;
  w.body = b;
  w.out = out;
  w.related = -1;
  w.swing = -piece->w * piece->w;
  w.inverse_mass = 1 / b->finger_mass;
  w.tolerance = b->tolerance;
  w.order_max = b->order_max;
  w.inverse_inertia = 1 / ethd__pair(b->inertia);
  w.length = ethd__pair(b->link);
  w.friction = ethd__pair(b->friction);
  w.viscous = ethd__pair(b->viscous);
  w.sharpness = ethd__pair(b->sharpness);
  begin(hand, state, out);
  out->step = step;
  if (has.touch != ETHD__APART || has.coupled) geometry_begins(&w, piece, hand);
  if (has.touch != ETHD__APART) measuring_begins(&w);
  double most = expand_kind(&w, has);
  out->clearance = 0;
  if (has.touch == ETHD__APART)
    keep_clear(&w, piece, hand, state->clearance, most);
  else
    watch_touching(&w, has.touch);
}
