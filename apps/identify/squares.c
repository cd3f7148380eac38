/* Levenberg and Marquardt's method on the problem, by cminpack. */
#include <cminpack-1/cminpack.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "identify/fit.h"

#define IMPOSSIBLE 10 /* rad: every residual of an impossible plant */

typedef struct descent {
  ethd__shooting *problem;
  const char *what;
  uint64_t calls, most;
} descent;

/* Returns whether a plant with these coordinates is possible; if not, large residuals make the method step back. */
static bool is_possible(const ethd__shooting *p, const double *coordinates) {
  ethd_plant plant = p->plant;
  ethd__chosen_set(&p->chosen, coordinates, &plant);
  return ethd__arm_is_possible(p, &plant);
}

static int evaluate(void *search_, int m, int n, const double *x, double *residual, double *slopes, int ld, int flag) {
  descent *s = search_;
  (void)n;
  (void)ld;
  ethd__progress(++s->calls < s->most ? s->calls : s->most - 1, s->most, s->what);
  if (ethd__stop) return -1;
  if (flag == 2) {
    ethd__shooting_slopes(s->problem, x, slopes);
    return 0;
  }
  if (is_possible(s->problem, x)) {
    ethd__shooting_residual(s->problem, x, residual);
    return 0;
  }
  for (int i = 0; i < m; i++) residual[i] = IMPOSSIBLE;
  return 0;
}

static double *numbers(size_t count) {
  double *at = calloc(count ? count : 1, sizeof *at);
  if (!at) ethd__fail_memory();
  return at;
}

double ethd__fit_squares(ethd__shooting *p, int most, const char *what) {
  int m = (int)p->rows, n = p->chosen.count, calls = 0, slopes_taken = 0, order[ETHD__UNKNOWNS];
  double x[ETHD__UNKNOWNS], diag[ETHD__UNKNOWNS], qtf[ETHD__UNKNOWNS], wa[3][ETHD__UNKNOWNS], sum = 0;
  ETHD__FREED double *residual = numbers(p->rows), *slopes = numbers(p->rows * (size_t)n), *wa4 = numbers(p->rows);
  descent s = {p, what, 0, 2 * (uint64_t)most};
  ethd__chosen_get(&p->chosen, &p->plant, x);
  ethd__shooting_settle(p);
  if (n > 0)
    (void)lmder(evaluate, &s, m, n, x, residual, slopes, m, 1e-9, 1e-7, 0, most, diag, 1, 1, 0, &calls, &slopes_taken,
                order, qtf, wa[0], wa[1], wa[2], wa4);
  else
    ethd__shooting_residual(p, x, residual);
  ethd__progress(1, 1, what);
  ethd__chosen_set(&p->chosen, x, &p->plant);
  for (size_t i = 0; i < p->rows; i++) sum += residual[i] * residual[i];
  return sum;
}
