/* The series of series.c, without finger and pad: the terms up to k of angles and speeds give term k of each
   acceleration, which gives term k + 1 of the speed. */
#include "sim/arms.h"

#include "ethd/maths.h"
#include "sim/terms.h"

#define RUBBING 10.0   /* tanh is +-1 within 4e-9 beyond it */
#define TURN 2.0       /* largest change of its argument in a step towards 0 */
#define SHORTEST 1e-12 /* of the rest of the step: a reversal within less, or a NaN, isn't followed */

typedef struct kind {
  bool serial, compliant, coupled;
} kind;

/* Intermediate terms of an arm; slip is the speed at which friction acts. */
typedef struct workings {
  bool turning; /* false: friction is constant */
  ethd__two slip[ETHD__ARMS_TERMS], slip_a[ETHD__ARMS_TERMS], link_a[ETHD__ARMS_TERMS];
  ethd__two rub[ETHD__ARMS_TERMS], unlike[ETHD__ARMS_TERMS];                          /* u = tanh(s w), 1 - u^2 */
  ethd__two cosine[ETHD__ARMS_TERMS], sine[ETHD__ARMS_TERMS], bend[ETHD__ARMS_TERMS]; /* of th2 - th1, each twice */
  ethd__two square_v[ETHD__ARMS_TERMS];
} workings;

typedef struct troop {
  const ethd__arms *arms;
  ethd__arms_step *out;
  workings of[ETHD__ARMS];
} troop;

/* ---- accelerations ---- */

ETHD__INLINE ethd__two rub(const ethd__arms_body *b, workings *w, int k) {
  if (k == 0) {
    ethd__two u = b->sharpness * w->slip[0];
    w->rub[0] = (ethd__two){ethd_tanh(u[0]), ethd_tanh(u[1])};
    w->unlike[0] = 1 - w->rub[0] * w->rub[0];
    w->turning = ethd__sum(w->unlike[0]) > 0;
  } else if (!w->turning) {
    return b->viscous * w->slip[k];
  } else {
    w->rub[k] = b->sharpness * ethd__both(ETHD__INVERSE[k]) * ethd__product(w->slip_a, w->unlike, k - 1);
    w->unlike[k] = -2 * ethd__half_square(w->rub, k);
  }
  return b->friction * w->rub[k] + b->viscous * w->slip[k];
}

/* Computes the torques on the links, and, if the motors have their own coordinates, their terms k + 1. */
ETHD__INLINE ethd__two drive(const ethd__arms_body *b, ethd__arms_series *s, workings *w, kind has, int k) {
  ethd__two torque = k ? ethd__both(0) : b->torque, d;
  if (has.compliant) {
    d = b->stiffness * (s->motor[k] - ethd__joint(has.serial, s->link[k])) +
        b->damping * (s->motor_v[k] - ethd__joint(has.serial, s->link_v[k]));
    w->slip[k] = s->motor_v[k];
    w->slip_a[k] = (torque - d - rub(b, w, k)) * b->inverse_motor_inertia;
    s->motor_v[k + 1] = w->slip_a[k] * ethd__both(ETHD__INVERSE[k + 1]);
  } else {
    w->slip[k] = ethd__joint(has.serial, s->link_v[k]);
    d = torque - rub(b, w, k);
  }
  return has.serial ? (ethd__two){d[0] - d[1], d[1]} : d;
}

/* Computes term k of cosine and sine of th2 - th1. */
static void turn(const ethd__arms_series *s, workings *w, int k) {
  if (k == 0) {
    double sine, cosine;
    ethd_sincos(s->link[0][1] - s->link[0][0], &sine, &cosine);
    w->sine[0] = ethd__both(sine);
    w->cosine[0] = ethd__both(cosine);
  } else {
    w->cosine[k] = -ethd__product(w->bend, w->sine, k - 1) * ethd__both(ETHD__INVERSE[k]);
    w->sine[k] = ethd__product(w->bend, w->cosine, k - 1) * ethd__both(ETHD__INVERSE[k]);
  }
  w->bend[k] = ethd__both(s->link_v[k][1] - s->link_v[k][0]);
}

