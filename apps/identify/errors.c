/* How sure the numbers of a fit are. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "identify/fit.h"

#define N ETHD__UNKNOWNS
#define ALL UINT32_MAX /* recordings */
#define FEW 20         /* windows: a recording with fewer is judged with the rest */
#define STRANGE 0.05   /* a logarithm of a mass by which a recording of another device differs at least, */
#define CERTAIN 6      /* and so many standard errors */

typedef double square_matrix[N][N];

static double *numbers(size_t count) {
  double *at = calloc(count ? count : 1, sizeof *at);
  if (!at) ethd__fail_memory();
  return at;
}

/* Gauss and Jordan on a matrix with a unit diagonal; a coordinate that others explain to the last digits has no finite
   variance. */
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

/* Each window's pull on the coordinates, and the sum of its slopes' products; of all recordings or of one. Returns how many
   windows. */
static double gather(const ethd__shooting *p, uint32_t recording, const double *residual, const double *slopes,
                     square_matrix curvature, square_matrix pulls, double *whole) {
  int n = p->chosen.count;
  double count = 0;
  for (size_t i = 0; i < p->window_count; i++) {
    const ethd__fit_window *w = &p->windows[i];
    if (recording != ALL && w->window.recording != recording) continue;
    count++;
    double pull[N] = {0};
    for (size_t row = w->row; row < w->row + (size_t)w->rows; row++)
      for (int a = 0; a < n; a++) {
        double slope = slopes[(size_t)a * p->rows + row];
        pull[a] += slope * residual[row];
        for (int b = 0; b < n; b++) curvature[a][b] += slope * slopes[(size_t)b * p->rows + row];
      }
    for (int a = 0; a < n; a++) {
      whole[a] -= pull[a]; /* the residual falls where the prediction rises */
      for (int b = 0; b < n; b++) pulls[a][b] += pull[a] * pull[b];
    }
  }
  return count;
}

static double sandwich(square_matrix bread, square_matrix filling, int n, int i) {
  double sum = 0;
  for (int a = 0; a < n; a++)
    for (int b = 0; b < n; b++) sum += bread[i][a] * filling[a][b] * bread[b][i];
  return sum;
}

/* Few windows pull less than their true scatter, because the fit gave way to them: as much as leaving each out in turn would
   show (MacKinnon and White 1985). Errors and step of Gauss and Newton by the windows of one recording, or of all; how many windows these are. */
static double judge(const ethd__shooting *p, uint32_t recording, const double *residual, const double *slopes,
                    double *errors, double *step) {
  int n = p->chosen.count;
  double scale[N], whole[N] = {0}, sum = 0;
  square_matrix curvature = {{0}}, pulls = {{0}}, inverse;
  double windows = gather(p, recording, residual, slopes, curvature, pulls, whole);
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
  return windows;
}

/* Residuals and slopes at the problem's plant; freed by the caller. */
static double *measure(ethd__shooting *p, double **slopes) {
  double x[N], *residual = numbers(p->rows);
  *slopes = numbers(p->rows * (size_t)p->chosen.count);
  ethd__chosen_get(&p->chosen, &p->plant, x);
  ethd__shooting_slopes(p, x, *slopes);
  ethd__shooting_residual(p, x, residual);
  return residual;
}

void ethd__fit_errors(ethd__shooting *p, double errors[ETHD__UNKNOWNS], double step[ETHD__UNKNOWNS]) {
  double own[N], *slopes, *residual = measure(p, &slopes);
  (void)judge(p, ALL, residual, slopes, errors, step ? step : own);
  free(residual);
  free(slopes);
}

bool ethd__fit_stranger(ethd__shooting *p, uint32_t *recording, double *shift) {
  double errors[N], step[N], *slopes, *residual, most = STRANGE;
  bool found = false;
  if (p->evidence->recording_count < 2) return false;
  residual = measure(p, &slopes);
  for (uint32_t r = 0; r < p->evidence->recording_count; r++) {
    if (judge(p, r, residual, slopes, errors, step) < FEW) continue;
    for (int i = 0; i < p->chosen.count; i++) {
      if (p->chosen.at[i] != ETHD__MASS_X && p->chosen.at[i] != ETHD__MASS_Y) continue;
      if (!(fabs(step[i]) > most && fabs(step[i]) > CERTAIN * errors[i])) continue;
      found = true;
      most = fabs(step[i]);
      *shift = exp(step[i]) - 1;
      *recording = r;
    }
  }
  free(residual);
  free(slopes);
  return found;
}
