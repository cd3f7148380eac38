#include "identify/touch_follow.h"

#include <math.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "identify/fit.h"
#include "identify/touching.h"

#define STRANGE 4   /* standard deviations of a sum of squares: what leaves more doesn't follow the model */
#define BLATANT 8   /* the same before the numbers are fitted to it */
#define GUARD 0.012 /* s: braking begins so softly that it shows so much later */

/* s after the first reading that is near: touches are followed so far, farther from one fit to the next. */
static const double ends[] = {ETHD__TOUCH_SHORTEST, 0.025, 0.04, 0.055, ETHD__TOUCH_AFTER};
enum { ENDS = sizeof ends / sizeof *ends };

void ethd__touch_squares(ethd__shooting *p, double *squares) {
  double x[ETHD__UNKNOWNS], *residual = calloc(p->rows ? p->rows : 1, sizeof *residual);
  if (!residual) ethd__fail_memory();
  ethd__chosen_get(&p->chosen, &p->plant, x);
  ethd__shooting_residual(p, x, residual);
  for (size_t i = 0; i < p->window_count; i++) {
    const ethd__fit_window *w = &p->windows[i];
    squares[i] = 0;
    for (int k = 0; k < w->rows; k++) squares[i] += residual[w->row + (size_t)k] * residual[w->row + (size_t)k];
  }
  free(residual);
}

static double fit(ethd__shooting *p, const char *what) {
  double sum = ethd__fit_squares(p, ETHD__TOUCH_EVALUATIONS, what);
  ethd__shooting_settle(p);
  return sum;
}

typedef struct growth {
  ethd__shooting *problem;
  bool grows[ETHD__TOUCHES_MOST];                                 /* it is followed further */
  double squares[ETHD__TOUCHES_MOST], before[ETHD__TOUCHES_MOST]; /* left now, and at the end before */
  int freedom[ETHD__TOUCHES_MOST];                                /* of the latter */
} growth;

static int freedom_of(const ethd__fit_window *w) { return w->rows - w->rank; }

static void note(growth *g) {
  const ethd__shooting *p = g->problem;
  for (size_t i = 0; i < p->window_count; i++) {
    g->before[i] = g->squares[i];
    g->freedom[i] = freedom_of(&p->windows[i]);
  }
}

/* Whether what was added to touch i, or its beginning, leaves more than so many standard deviations too much. */
static bool is_strange(const growth *g, size_t i, double most) {
  double added = freedom_of(&g->problem->windows[i]) - g->freedom[i];
  return !(g->squares[i] - g->before[i] <= added + most * sqrt(2 * fmax(added, 1)));
}

/* Ends the touches that stopped to follow the model short of where they did; whether there were any. */
static bool end_strange(growth *g, int stage, double most) {
  ethd__shooting *p = g->problem;
  bool found = false;
  ethd__touch_squares(p, g->squares);
  for (size_t i = 0; i < p->window_count; i++) {
    if (!g->grows[i] || !is_strange(g, i, most)) continue;
    found = true;
    g->grows[i] = false;
    ethd__touching_end(p, i, fmax(ends[stage - 1] - GUARD, ends[0] - GUARD / 2));
  }
  if (!found) return false;
  ethd__shooting_ready(p);
  ethd__shooting_settle(p);
  return true;
}

static bool is_growing(const growth *g) {
  for (size_t i = 0; i < g->problem->window_count; i++)
    if (g->grows[i]) return true;
  return false;
}

/* Ends the touches that follow the model to the last: behind it nobody saw whether braking had begun. */
static void end_unseen(growth *g) {
  ethd__shooting *p = g->problem;
  for (size_t i = 0; i < p->window_count; i++)
    if (g->grows[i]) ethd__touching_end(p, i, ends[ENDS - 1] - GUARD);
  ethd__shooting_ready(p);
  ethd__shooting_settle(p);
}

/* Takes out the touches that are strange from their beginning on. */
static void leave_out(growth *g) {
  ethd__shooting *p = g->problem;
  size_t kept = 0, count = p->window_count;
  ethd__touch_squares(p, g->squares);
  for (size_t i = 0; i < count; i++) {
    if (is_strange(g, i, STRANGE)) continue;
    g->squares[kept] = g->squares[i];
    p->windows[kept++] = p->windows[i];
  }
  p->window_count = kept;
  if (kept == count) return;
  ethd__shooting_ready(p);
  (void)fit(p, "touches that are alike");
  ethd__touch_squares(p, g->squares);
}

double ethd__touch_follow(ethd__shooting *p) {
  growth g = {.problem = p};
  double sum = fit(p, "touches begin");
  leave_out(&g);
  for (size_t i = 0; i < p->window_count; i++) g.grows[i] = true;
  for (int stage = 1; stage < ENDS && is_growing(&g) && !ethd__stop; stage++) {
    note(&g);
    for (size_t i = 0; i < p->window_count; i++)
      if (g.grows[i]) ethd__touching_end(p, i, ends[stage]);
    ethd__shooting_ready(p);
    ethd__shooting_settle(p);
    (void)end_strange(&g, stage, BLATANT);
    sum = fit(p, "touches go on");
    if (end_strange(&g, stage, STRANGE)) sum = fit(p, "touches go on");
    ethd__touch_squares(p, g.squares);
  }
  if (!is_growing(&g) || ethd__stop) return sum;
  end_unseen(&g);
  return fit(p, "touches end");
}