/* Solves I1 a1 + H cos a2 = g1 + H sin w2^2, H cos a1 + I2 a2 = g2 - H sin w1^2 for term k of a. */
static ethd__two couple(const ethd__arms_body *b, const ethd__arms_series *s, workings *w, ethd__two g, int k) {
  ethd__two across = ethd__both(0), other = ethd__both(0);
  turn(s, w, k);
  w->square_v[k] = 2 * ethd__half_square(s->link_v, k);
  for (int i = 0; i <= k; i++) across += w->sine[i] * ethd__swapped(w->square_v[k - i]);
  for (int i = 1; i <= k; i++) other += w->cosine[i] * ethd__swapped(w->link_a[k - i]);
  g += ethd__both(b->coupling) * ((ethd__two){1, -1} * across - other);
  ethd__two along = ethd__both(b->coupling) * w->cosine[0];
  return (ethd__swapped(b->inertia) * g - along * ethd__swapped(g)) /
         (b->inertia * ethd__swapped(b->inertia) - along * along);
}

/* Computes the speeds' and the angles' terms k + 1 from the terms up to k. */
ETHD__INLINE void accelerate(troop *e, int i, kind has, int k) {
  const ethd__arms_body *b = &e->arms->body[i];
  ethd__arms_series *s = &e->out->series[i];
  workings *w = &e->of[i];
  ethd__two g = drive(b, s, w, has, k), next = ethd__both(ETHD__INVERSE[k + 1]);
  w->link_a[k] = has.coupled ? couple(b, s, w, g, k) : g * b->inverse_inertia;
  if (!has.compliant) w->slip_a[k] = ethd__joint(has.serial, w->link_a[k]);
  s->link[k + 1] = s->link_v[k] * next;
  s->link_v[k + 1] = w->link_a[k] * next;
  if (has.compliant) s->motor[k + 1] = s->motor_v[k] * next;
}

ETHD__INLINE void accelerate_all(troop *e, kind has, int k) {
  for (int i = 0; i < ETHD__ARMS; i++) accelerate(e, i, has, k);
}

/* ---- number of terms, length of a step ---- */

/* Returns the change of the arms' speeds by term k over the whole step, m/s: the largest of all arms. */
ETHD__INLINE double speed(const troop *e, kind has, int k, const double *reach) {
  double most = 0;
  for (int i = 0; i < ETHD__ARMS; i++) {
    const ethd__arms_series *s = &e->out->series[i];
    double size = ethd__size(e->arms->body[i].length * s->link_v[k]);
    if (has.compliant) size += ethd__size(e->arms->body[i].length * s->motor_v[k]);
    size *= reach[i];
    most = size <= most ? most : size;
  }
  return most;
}

/* Computes terms until one no longer counts. If even the last two count, the step is shortened. Returns the share of
   the step that remains. */
ETHD__INLINE double expand(troop *e, kind has, const double *h) {
  double tolerance = e->arms->tolerance, reach[ETHD__ARMS];
  for (int k = 0; k < ETHD__ORDER_MIN; k++) accelerate_all(e, has, k);
  for (int i = 0; i < ETHD__ARMS; i++) reach[i] = h[i] * h[i] * h[i];
  double before = speed(e, has, 3, reach);
  for (int i = 0; i < ETHD__ARMS; i++) reach[i] *= h[i];
  double term = speed(e, has, 4, reach);
  int k = ETHD__ORDER_MIN;
  while (k < e->arms->order_max && !(before <= tolerance && term <= tolerance)) {
    accelerate_all(e, has, k++);
    before = term;
    for (int i = 0; i < ETHD__ARMS; i++) reach[i] *= h[i];
    term = speed(e, has, k, reach);
  }
  e->out->order = k;
  for (int i = 0; i < ETHD__ARMS; i++) {
    ethd__arms_series *s = &e->out->series[i];
    s->link[k + 1] = s->link_v[k] * ethd__both(ETHD__INVERSE[k + 1]);
    if (has.compliant) s->motor[k + 1] = s->motor_v[k] * ethd__both(ETHD__INVERSE[k + 1]);
  }
  double less = 0.75, share = 1;
  for (int i = 2; i < k; i++) less *= 0.75;
  while (!(term <= tolerance && before <= tolerance) && isfinite(term) && isfinite(before)) {
    share *= 0.75;
    term *= 0.75 * less;
    before *= less;
  }
  return share;
}

/* The paper's arm, rigid or elastic, has compiled cases of its own, because it runs most. */
static double expand_kind(troop *e, const double *h) {
  kind has = {e->arms->serial, e->arms->compliant, e->arms->coupled};
  if (has.serial || has.coupled) return expand(e, has, h);
  if (has.compliant) return expand(e, (kind){.compliant = true}, h);
  return expand(e, (kind){.compliant = false}, h);
}

