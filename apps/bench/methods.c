#include "bench/methods.h"

#include <string.h>

enum { N = ETHD__ODE_SIZE, HALF = N / 2 };

/* ---- the plant ---- */

static void unpack(const double *y, ethd__touch touch, ethd__sim_state *s) {
  memcpy(s->q, y, HALF * sizeof *y);
  memcpy(s->v, y + HALF, HALF * sizeof *y);
  s->touch = touch;
}

static void pack(const ethd__sim_state *s, double *y) {
  memcpy(y, s->q, HALF * sizeof *y);
  memcpy(y + HALF, s->v, HALF * sizeof *y);
}

static void rate(void *self, double t, const double *y, double *out) {
  ethd__plain *p = self;
  ethd__sim_motion hand = ethd__piece_at(p->piece, t);
  if (p->live) {
    ethd__sim_state s;
    unpack(y, ETHD__APART, &s);
    p->touch = ethd__body_touch(p->body, &s);
  }
  memcpy(out, y + HALF, HALF * sizeof *y);
  ethd__body_accelerate(p->body, p->touch, &hand, y, y + HALF, out + HALF);
}

/* Apart: -p; touching: p and 1 + c p', or the latter's opposite while the pad leaves. */
static void watch(void *self, double t, const double *y, double out[2]) {
  const ethd__plain *p = self;
  ethd__sim_state s;
  ethd_vec x, v;
  (void)t;
  unpack(y, p->touch, &s);
  ethd__body_ring(p->body, &s, &x, &v);
  ethd_vec r = {y[2] - x.x, y[3] - x.y}, away = {y[6] - v.x, y[7] - v.y};
  double distance = ethd_vec_norm(r), depth = distance - p->body->gap;
  out[0] = depth;
  out[1] = 1;
  if (p->touch == ETHD__APART)
    out[0] = -depth;
  else
    out[1] = 1 + p->body->pad_damping * ethd_vec_dot(r, away) / distance;
  if (p->touch == ETHD__LEAVING) out[1] = -out[1];
}

static void change(void *self, int i) {
  ethd__plain *p = self;
  if (i == 0)
    p->touch = p->touch == ETHD__APART ? ETHD__PRESSING : ETHD__APART;
  else
    p->touch = p->touch == ETHD__PRESSING ? ETHD__LEAVING : ETHD__PRESSING;
}

ethd__ode ethd__plain_ode(ethd__plain *plain) { return (ethd__ode){plain, rate, watch, change}; }

/* ---- one step ---- */

/* out = y + h sum c_i k_i */
static void combine(const double *y, double h, int count, const double *c, double k[][N], double *out) {
  for (int j = 0; j < N; j++) {
    double s = 0;
    for (int i = 0; i < count; i++) s += c[i] * k[i][j];
    out[j] = y[j] + h * s;
  }
}

/* Speeds first, then positions by the new speeds. */
static double euler(const ethd__ode *ode, double t, double h, const double *y, const double *k1, double *out,
                    double *k_next, int *fresh) {
  (void)ode, (void)t, (void)k_next;
  for (int j = 0; j < HALF; j++) {
    out[HALF + j] = y[HALF + j] + h * k1[HALF + j];
    out[j] = y[j] + h * out[HALF + j];
  }
  *fresh = 0;
  return 0;
}

static double rk4(const ethd__ode *ode, double t, double h, const double *y, const double *k1, double *out,
                  double *k_next, int *fresh) {
  static const double a2[] = {0.5}, a3[] = {0, 0.5}, a4[] = {0, 0, 1}, b[] = {1. / 6, 1. / 3, 1. / 3, 1. / 6};
  double k[4][N], x[N];
  (void)k_next;
  memcpy(k[0], k1, sizeof k[0]);
  combine(y, h, 1, a2, k, x);
  ode->rate(ode->self, t + h / 2, x, k[1]);
  combine(y, h, 2, a3, k, x);
  ode->rate(ode->self, t + h / 2, x, k[2]);
  combine(y, h, 3, a4, k, x);
  ode->rate(ode->self, t + h, x, k[3]);
  combine(y, h, 4, b, k, out);
  *fresh = 0;
  return 0;
}

