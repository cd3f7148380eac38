#include "tap/summary.h"

#include <math.h>
#include <stdlib.h>

static const ethd__metrics *metrics_of(const ethd__cell *cell, size_t i) {
  return cell->by_finger ? &cell->results[i].finger : &cell->results[i].metrics;
}

static double value_of(const ethd__cell *cell, size_t i, size_t field) {
  return *(const double *)((const char *)metrics_of(cell, i) + field);
}

static bool is_valid(const ethd__cell *cell, size_t i) { return metrics_of(cell, i)->reason == ETHD_TAP_OK; }

static bool has(const ethd__cell *cell, size_t i, size_t field) {
  return is_valid(cell, i) && !isnan(value_of(cell, i, field));
}

ethd__figure ethd__cell_figure(const ethd__cell *cell, size_t field) {
  ethd__figure figure = {0, NAN, NAN};
  double sum = 0, squares = 0;
  for (size_t i = 0; i < cell->count; i++)
    if (has(cell, i, field)) figure.n++, sum += value_of(cell, i, field);
  if (!figure.n) return figure;
  figure.mean = sum / (double)figure.n;
  for (size_t i = 0; i < cell->count; i++) {
    if (!has(cell, i, field)) continue;
    double d = value_of(cell, i, field) - figure.mean;
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
    if (has(cell, i, field)) values[n++] = value_of(cell, i, field);
  qsort(values, n, sizeof *values, by_value);
  if (n) median = (values[(n - 1) / 2] + values[n / 2]) / 2;
  free(values);
  return median;
}

size_t ethd__cell_valid(const ethd__cell *cell) {
  size_t n = 0;
  for (size_t i = 0; i < cell->count; i++) n += is_valid(cell, i);
  return n;
}

bool ethd__cell_stops(const ethd__cell *cell) {
  size_t valid = 0, stopped = 0;
  for (size_t i = 0; i < cell->count; i++) {
    if (cell->results[i].finger.reason != ETHD_TAP_OK) continue;
    ethd__reason by_ring = cell->results[i].finger.by_ring;
    valid++;
    stopped += by_ring == ETHD_TAP_TOO_SLOW || by_ring == ETHD_TAP_EARLY_CONTACT || by_ring == ETHD_TAP_NO_CONTACT;
  }
  return 2 * stopped > valid;
}

double ethd__cell_share(const ethd__cell *cell, size_t field, double from, double to) {
  size_t n = 0, inside = 0;
  for (size_t i = 0; i < cell->count; i++) {
    if (!has(cell, i, field)) continue;
    double value = value_of(cell, i, field);
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
    if (!is_valid(cell, i)) continue;
    for (int f = 0; f < FIELDS; f++) {
      double d = (value_of(cell, i, fields[f]) - figures[f].mean) / figures[f].sd;
      if (figures[f].sd > 0) distance += d * d;
    }
    if (distance < least) least = distance, typical = i;
  }
  return typical;
}
