/* Standard errors of a fit's numbers. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "identify/fit.h"

#define N ETHD__UNKNOWNS
#define FEW 16       /* windows: a recording with fewer isn't fitted alone */
#define ALONE 20     /* evaluations of the fit of one recording alone */
#define STRANGE 0.05 /* recordings whose masses differ by more than this in their logarithm, */
#define CERTAIN 6    /* and by more than this number of standard errors, belong to different devices */

typedef double square_matrix[N][N];

static double *numbers(size_t count) {
  double *at = calloc(count ? count : 1, sizeof *at);
  if (!at) ethd__fail_memory();
  return at;
}

/* Inverts a matrix with a unit diagonal by Gauss and Jordan's method. A coordinate that depends on others, up to
   rounding, gets an infinite variance. */
static void invert(square_matrix a, square_matrix out, int n) {
  memset(out, 0, sizeof(square_matrix));
  for (int i = 0; i < n; i++) out[i][i] = 1;
  for (int i = 0; i < n; i++) {
    double pivot = a[i][i] > 1e-12 ? a[i][i] : 1e-300;
    for (int k = 0; k < n; k++) {
      a[i][k] /= pivot;
      out[i][k] /= pivot;
    }
    for (int r = 0; r < n; r++) {
      double factor = a[r][i];
      for (int k = 0; r != i && k < n; k++) {
        a[r][k] -= factor * a[i][k];
        out[r][k] -= factor * out[i][k];
      }
    }
  }
}

/* Fills each window's gradient (its slopes times its residuals), and the curvature: the sum of the products of
   slopes. */
static void gather(const ethd__shooting *p, const double *residual, const double *slopes, square_matrix curvature,
                   square_matrix pulls, double *whole) {
  int n = p->chosen.count;
  for (size_t i = 0; i < p->window_count; i++) {
    const ethd__fit_window *w = &p->windows[i];
    double pull[N] = {0};
    for (size_t row = w->row; row < w->row + (size_t)w->rows; row++)
      for (int a = 0; a < n; a++) {
        double slope = slopes[(size_t)a * p->rows + row];
        pull[a] += slope * residual[row];
        for (int b = 0; b < n; b++) curvature[a][b] += slope * slopes[(size_t)b * p->rows + row];
      }
    for (int a = 0; a < n; a++) {
      whole[a] -= pull[a]; /* minus, because the residual falls where the prediction rises */
      for (int b = 0; b < n; b++) pulls[a][b] += pull[a] * pull[b];
    }
  }
}

static double sandwich(square_matrix bread, square_matrix filling, int n, int i) {
  double sum = 0;
  for (int a = 0; a < n; a++)
    for (int b = 0; b < n; b++) sum += bread[i][a] * filling[a][b] * bread[b][i];
  return sum;
}

/* Fills standard errors and the step of Gauss and Newton. With few windows the fit follows each of them, so their
   gradients scatter too little; the correction leaves out one window at a time (MacKinnon and White 1985). */
static void judge(const ethd__shooting *p, const double *residual, const double *slopes, double *errors, double *step) {
  int n = p->chosen.count;
  double scale[N], whole[N] = {0}, sum = 0;
  square_matrix curvature = {{0}}, pulls = {{0}}, inverse;
  double windows = (double)p->window_count;
  gather(p, residual, slopes, curvature, pulls, whole);
  for (size_t i = 0; i < p->rows; i++) sum += residual[i] * residual[i];
  double freedom = (double)(p->rows - ethd__shooting_states(p)) - n, few = windows / fmax(windows - n, 1);
  for (int i = 0; i < n; i++) scale[i] = curvature[i][i] > 0 ? sqrt(curvature[i][i]) : 1;
  for (int a = 0; a < n; a++)
    for (int b = 0; b < n; b++) {
      curvature[a][b] /= scale[a] * scale[b];
      pulls[a][b] /= scale[a] * scale[b];
    }
  invert(curvature, inverse, n);
  for (int i = 0; i < n; i++) {
    double plain = inverse[i][i] * sum / fmax(freedom, 1);
    double robust = sandwich(inverse, pulls, n, i) * few * few;
    double variance = fmax(plain, robust);
    errors[i] = variance > 0 && isfinite(variance) ? sqrt(variance) / scale[i] : (double)INFINITY;
    step[i] = 0;
    for (int b = 0; b < n; b++) step[i] += inverse[i][b] * whole[b] / (scale[b] * scale[i]);
  }
}

/* Returns the residuals at the problem's plant, and fills the slopes; the caller frees both. */
static double *measure(ethd__shooting *p, double **slopes) {
  double x[N], *residual = numbers(p->rows);
  *slopes = numbers(p->rows * (size_t)p->chosen.count);
  ethd__chosen_get(&p->chosen, &p->plant, x);
  ethd__shooting_slopes(p, x, *slopes);
  ethd__shooting_residual(p, x, residual);
  return residual;
}

void ethd__fit_errors(ethd__shooting *p, double errors[ETHD__UNKNOWNS], double step[ETHD__UNKNOWNS]) {
  double own[N];
  ETHD__FREED double *slopes = NULL, *residual = measure(p, &slopes);
  judge(p, residual, slopes, errors, step ? step : own);
}

/* ---- recordings of another device ---- */

/* Fits the masses to the windows of one recording alone. Gives their logarithms and the standard errors of the
   logarithms. False: too few windows, or they don't determine the masses. */
static bool weigh(const ethd__shooting *p, uint32_t recording, double mass[2], double error[2]) {
  double errors[N];
  ethd__shooting own;
  ethd__shooting_part(p, recording, &own);
  bool enough = own.window_count >= FEW;
  if (enough) {
    (void)ethd__fit_squares(&own, ALONE, "each recording");
    ethd__fit_errors(&own, errors, NULL);
  }
  for (int j = 0; j < 2; j++) error[j] = (double)INFINITY;
  for (int i = 0; i < own.chosen.count && enough; i++) {
    ethd__unknown u = own.chosen.at[i];
    if (u != ETHD__MASS_X && u != ETHD__MASS_Y) continue;
    mass[u - ETHD__MASS_X] = ethd__unknown_to(u, ethd__unknown_value(&own.plant, u));
    error[u - ETHD__MASS_X] = errors[i];
  }
  ethd__shooting_close(&own);
  return isfinite(error[0] + error[1]);
}

/* Recordings of different devices have a large common residual, which says little about either; so each is fitted
   alone. */
bool ethd__fit_stranger(const ethd__shooting *p, uint32_t *recording, double *shift) {
  double mass[2], error[2], first[2], first_error[2], most = STRANGE;
  bool found = false, begun = false;
  for (uint32_t r = 0; r < p->evidence->recording_count && p->evidence->recording_count > 1; r++) {
    if (!weigh(p, r, mass, error)) continue;
    for (int j = 0; j < 2 && begun; j++) {
      double apart = mass[j] - first[j];
      if (!(fabs(apart) > most && fabs(apart) > CERTAIN * hypot(error[j], first_error[j]))) continue;
      found = true;
      most = fabs(apart);
      *shift = exp(apart) - 1;
      *recording = r;
    }
    if (begun) continue;
    begun = true;
    memcpy(first, mass, sizeof first);
    memcpy(first_error, error, sizeof first_error);
  }
  return found;
}
