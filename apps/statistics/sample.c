#include "statistics/sample.h"

#include <math.h>
#include <stdlib.h>

#include "sim/random.h"

#define DRAWS 2000u

size_t ethd__draw_below(uint64_t seed, uint64_t draw, uint32_t stream, uint32_t index, size_t count) {
  return (size_t)(ethd__uniform((ethd__sim_key){seed, draw}, stream, index) * (double)count);
}

static int by_value(const void *a, const void *b) {
  double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}

void ethd__sort(double *values, size_t n) {
  if (n) qsort(values, n, sizeof *values, by_value);
}

double ethd__quantile(const double *sorted, size_t n, double p) {
  if (!n) return NAN;
  double at = p * (double)(n - 1), below = floor(at);
  size_t i = (size_t)below, j = i + 1 < n ? i + 1 : i;
  return sorted[i] + (at - below) * (sorted[j] - sorted[i]);
}

double ethd__mean_of(const double *values, size_t n) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += values[i];
  return n ? sum / (double)n : NAN;
}

double ethd__sd_of(const double *values, size_t n) {
  double squares = 0, mean = ethd__mean_of(values, n);
  for (size_t i = 0; i < n; i++) squares += (values[i] - mean) * (values[i] - mean);
  return n > 1 ? sqrt(squares / (double)(n - 1)) : NAN;
}

void ethd__summarise(double *values, size_t n, ethd__summary5 *out) {
  *out = (ethd__summary5){n, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
  if (!n) return;
  ethd__sort(values, n);
  out->mean = ethd__mean_of(values, n);
  out->sd = ethd__sd_of(values, n);
  out->min = values[0];
  out->q1 = ethd__quantile(values, n, 0.25);
  out->median = ethd__quantile(values, n, 0.5);
  out->q3 = ethd__quantile(values, n, 0.75);
  out->max = values[n - 1];
}

void ethd__resample(const double *values, size_t n, size_t size, double mean, double sd, uint64_t seed,
                    double share[2]) {
  double *room = malloc((size + 1) * sizeof *room);
  size_t above[2] = {0, 0}, below[2] = {0, 0};
  share[0] = share[1] = NAN;
  if (!room || n < 2 || size < 2) {
    free(room);
    return;
  }
  for (uint32_t k = 0; k < DRAWS; k++) {
    for (size_t i = 0; i < size; i++) room[i] = values[ethd__draw_below(seed, k, ETHD_DRAW_NINE, (uint32_t)i, n)];
    double m = ethd__mean_of(room, size), s = ethd__sd_of(room, size);
    above[0] += m >= mean, below[0] += m <= mean;
    above[1] += s >= sd, below[1] += s <= sd;
  }
  free(room);
  for (int i = 0; i < 2; i++) share[i] = fmin(1, 2 * (double)(above[i] < below[i] ? above[i] : below[i]) / DRAWS);
}
