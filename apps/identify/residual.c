#include "identify/residual.h"

#include <math.h>
#include <string.h>

#define LOUD 1.25     /* times the residual of rounding: a larger residual isn't explained */
#define COLOURED 0.15 /* a correlation so far beyond the bound isn't made by rounding in slow stretches */

/* Returns whether the joint passes a count or more in a tick, where rounding is white. */
static bool is_quick(const ethd__shooting *p, const ethd__fit_window *w, int joint, double count) {
  double way = 0;
  for (size_t k = w->window.first + 1; k < w->window.first + (size_t)w->window.count; k++)
    way += fabs(p->evidence->q[k][joint] - p->evidence->q[k - 1][joint]);
  return way > count * w->window.count;
}

static double products(const double *a, int count, int joint, int lag) {
  double sum = 0;
  for (int k = 0; k + lag < count; k++) sum += a[2 * k + joint] * a[2 * (k + lag) + joint];
  return sum;
}

/* Returns the share of a white residual's sum of products at this lag that the fitted states remove; it isn't
   colour. */
static double taken(const ethd__shooting *p, const ethd__fit_window *w, int joint, int lag) {
  double sum = 0;
  int n = 2 * w->window.count;
  for (int i = 0; i < w->rank; i++)
    sum += products(p->basis + ETHD__STATES * w->row + i * n, w->window.count, joint, lag);
  return sum;
}

static void correlate(const ethd__shooting *p, double count, const double *residual, ethd__whiteness *out) {
  double sums[ETHD__LAGS + 1] = {0}, lost[ETHD__LAGS + 1] = {0}, ticks = 0;
  for (size_t i = 0; i < p->window_count; i++) {
    const ethd__fit_window *w = &p->windows[i];
    for (int j = 0; j < 2; j++) {
      if (!is_quick(p, w, j, count)) continue;
      ticks += w->window.count;
      for (int lag = 0; lag <= ETHD__LAGS; lag++) {
        sums[lag] += products(residual + w->row, w->window.count, j, lag);
        lost[lag] += taken(p, w, j, lag);
      }
    }
  }
  double variance = sums[0] / fmax(ticks - lost[0], 1);
  out->ticks = (size_t)ticks;
  out->bound = 1.96 / sqrt(fmax(ticks, 1));
  out->largest = 1;
  for (int lag = 1; lag <= ETHD__LAGS; lag++) {
    double c = variance > 0 ? (sums[lag] + lost[lag] * variance) / (variance * ticks) : 0;
    out->correlation[lag] = c;
    out->outside += fabs(c) > out->bound;
    if (fabs(c) > fabs(out->correlation[out->largest])) out->largest = lag;
  }
  out->correlation[0] = 1;
}

/* Fills the density: the mean of the windows' periodograms (Hann) over both joints. */
static void spread(const ethd__shooting *p, const double *residual, ethd__whiteness *out) {
  int length = 0;
  double windows = 0, T = p->evidence->period;
  for (size_t i = 0; i < p->window_count; i++)
    if (p->windows[i].window.count > length) length = p->windows[i].window.count;
  out->tones = length / 2 + 1 < ETHD__TONES ? length / 2 + 1 : ETHD__TONES;
  for (size_t i = 0; i < p->window_count; i++) {
    const ethd__fit_window *w = &p->windows[i];
    if (w->window.count != length) continue;
    windows += 2;
    for (int j = 0; j < 2; j++)
      for (int f = 0; f < out->tones; f++) {
        double re = 0, im = 0, turn = 2 * M_PI * f / length;
        for (int k = 0; k < length; k++) {
          double r = residual[w->row + 2 * (size_t)k + (size_t)j] * (0.5 - 0.5 * cos(2 * M_PI * (k + 0.5) / length));
          re += r * cos(turn * k);
          im += r * sin(turn * k);
        }
        out->density[f] += (re * re + im * im) * 2 * T / (0.375 * length);
      }
  }
  for (int f = 0; f < out->tones && windows > 0; f++) out->density[f] /= windows;
}

void ethd__whiteness_find(ethd__shooting *p, double count, double *residual, ethd__whiteness *out) {
  double at[ETHD__UNKNOWNS], sum = 0;
  memset(out, 0, sizeof *out);
  ethd__chosen_get(&p->chosen, &p->plant, at);
  ethd__shooting_residual(p, at, residual);
  for (size_t i = 0; i < p->rows; i++) sum += residual[i] * residual[i];
  out->rms = sqrt(sum / fmax((double)(p->rows - ethd__shooting_states(p)) - p->chosen.count, 1));
  out->floor = count / sqrt(12);
  correlate(p, count, residual, out);
  spread(p, residual, out);
  bool quiet = !(count > 0) || out->rms <= LOUD * out->floor;
  out->explained = quiet && fabs(out->correlation[out->largest]) <= out->bound + COLOURED;
}
