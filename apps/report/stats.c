#include "report/stats.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sim/random.h"

enum { MEDIAN, MEAN, FLIP, RESAMPLE }; /* streams */
#define EXACT 16u
#define FLIPS 20000u

static int by_value(const void *a, const void *b) {
  double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}

double ethd__quantile(const double *sorted, size_t n, double p) {
  if (!n) return NAN;
  double at = p * (double)(n - 1), below = floor(at);
  size_t i = (size_t)below, j = i + 1 < n ? i + 1 : i;
  return sorted[i] + (at - below) * (sorted[j] - sorted[i]);
}

static double mean_of(const double *values, size_t n) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += values[i];
  return sum / (double)n;
}

static double sd_of(const double *values, size_t n, double mean) {
  double squares = 0;
  for (size_t i = 0; i < n; i++) squares += (values[i] - mean) * (values[i] - mean);
  return n > 1 ? sqrt(squares / (double)(n - 1)) : NAN;
}

void ethd__summarise(double *values, size_t n, ethd__summary5 *out) {
  *out = (ethd__summary5){n, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
  if (!n) return;
  qsort(values, n, sizeof *values, by_value);
  out->mean = mean_of(values, n);
  out->sd = sd_of(values, n, out->mean);
  out->min = values[0];
  out->q1 = ethd__quantile(values, n, 0.25);
  out->median = ethd__quantile(values, n, 0.5);
  out->q3 = ethd__quantile(values, n, 0.75);
  out->max = values[n - 1];
}

static size_t draw_below(ethd__sim_key key, uint32_t stream, uint32_t index, size_t count) {
  return (size_t)(ethd__uniform(key, stream, index) * (double)count);
}

static ethd__interval percentiles(double *draws, size_t count, size_t people) {
  qsort(draws, count, sizeof *draws, by_value);
  return (ethd__interval){ethd__quantile(draws, count, 0.025), ethd__quantile(draws, count, 0.975), people, count};
}

/* ---- medians ---- */

/* Values by person: first[p] to first[p + 1] of `sorted_by`. */
static void by_person(const double *values, const uint32_t *person, size_t n, size_t people, double *out,
                      size_t *first) {
  memset(first, 0, (people + 1) * sizeof *first);
  for (size_t i = 0; i < n; i++) first[person[i] + 1]++;
  for (size_t p = 0; p < people; p++) first[p + 1] += first[p];
  size_t *at = malloc((people + 1) * sizeof *at);
  if (!at) return;
  memcpy(at, first, (people + 1) * sizeof *at);
  for (size_t i = 0; i < n; i++) out[at[person[i]]++] = values[i];
  free(at);
}

static double draw_median(const double *values, const size_t *first, const size_t *who, size_t count, ethd__sim_key key,
                          double *room) {
  size_t n = 0;
  for (size_t i = 0; i < count; i++) {
    size_t p = who[draw_below(key, MEDIAN, (uint32_t)i, count)];
    for (size_t k = first[p]; k < first[p + 1]; k++) room[n++] = values[k];
  }
  qsort(room, n, sizeof *room, by_value);
  return ethd__quantile(room, n, 0.5);
}

/* Counts the people who have values, and the most taps that as many draws of people can hold. */
static size_t list_people(const size_t *first, size_t people, size_t *who, size_t *most) {
  size_t count = 0, largest = 0;
  for (size_t p = 0; p < people; p++) {
    size_t taps = first[p + 1] - first[p];
    if (taps) who[count++] = p;
    if (taps > largest) largest = taps;
  }
  *most = count * largest;
  return count;
}

ethd__interval ethd__bootstrap_median(const double *values, const uint32_t *person, size_t n, size_t people,
                                      uint64_t seed) {
  ethd__interval interval = {NAN, NAN, 0, 0};
  double *own = malloc((n + 1) * sizeof *own), *room = NULL, draws[ETHD_STATS_DRAWS];
  size_t *first = malloc((people + 1) * sizeof *first), *who = malloc((people + 1) * sizeof *who), most = 0;
  uint32_t count = n > 4000 ? ETHD_STATS_FEW_DRAWS : ETHD_STATS_DRAWS;
  if (own && first && who) {
    by_person(values, person, n, people, own, first);
    interval.people = list_people(first, people, who, &most);
    room = interval.people > 1 ? malloc(most * sizeof *room) : NULL;
    for (uint32_t k = 0; room && k < count; k++)
      draws[k] = draw_median(own, first, who, interval.people, (ethd__sim_key){seed, k}, room);
    if (room) interval = percentiles(draws, count, interval.people);
  }
  free(own);
  free(room);
  free(first);
  free(who);
  return interval;
}

/* ---- pairs ---- */

static double flipped(const double *differences, size_t n, uint64_t signs) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += signs >> i & 1 ? -differences[i] : differences[i];
  return fabs(sum);
}