/* Dormand and Prince 1980; the last evaluation is the next step's first. */
static double dopri5(const ethd__ode *ode, double t, double h, const double *y, const double *k1, double *out,
                     double *k_next, int *fresh) {
  static const double c[] = {0, 1. / 5, 3. / 10, 4. / 5, 8. / 9, 1};
  static const double a[6][5] = {{0},
                                 {1. / 5},
                                 {3. / 40, 9. / 40},
                                 {44. / 45, -56. / 15, 32. / 9},
                                 {19372. / 6561, -25360. / 2187, 64448. / 6561, -212. / 729},
                                 {9017. / 3168, -355. / 33, 46732. / 5247, 49. / 176, -5103. / 18656}};
  static const double b[] = {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84};
  static const double e[] = {71. / 57600, 0, -71. / 16695, 71. / 1920, -17253. / 339200, 22. / 525, -1. / 40};
  double k[7][N], x[N], worst = 0;
  memcpy(k[0], k1, sizeof k[0]);
  for (int i = 1; i < 6; i++) {
    combine(y, h, i, a[i], k, x);
    ode->rate(ode->self, t + c[i] * h, x, k[i]);
  }
  combine(y, h, 6, b, k, out);
  ode->rate(ode->self, t + h, out, k[6]);
  memcpy(k_next, k[6], sizeof k[6]);
  *fresh = 1;
  for (int j = 0; j < N; j++) {
    double s = 0;
    for (int i = 0; i < 7; i++) s += e[i] * k[i][j];
    worst = fmax(worst, fabs(h * s));
  }
  return worst;
}

const ethd__method ethd__methods[] = {
    {"semi-implicit Euler", 0, 0, {200e-6, 50e-6, 12.5e-6, 3e-6}, euler},
    {"RK4 without events", 0, 0, {500e-6, 200e-6, 100e-6, 50e-6, 25e-6, 12.5e-6}, rk4},
    {"RK4 with events", 0, 1, {500e-6, 200e-6, 100e-6, 50e-6, 25e-6, 12.5e-6, 6e-6}, rk4},
    {"DOPRI5 with events", 1, 1, {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-12}, dopri5},
};
const int ethd__method_count = sizeof ethd__methods / sizeof *ethd__methods;

/* ---- many ---- */

typedef struct step_span {
  const ethd__runner *r;
  double t;
  const double *y, *k1;
  double out[N], k_next[N];
  int fresh, which;
} step_span;

static double try_step(void *self, double s) {
  step_span *p = self;
  double g[2];
  p->r->method->step(&p->r->ode, p->t, s, p->y, p->k1, p->out, p->k_next, &p->fresh);
  watch(p->r->ode.self, p->t + s, p->out, g);
  return g[p->which];
}

/* Takes a step of h, or less up to a change; returns what was taken, or 0: too large an error. */
static double take(ethd__runner *r, double t, double h, double *y, double *k1, double *error) {
  step_span p = {.r = r, .t = t, .y = y, .k1 = k1};
  double g[2] = {1, 1}, before[2], done = h;
  *error = r->method->step(&r->ode, t, h, y, k1, p.out, p.k_next, &p.fresh);
  if (r->method->adaptive && !(*error <= r->setting)) return 0;
  if (r->method->events) watch(&r->plain, t + h, p.out, g);
  p.which = ethd__ode_changed(g);
  if (p.which >= 0) {
    watch(&r->plain, t, y, before);
    done = ethd__ode_locate(try_step, &p, before[p.which], h, g[p.which]);
    try_step(&p, done);
    change(&r->plain, p.which);
    p.fresh = 0;
  }
  memcpy(y, p.out, sizeof p.out);
  if (p.fresh)
    memcpy(k1, p.k_next, sizeof p.k_next);
  else
    rate(&r->plain, t + done, y, k1);
  return done;
}

static void adapt(ethd__runner *r, double t, double end, double *y, double *k1) {
  while (t < end) {
    double error, h = fmin(r->h, end - t), done = take(r, t, h, y, k1, &error);
    double grow = error > 0 ? fmin(5, fmax(0.2, 0.9 * pow(r->setting / error, 0.2))) : 5;
    if (h == r->h || grow < 1) r->h = fmin(h * grow, 1e-2);
    t = done == end - t ? end : t + done;
  }
}

static void march(ethd__runner *r, double t, double end, double *y, double *k1) {
  double h = (end - t) / ceil((end - t) / r->setting - 1e-9), error;
  while (t < end) {
    double left = end - t, step = left < 1.5 * h ? fmin(left, h) : h;
    if (left - step < 1e-3 * h) step = left;
    double done = take(r, t, step, y, k1, &error);
    t = done == left ? end : t + done;
  }
}

void ethd__runner_stretch(void *user, ethd__body *body, const ethd__stretch *s, ethd__sim_state *state) {
  ethd__runner *r = user;
  double y[N], k1[N];
  r->plain.body = body;
  r->plain.piece = &s->piece;
  r->plain.touch = state->touch;
  pack(state, y);
  if (r->peer) {
    r->peer->work(r->peer_self, s->begin, s->end, y);
  } else {
    rate(&r->plain, s->begin, y, k1);
    (r->method->adaptive ? adapt : march)(r, s->begin, s->end, y, k1);
  }
  unpack(y, r->plain.touch, state);
}