/* ---- a step ---- */

/* Evaluates polynomials of order + 1 and of order terms, side by side. */
static void values(const ethd__two *x, const ethd__two *v, int order, double h, ethd__two *out_x, ethd__two *out_v) {
  ethd__two a = x[order + 1], b = v[order];
  for (int k = order; k > 0; k--) {
    a = a * h + x[k];
    b = b * h + v[k - 1];
  }
  *out_x = a * h + x[0];
  *out_v = b;
}

/* Far from its reversal friction is constant to the last digit, so a series can't see the reversal coming. */
static bool turns(const ethd__arms_body *b, ethd__two before, ethd__two after) {
  for (int j = 0; j < 2; j++) {
    double u = fabs(b->sharpness[j] * before[j]), moved = fabs(b->sharpness[j] * (after[j] - before[j]));
    if (b->friction[j] > 0 && !(moved <= TURN || moved <= u - RUBBING)) return true;
  }
  return false;
}

static bool move(const ethd__arms *a, ethd__arms_step *s) {
  bool turned = false;
  for (int i = 0; i < ETHD__ARMS; i++) {
    const ethd__arms_series *x = &s->series[i];
    ethd__arms_state *to = &s->to[i];
    values(x->link, x->link_v, s->order, s->length[i], &to->link, &to->link_v);
    if (a->compliant) values(x->motor, x->motor_v, s->order, s->length[i], &to->motor, &to->motor_v);
    turned |= a->compliant
                  ? turns(&a->body[i], x->motor_v[0], to->motor_v)
                  : turns(&a->body[i], ethd__joint(a->serial, x->link_v[0]), ethd__joint(a->serial, to->link_v));
  }
  return turned;
}

bool ethd__arms_advance(const ethd__arms *a, const double left[ETHD__ARMS], ethd__arms_step *s) {
  troop e;
  e.arms = a;
  e.out = s;
  for (int i = 0; i < ETHD__ARMS; i++) {
    s->series[i].link[0] = s->to[i].link;
    s->series[i].link_v[0] = s->to[i].link_v;
    s->series[i].motor[0] = s->to[i].motor;
    s->series[i].motor_v[0] = s->to[i].motor_v;
  }
  for (double share = expand_kind(&e, left);; share /= 2) {
    for (int i = 0; i < ETHD__ARMS; i++) s->length[i] = share * left[i];
    if (!move(a, s) || share < SHORTEST) return share == 1;
  }
}

void ethd__arms_joints(const ethd__arms *a, const ethd__arms_step *s, int arm, double at, double out[2]) {
  const ethd__arms_series *x = &s->series[arm];
  ethd__two q = a->compliant ? ethd__series_at(x->motor, s->order + 1, at)
                             : ethd__joint(a->serial, ethd__series_at(x->link, s->order + 1, at));
  out[0] = q[0];
  out[1] = q[1];
}

/* ---- from bodies ---- */

void ethd__arms_prepare(const ethd__body bodies[ETHD__ARMS], ethd__arms *out) {
  *out = (ethd__arms){.serial = bodies->serial,
                      .compliant = bodies->compliant,
                      .tolerance = bodies->tolerance,
                      .order_max = bodies->order_max};
  for (int i = 0; i < ETHD__ARMS; i++) {
    const ethd__body *b = &bodies[i];
    out->coupled |= b->coupling != 0;
    out->body[i] = (ethd__arms_body){.torque_max = ethd__pair(b->torque_max),
                                     .length = ethd__pair(b->link),
                                     .inertia = ethd__pair(b->inertia),
                                     .inverse_inertia = 1 / ethd__pair(b->inertia),
                                     .friction = ethd__pair(b->friction),
                                     .viscous = ethd__pair(b->viscous),
                                     .sharpness = ethd__pair(b->sharpness),
                                     .coupling = b->coupling};
    if (!b->compliant) continue;
    out->body[i].inverse_motor_inertia = 1 / ethd__pair(b->motor_inertia);
    out->body[i].stiffness = ethd__pair(b->stiffness);
    out->body[i].damping = ethd__pair(b->damping);
  }
}

void ethd__arms_put(ethd__arms_state *out, const ethd__sim_state *state) {
  out->link = ethd__pair(state->q + ETHD__LINK);
  out->link_v = ethd__pair(state->v + ETHD__LINK);
  out->motor = ethd__pair(state->q + ETHD__MOTOR);
  out->motor_v = ethd__pair(state->v + ETHD__MOTOR);
}