static double drawn_flip(const double *differences, size_t n, ethd__sim_key key) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += ethd__uniform(key, FLIP, (uint32_t)i) < 0.5 ? -differences[i] : differences[i];
  return fabs(sum);
}

static double sign_flip(const double *differences, size_t n, uint64_t seed) {
  double here = flipped(differences, n, 0) * (1 - 1e-12);
  uint64_t as_far = 0, all = n <= EXACT ? (uint64_t)1 << n : FLIPS;
  for (uint64_t k = 0; k < all; k++)
    as_far += (n <= EXACT ? flipped(differences, n, k) : drawn_flip(differences, n, (ethd__sim_key){seed, k})) >= here;
  return n <= EXACT ? (double)as_far / (double)all : (double)(as_far + 1) / (double)(all + 1);
}

void ethd__compare(const double *differences, size_t n, uint64_t seed, ethd__paired *out) {
  double draws[ETHD_STATS_DRAWS], *copy = malloc((n + 1) * sizeof *copy);
  *out = (ethd__paired){.n = n, .mean = NAN, .median = NAN, .p = NAN, .interval = {NAN, NAN, n, 0}};
  if (!copy || !n) {
    free(copy);
    return;
  }
  memcpy(copy, differences, n * sizeof *copy);
  qsort(copy, n, sizeof *copy, by_value);
  out->median = ethd__quantile(copy, n, 0.5);
  free(copy);
  out->mean = mean_of(differences, n);
  for (size_t i = 0; i < n; i++) out->positive += differences[i] > 0;
  for (uint32_t k = 0; n > 1 && k < ETHD_STATS_DRAWS; k++) {
    draws[k] = 0;
    for (size_t i = 0; i < n; i++) draws[k] += differences[draw_below((ethd__sim_key){seed, k}, MEAN, (uint32_t)i, n)];
    draws[k] /= (double)n;
  }
  if (n > 1) out->interval = percentiles(draws, ETHD_STATS_DRAWS, n);
  if (n >= ETHD_STATS_PAIRS) out->p = sign_flip(differences, n, seed);
}

/* ---- samples of another study's size ---- */

void ethd__resample(const double *values, size_t n, size_t size, double mean, double sd, uint64_t seed,
                    double *mean_share, double *sd_share) {
  double *room = malloc((size + 1) * sizeof *room);
  size_t above[2] = {0, 0}, below[2] = {0, 0};
  *mean_share = *sd_share = NAN;
  if (!room || n < 2 || size < 2) {
    free(room);
    return;
  }
  for (uint32_t k = 0; k < ETHD_STATS_DRAWS; k++) {
    for (size_t i = 0; i < size; i++) room[i] = values[draw_below((ethd__sim_key){seed, k}, RESAMPLE, (uint32_t)i, n)];
    double m = mean_of(room, size), s = sd_of(room, size, m);
    above[0] += m >= mean, below[0] += m <= mean;
    above[1] += s >= sd, below[1] += s <= sd;
  }
  free(room);
  *mean_share = fmin(1, 2 * (double)(above[0] < below[0] ? above[0] : below[0]) / ETHD_STATS_DRAWS);
  *sd_share = fmin(1, 2 * (double)(above[1] < below[1] ? above[1] : below[1]) / ETHD_STATS_DRAWS);
}
