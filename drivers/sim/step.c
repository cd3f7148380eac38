/* Steps by power series, with changes of touch located. */
#include "sim/series.h"

#define LOCATED 1e-12 /* s */
#define RUBBING 10.0  /* tanh is +-1 within 4e-9 beyond it */
#define TURN 2.0      /* by so much its argument may change in a step that comes nearer to 0, */
#define PACE 5e3      /* 1/s: and in a short stretch by less, so that halving that halves each step */

typedef ethd__two two;

static two at(const two *term, int order, double h) {
  two y = term[order];
  for (int k = order - 1; k >= 0; k--) y = y * h + term[k];
  return y;
}

static double value(const double *term, int order, double h) {
  double y = term[order];
  for (int k = order - 1; k >= 0; k--) y = y * h + term[k];
  return y;
}

static double slope(const double *term, int order, double h) {
  double y = order * term[order];
  for (int k = order - 1; k > 0; k--) y = y * h + k * term[k];
  return y;
}

/* Where sign * y becomes positive first within h, to LOCATED; INFINITY: nowhere. */
static double rises(const double *term, int order, double sign, double h) {
  double low = 0, high = h;
  if (!(sign * value(term, order, h) > 0)) {
    if (!(sign * term[1] > 0 && sign * slope(term, order, h) < 0)) return INFINITY;
    while (high - low > LOCATED) { /* a summit within */
      double middle = (low + high) / 2;
      if (sign * slope(term, order, middle) > 0)
        low = middle;
      else
        high = middle;
    }
    if (!(sign * value(term, order, high) > 0)) return INFINITY;
    low = 0;
  }
  while (high - low > LOCATED) {
    double middle = (low + high) / 2;
    if (sign * value(term, order, middle) > 0)
      high = middle;
    else
      low = middle;
  }
  return high;
}

typedef struct change {
  double after;
  ethd__touch touch;
} change;

static change next_change(const ethd__series *s, ethd__touch touch) {
  change none = {INFINITY, touch};
  int n = s->watched;
  if (!n) return none;
  if (touch == ETHD__APART) return (change){rises(s->beyond, n, 1, s->step), ETHD__PRESSING};
  change apart = {rises(s->beyond, n, -1, s->step), ETHD__APART};
  change other = {rises(s->leaving, n - 1, touch == ETHD__PRESSING ? -1 : 1, s->step),
                  touch == ETHD__PRESSING ? ETHD__LEAVING : ETHD__PRESSING};
  return apart.after <= other.after ? apart : other;
}

static void put(two x, double *out) {
  out[0] = x[0];
  out[1] = x[1];
}

static void move(const ethd__body *b, const ethd__series *s, const ethd__piece *piece, double t,
                 double h, ethd__state *state) {
  int n = s->order;
  ethd__motion hand = ethd__piece_at(piece, t + h);
  put(at(s->link, n + 1, h), state->q + ETHD__LINK);
  put(at(s->link_v, n, h), state->v + ETHD__LINK);
  put(at(s->aside, n + 1, h) + (two){hand.x.x, hand.x.y}, state->q + ETHD__FINGER);
  put(at(s->aside_v, n, h) + (two){hand.v.x, hand.v.y}, state->v + ETHD__FINGER);
  if (!b->compliant) return;
  put(at(s->motor, n + 1, h), state->q + ETHD__MOTOR);
  put(at(s->motor_v, n, h), state->v + ETHD__MOTOR);
}

/* Friction far from its turn is constant to the last digit, and a series can't see the turn ahead. */
static int turns(const ethd__body *b, double most, const ethd__state *from, const ethd__state *to) {
  double before[2], after[2];
  ethd__body_joints(b, from->v, before);
  ethd__body_joints(b, to->v, after);
  for (int j = 0; j < 2; j++) {
    double u = fabs(b->sharpness[j] * before[j]), moved = fabs(b->sharpness[j] * (after[j] - before[j]));
    if (b->friction[j] > 0 && !(moved <= fmax(most, u - RUBBING))) return 1;
  }
  return 0;
}

void ethd__body_advance(const ethd__body *b, const ethd__piece *piece, double t, double h,
                        ethd__state *state) {
  double done = 0, most = fmin(TURN, PACE * h);
  while (done < h) {
    ethd__series s;
    ethd__state next = *state;
    ethd__series_expand(b, piece, t + done, h - done, state, &s);
    change c = next_change(&s, state->touch);
    double step = fmin(s.step, c.after);
    move(b, &s, piece, t + done, step, &next);
    while (turns(b, most, state, &next)) {
      step /= 2;
      move(b, &s, piece, t + done, step, &next);
    }
    if (step == c.after) next.touch = c.touch;
    *state = next;
    done = step < h - done ? done + step : h;
  }
}
