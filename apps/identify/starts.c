/* Finds plants from which a fit starts. The second difference of a joint's angle over a span s on both sides of a tick
   is its acceleration weighted with a triangle, and the torques that caused it have the same weights:

     I (q(t+s) - 2 q(t) + q(t-s)) = int (s - |u|) (torque(t+u-delay) - friction - viscous) du

   which is linear in inertia, friction and viscous drag. Torque limit and delay are tried on a grid. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "identify/fit.h"
#include "sim/body.h"

#define SPAN 15 /* ticks */
#define HOP 5   /* ticks from one equation to the next */
#define SLOW 2  /* ticks to each side over which a speed is measured */
#define LIMITS 7
#define DELAYS 20

enum { INERTIA_1, INERTIA_2, RUB, DRAG, TERMS };

static const double limits[LIMITS] = {1.001, 0.85, 0.7, 0.55, 0.4, 0.3, 0.2}; /* shares of the largest force */

typedef struct equation {
  size_t tick, begin; /* the tick in the middle; the first one of its stretch */
  int joint;
  double term[TERMS];
} equation;

typedef struct regression {
  const ethd__evidence *evidence;
  equation *equations;
  size_t count;
  double link[2];
} regression;

static double speed(const ethd__evidence *e, size_t k, int j) {
  return (e->q[k + SLOW][j] - e->q[k - SLOW][j]) / (2 * SLOW * e->period);
}

static void add_equation(regression *r, size_t begin, size_t k, int j) {
  const ethd__evidence *e = r->evidence;
  double T = e->period, l = r->link[j];
  equation q = {k, begin, j, {0}};
  q.term[j] = e->q[k + SPAN][j] - 2 * e->q[k][j] + e->q[k - SPAN][j];
  for (int i = -SPAN + 1; i < SPAN; i++) {
    double w = speed(e, k + (size_t)(SPAN + i) - SPAN, j), weight = T * T * (SPAN - abs(i));
    q.term[RUB] += weight * l * tanh(l * w / ETHD__STICK);
    q.term[DRAG] += weight * l * l * w;
  }
  r->equations[r->count++] = q;
}

static void collect(regression *r) {
  const ethd__evidence *e = r->evidence;
  r->equations = malloc((2 * e->count / HOP + 2 * e->stretch_count + 2) * sizeof *r->equations);
  if (!r->equations) ethd__fail_memory();
  for (size_t i = 0; i < e->stretch_count; i++) {
    const ethd__passage *s = &e->stretches[i];
    size_t end = s->first + s->count;
    for (size_t k = s->first + ETHD__BACK + SPAN + SLOW; k + SPAN + SLOW < end; k += HOP)
      for (int j = 0; j < 2; j++) add_equation(r, s->first, k, j);
  }
}

/* Returns the weighted torque of an equation. */
static double driven(const regression *r, const equation *q, double most, double delay) {
  const ethd__evidence *e = r->evidence;
  double T = e->period, sum = 0, limit = most * r->link[q->joint];
  int back = (int)floor(delay / T + 0.5);
  for (int i = -SPAN - back - 1; i <= SPAN; i++) {
    double weight = SPAN - fabs(i + 0.5 + delay / T),
           torque = e->torque[q->tick + (size_t)(i + SPAN * 2) - SPAN * 2][q->joint];
    if (weight > 0) sum += weight * fmin(fmax(torque, -limit), limit);
  }
  return T * T * sum;
}

/* Solves the symmetric a x = b in place by elimination; a term that no equation shows becomes 0. */
static void solve(double a[TERMS][TERMS], double b[TERMS]) {
  double scale[TERMS];
  for (int i = 0; i < TERMS; i++) scale[i] = a[i][i];
  for (int i = 0; i < TERMS; i++) {
    if (!(a[i][i] > 1e-9 * scale[i])) {
      for (int k = 0; k < TERMS; k++) a[i][k] = a[k][i] = 0;
      a[i][i] = 1;
      b[i] = 0;
    }
    for (int k = i + 1; k < TERMS; k++) {
      double factor = a[k][i] / a[i][i];
      for (int c = i; c < TERMS; c++) a[k][c] -= factor * a[i][c];
      b[k] -= factor * b[i];
    }
  }
  for (int i = TERMS - 1; i >= 0; i--) {
    for (int k = i + 1; k < TERMS; k++) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
}

/* Fills the terms of the regression, and returns the share of the torque that they don't explain. */
static double regress(const regression *r, double most, double delay, double out[TERMS]) {
  double a[TERMS][TERMS] = {{0}}, b[TERMS] = {0}, squares = 0, explained = 0;
  for (size_t i = 0; i < r->count; i++) {
    const equation *q = &r->equations[i];
    double y = driven(r, q, most, delay);
    squares += y * y;
    for (int k = 0; k < TERMS; k++) {
      b[k] += q->term[k] * y;
      for (int c = 0; c < TERMS; c++) a[k][c] += q->term[k] * q->term[c];
    }
  }
  memcpy(out, b, sizeof b);
  solve(a, out);
  for (int k = 0; k < TERMS; k++) explained += out[k] * b[k];
  return squares > 0 ? 1 - explained / squares : 1;
}

double ethd__fit_force(const ethd__evidence *e) {
  double most = 0, link[2] = {e->arm.link1, e->arm.link2};
  for (size_t i = 0; i < e->stretch_count; i++)
    for (size_t k = e->stretches[i].first; k < e->stretches[i].first + e->stretches[i].count; k++)
      for (int j = 0; j < 2; j++) most = fmax(most, fabs(e->torque[k][j]) / link[j]);
  return most;
}

typedef struct candidate {
  double left, limit, delay, term[TERMS];
} candidate;

static candidate best_delay(const regression *r, double limit) {
  candidate best = {.left = (double)INFINITY};
  for (int i = 0; i < DELAYS; i++) {
    candidate c = {.limit = limit, .delay = 0.25 * i * r->evidence->period};
    c.left = regress(r, limit, c.delay, c.term);
    if (c.left < best.left) best = c;
  }
  return best;
}

static ethd_plant start_of(const regression *r, const candidate *c, const ethd_plant *plant) {
  ethd_plant out = *plant;
  for (int j = 0; j < 2; j++) {
    double mass = c->term[j] / (r->link[j] * r->link[j]);
    out.mass[j] = mass > 2e-3 && mass < 500 ? mass : plant->mass[j];
  }
  out.coupling = 0;
  out.force_limit = c->limit;
  out.friction = fmax(c->term[RUB], 0.01);
  out.viscous = fmax(c->term[DRAG], 0.01);
  out.delay = c->delay;
  out.stiffness = (double)INFINITY;
  out.motor_mass = out.damping = 0;
  return out;
}

static int by_left(const void *a, const void *b) {
  double x = ((const candidate *)a)->left, y = ((const candidate *)b)->left;
  return (x > y) - (x < y);
}

int ethd__fit_starts(const ethd__evidence *e, const ethd_plant *plant, ethd_plant out[ETHD__STARTS]) {
  regression r = {.evidence = e, .link = {e->arm.link1, e->arm.link2}};
  candidate c[LIMITS];
  double force = ethd__fit_force(e);
  collect(&r);
  for (int i = 0; i < LIMITS; i++) c[i] = best_delay(&r, limits[i] * force);
  qsort(c, LIMITS, sizeof *c, by_left);
  for (int i = 0; i < ETHD__STARTS; i++) out[i] = start_of(&r, &c[i], plant);
  free(r.equations);
  return ETHD__STARTS;
}
