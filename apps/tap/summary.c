#include "tap/summary.h"

#include <math.h>
#include <stdlib.h>

static double value_of(const ethd__result *result, size_t field) {
  return *(const double *)((const char *)&result->metrics + field);
}

static bool has(const ethd__result *result, size_t field) {
  return result->metrics.reason == ETHD_TAP_OK && !isnan(value_of(result, field));
}

ethd__figure ethd__cell_figure(const ethd__cell *cell, size_t field) {
  ethd__figure figure = {0, NAN, NAN};
  double sum = 0, squares = 0;
  for (size_t i = 0; i < cell->count; i++)
    if (has(&cell->results[i], field)) figure.n++, sum += value_of(&cell->results[i], field);
  if (!figure.n) return figure;
  figure.mean = sum / (double)figure.n;
  for (size_t i = 0; i < cell->count; i++) {
    if (!has(&cell->results[i], field)) continue;
    double d = value_of(&cell->results[i], field) - figure.mean;
    squares += d * d;
  }
  if (figure.n > 1) figure.sd = sqrt(squares / (double)(figure.n - 1));
  return figure;
}

static int by_value(const void *a, const void *b) {
  double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}

double ethd__cell_median(const ethd__cell *cell, size_t field) {
  double *values = malloc((cell->count + 1) * sizeof *values), median = NAN;
  size_t n = 0;
  if (!values) return NAN;
  for (size_t i = 0; i < cell->count; i++)
    if (has(&cell->results[i], field)) values[n++] = value_of(&cell->results[i], field);
  qsort(values, n, sizeof *values, by_value);
  if (n) median = (values[(n - 1) / 2] + values[n / 2]) / 2;
  free(values);
  return median;
}

size_t ethd__cell_valid(const ethd__cell *cell) {
  size_t n = 0;
  for (size_t i = 0; i < cell->count; i++) n += cell->results[i].metrics.reason == ETHD_TAP_OK;
  return n;
}

double ethd__cell_share(const ethd__cell *cell, size_t field, double from, double to) {
  size_t n = 0, inside = 0;
  for (size_t i = 0; i < cell->count; i++) {
    if (!has(&cell->results[i], field)) continue;
    double value = value_of(&cell->results[i], field);
    n++;
    inside += value >= from && value < to;
  }
  return n ? (double)inside / (double)n : NAN;
}

size_t ethd__cell_typical(const ethd__cell *cell) {
  static const size_t fields[] = {ETHD_TAP_FIELD(v_rvo), ETHD_TAP_FIELD(v_of), ETHD_TAP_FIELD(d_max),
                                  ETHD_TAP_FIELD(v_rmin)};
  enum { FIELDS = sizeof fields / sizeof *fields };
  ethd__figure figures[FIELDS];
  size_t typical = 0;
  double least = INFINITY;
  for (int f = 0; f < FIELDS; f++) figures[f] = ethd__cell_figure(cell, fields[f]);
  for (size_t i = 0; i < cell->count; i++) {
    double distance = 0;
    if (cell->results[i].metrics.reason != ETHD_TAP_OK) continue;
    for (int f = 0; f < FIELDS; f++) {
      double d = (value_of(&cell->results[i], fields[f]) - figures[f].mean) / figures[f].sd;
      if (figures[f].sd > 0) distance += d * d;
    }
    if (distance < least) least = distance, typical = i;
  }
  return typical;
}
