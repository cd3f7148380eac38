#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "statistics/distribution.h"
#include "statistics/paired.h"

#define EXACT_RANKS 200u

typedef struct ranked {
  double value;
  size_t index;
} ranked;

static int by_rank(const void *a, const void *b) {
  double p = ((const ranked *)a)->value, q = ((const ranked *)b)->value;
  return (p > q) - (p < q);
}

void ethd__rank(const double *values, size_t n, double *out) {
  ranked *order = malloc((n + 1) * sizeof *order);
  if (!order) {
    for (size_t i = 0; i < n; i++) out[i] = NAN;
    return;
  }
  for (size_t i = 0; i < n; i++) order[i] = (ranked){values[i], i};
  qsort(order, n, sizeof *order, by_rank);
  for (size_t i = 0, j; i < n; i = j) {
    for (j = i; j < n && order[j].value == order[i].value; j++) continue;
    for (size_t k = i; k < j; k++) out[order[k].index] = (double)(i + 1 + j) / 2;
  }
  free(order);
}

/* ---- Wilcoxon ---- */

/* The exact two-sided p of a rank sum: each rank is in the sum or not, with equal chances. Twice a rank is a whole
   number. */
static double exact_tail(const double *rank, size_t n, double at) {
  size_t most = 0, twice = (size_t)(2 * at + 0.5);
  for (size_t i = 0; i < n; i++) most += (size_t)(2 * rank[i] + 0.5);
  double *share = calloc(most + 1, sizeof *share), below = 0, above = 0;
  if (!share) return NAN;
  share[0] = 1;
  for (size_t i = 0, sum = 0; i < n; i++) {
    size_t step = (size_t)(2 * rank[i] + 0.5);
    sum += step;
    for (size_t k = sum + 1; k-- > 0;) share[k] = (share[k] + (k >= step ? share[k - step] : 0)) / 2;
  }
  for (size_t k = 0; k <= most; k++) {
    if (k <= twice) below += share[k];
    if (k >= twice) above += share[k];
  }
  free(share);
  return fmin(1, 2 * fmin(below, above));
}

static double normal_tail(const double *rank, size_t n, double at) {
  double sum = 0, squares = 0;
  for (size_t i = 0; i < n; i++) sum += rank[i], squares += rank[i] * rank[i];
  return fmin(1, 2 * ethd__normal_below(-fabs(at - sum / 2) / sqrt(squares / 4)));
}

ethd__signed_rank ethd__wilcoxon(const double *differences, size_t n) {
  ethd__signed_rank out = {.n = n, .p = NAN};
  double *size = calloc(n + 1, sizeof *size), *rank = malloc((n + 1) * sizeof *rank);
  size_t used = 0;
  if (size && rank) {
    for (size_t i = 0; i < n; i++) size[i] = fabs(differences[i]);
    ethd__rank(size, n, rank);
    for (size_t i = 0; i < n; i++) {
      if (differences[i] > 0) out.above += rank[i];
      if (differences[i] < 0) out.below += rank[i];
      if (differences[i] != 0) rank[used++] = rank[i];
    }
    out.zeros = n - used;
    if (used) out.p = used <= EXACT_RANKS ? exact_tail(rank, used, out.above) : normal_tail(rank, used, out.above);
  }
  free(size);
  free(rank);
  return out;
}

/* ---- Friedman ---- */

double ethd__friedman(const double *values, size_t rows, size_t columns, double *p) {
  double *sum = calloc(columns + 1, sizeof *sum), *rank = malloc((columns + 1) * sizeof *rank);
  double n = (double)rows, k = (double)columns, between = 0, within = 0, chi = NAN;
  if (sum && rank && rows > 1 && columns > 1) {
    for (size_t r = 0; r < rows; r++) {
      ethd__rank(values + r * columns, columns, rank);
      for (size_t c = 0; c < columns; c++) {
        sum[c] += rank[c];
        within += (rank[c] - (k + 1) / 2) * (rank[c] - (k + 1) / 2);
      }
    }
    for (size_t c = 0; c < columns; c++) between += (sum[c] - n * (k + 1) / 2) * (sum[c] - n * (k + 1) / 2);
    if (within > 0) chi = (k - 1) * between / within;
  }
  free(sum);
  free(rank);
  *p = ethd__chi_square_above(chi, k - 1);
  return chi;
}
