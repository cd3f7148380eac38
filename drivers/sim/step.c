/* Makes steps by power series, and locates changes of touch. */
#include <stdbool.h>
#include <string.h>

#include "sim/series.h"
#include "sim/terms.h"

#define LOCATED 1e-12  /* s, to which an event is located */
#define SHORTEST 1e-15 /* s: a reversal within less, or a NaN, isn't followed */
#define RUBBING 10.0   /* tanh is +-1 within 4e-9 beyond it */
#define TURN 2.0       /* largest change of its argument in a step towards 0, */
#define PACE 5e3       /* 1/s: but by no more than this times the grid's cell, so that half the cell halves each step */

static double value(const ethd__two *term, int order, double h) ETHD_RT { return ethd__series_at(term, order, h)[0]; }

static double slope(const ethd__two *term, int order, double h) ETHD_RT {
  double y = order * term[order][0];
  for (int k = order - 1; k > 0; k--) y = y * h + k * term[k][0];
  return y;
}

/* Bounds the change of y from its beginning within h, by adding the sizes of all terms. */
static double reach(const ethd__two *term, int order, double h) {
  double y = fabs(term[order][0]);
  for (int k = order - 1; k > 0; k--) y = y * h + fabs(term[k][0]);
  return y * h;
}

/* Finds where f, a value or a slope, times sign passes from below 0 to above, to LOCATED, by regula falsi (Illinois).
   Returns the end at which it is above. */
static double locate(double (*f)(const ethd__two *, int, double) ETHD_RT, const ethd__two *term, int order, double sign,
                     double high) {
  double low = 0, below = sign * f(term, order, 0), above = sign * f(term, order, high);
  int side = 0;
  while (high - low > LOCATED) {
    double share = below < 0 ? below / (below - above) : 0.5, middle = low + share * (high - low);
    middle = fmin(fmax(middle, low + LOCATED / 4), high - LOCATED / 4);
    double y = sign * f(term, order, middle);
    if (y > 0) {
      high = middle;
      above = y;
      if (side > 0) below /= 2;
      side = 1;
    } else {
      low = middle;
      below = y;
      if (side < 0) above /= 2;
      side = -1;
    }
  }
  return high;
}

/* Finds where sign * y first becomes positive within h, to LOCATED; INFINITY when it doesn't. */
static double rises(const ethd__two *term, int order, double sign, double h) {
  if (sign * term[0][0] + reach(term, order, h) < 0) return INFINITY;
  if (!(sign * value(term, order, h) > 0)) {
    if (!(sign * term[1][0] > 0 && sign * slope(term, order, h) < 0)) return INFINITY;
    h = locate(slope, term, order, -sign, h); /* the summit lies in between */
    if (!(sign * value(term, order, h) > 0)) return INFINITY;
  }
  return locate(value, term, order, sign, h);
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

static void put(ethd__two x, double *out) {
  out[0] = x[0];
  out[1] = x[1];
}

/* Evaluates four polynomials of n + 1, n, n + 1 and n terms, side by side. */
static void evaluate(const ethd__two *x, const ethd__two *v, const ethd__two *y, const ethd__two *w, int n, double h,
                     ethd__two out[4]) {
  ethd__two a = x[n + 1], b = v[n], c = y[n + 1], d = w[n];
  for (int k = n; k > 0; k--) {
    a = a * h + x[k];
    b = b * h + v[k - 1];
    c = c * h + y[k];
    d = d * h + w[k - 1];
  }
  out[0] = a * h + x[0];
  out[1] = b;
  out[2] = c * h + y[0];
  out[3] = d;
}

static void move(const ethd__body *b, const ethd__series *s, const ethd__sim_motion *hand, double h,
                 ethd__sim_state *state) {
  ethd__two out[4];
  evaluate(s->link, s->link_v, s->aside, s->aside_v, s->order, h, out);
  put(out[0], state->q + ETHD__LINK);
  put(out[1], state->v + ETHD__LINK);
  put(out[2] + (ethd__two){hand->x.x, hand->x.y}, state->q + ETHD__FINGER);
  put(out[3] + (ethd__two){hand->v.x, hand->v.y}, state->v + ETHD__FINGER);
  if (!b->compliant) return;
  put(ethd__series_at(s->motor, s->order + 1, h), state->q + ETHD__MOTOR);
  put(ethd__series_at(s->motor_v, s->order, h), state->v + ETHD__MOTOR);
}

/* Far from its reversal friction is constant to the last digit, so a series can't see the reversal coming. */
static bool turns(const ethd__body *b, double most, const ethd__sim_state *from, const ethd__sim_state *to) {
  double before[2], after[2];
  ethd__body_joints(b, from->v, before);
  ethd__body_joints(b, to->v, after);
  for (int j = 0; j < 2; j++) {
    double u = fabs(b->sharpness[j] * before[j]), moved = fabs(b->sharpness[j] * (after[j] - before[j]));
    if (b->friction[j] > 0 && !(moved <= fmax(most, u - RUBBING))) return true;
  }
  return 0;
}

void ethd__leg_begin(const ethd__piece *piece, double t, const ethd__sim_state *state, ethd__leg *out) {
  out->begin = out->end = t;
  out->from = out->to = *state;
  out->hand = ethd__piece_at(piece, t);
}

void ethd__leg_next(const ethd__body *b, const ethd__piece *piece, double end, double cell, ethd__leg *leg) {
  ethd__series *s = &leg->series;
  double whole = end - leg->end, most = fmin(TURN, PACE * cell);
  leg->begin = leg->end;
  leg->from = leg->to;
  ethd__series_expand(b, piece, &leg->hand, whole, &leg->from, s);
  change c = next_change(s, leg->from.touch);
  double step = fmin(s->step, c.after);
  for (;; step /= 2) {
    leg->end = step < whole ? leg->begin + step : end;
    leg->hand = ethd__piece_at(piece, leg->end);
    move(b, s, &leg->hand, step, &leg->to);
    if (!turns(b, most, &leg->from, &leg->to) || step < SHORTEST) break;
  }
  leg->to.clearance = s->clearance;
  if (step == c.after) leg->to.touch = c.touch;
}

void ethd__leg_angles(const ethd__body *b, const ethd__leg *leg, double t, double out[ETHD__DOF_MAX]) {
  const ethd__series *s = &leg->series;
  if (t <= leg->begin || t >= leg->end) {
    memcpy(out, t < leg->end ? leg->from.q : leg->to.q, sizeof leg->to.q);
    return;
  }
  put(ethd__series_at(s->link, s->order + 1, t - leg->begin), out + ETHD__LINK);
  if (b->compliant) put(ethd__series_at(s->motor, s->order + 1, t - leg->begin), out + ETHD__MOTOR);
}

void ethd__leg_at(const ethd__body *b, const ethd__piece *piece, const ethd__leg *leg, double t, ethd__sim_state *out) {
  *out = t < leg->end ? leg->from : leg->to;
  if (t <= leg->begin || t >= leg->end) return;
  ethd__sim_motion hand = ethd__piece_at(piece, t);
  move(b, &leg->series, &hand, t - leg->begin, out);
}

void ethd__body_advance(const ethd__body *b, const ethd__piece *piece, double t, double h, ethd__sim_state *state) {
  ethd__leg leg;
  ethd__leg_begin(piece, t, state, &leg);
  while (leg.end < t + h) ethd__leg_next(b, piece, t + h, h, &leg);
  *state = leg.to;
}
