#include "statistics/clusters.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WORK 2e7

static int by_tap(const void *a, const void *b) {
  const ethd__tapped *p = a, *q = b;
  if (p->value != q->value) return (p->value > q->value) - (p->value < q->value);
  if (p->person != q->person) return (p->person > q->person) - (p->person < q->person);
  return (p->side > q->side) - (p->side < q->side);
}

/* Numbers the people who have taps, from 0; seen[person] becomes the number. */
static size_t number_people(const ethd__tapped *taps, size_t n, size_t people, uint32_t *seen) {
  size_t count = 0;
  memset(seen, 0, people * sizeof *seen);
  for (size_t i = 0; i < n; i++) seen[taps[i].person] = 1;
  for (size_t p = 0; p < people; p++)
    if (seen[p]) seen[p] = (uint32_t)count++;
  return count;
}

bool ethd__clusters_make(ethd__tapped *taps, size_t n, size_t people, ethd__clusters *out) {
  uint32_t *seen = malloc((people + 1) * sizeof *seen);
  *out = (ethd__clusters){.tap = taps, .n = n};
  if (!seen) return false;
  if (n) qsort(taps, n, sizeof *taps, by_tap);
  out->persons = number_people(taps, n, people, seen);
  out->of = malloc((n + 1) * sizeof *out->of);
  out->first = calloc(2 * out->persons + 3, sizeof *out->first);
  if (!out->of || !out->first) {
    free(seen);
    ethd__clusters_free(out);
    return false;
  }
  /* first[j + 1] is the beginning of list j now, and moves to its end as the list fills */
  for (size_t i = 0; i < n; i++) out->first[2 * seen[taps[i].person] + taps[i].side + 2]++;
  for (size_t j = 2; j < 2 * out->persons + 3; j++) out->first[j] += out->first[j - 1];
  for (size_t i = 0; i < n; i++) out->of[out->first[2 * seen[taps[i].person] + taps[i].side + 1]++] = i;
  free(seen);
  return true;
}

void ethd__clusters_free(ethd__clusters *c) {
  free(c->of);
  free(c->first);
  *c = (ethd__clusters){0};
}

/* ---- figures ---- */

double ethd__clusters_median(const ethd__clusters *c, const uint32_t *weight) {
  uint64_t all = 0, below = 0;
  double lower = NAN;
  for (size_t i = 0; i < c->n; i++) all += weight[i];
  for (size_t i = 0; i < c->n; i++) {
    if (!weight[i]) continue;
    below += weight[i];
    if (isnan(lower) && 2 * below >= all) lower = c->tap[i].value;
    if (2 * below > all) return (lower + c->tap[i].value) / 2;
  }
  return NAN;
}

double ethd__clusters_cliff(const ethd__clusters *c, const uint32_t *weight) {
  double passed[2] = {0, 0}, sum = 0;
  for (size_t i = 0, j; i < c->n; i = j) { /* i to j: taps of one value */
    double here[2] = {0, 0};
    for (j = i; j < c->n && c->tap[j].value == c->tap[i].value; j++) here[c->tap[j].side] += weight[j];
    sum += here[1] * passed[0] - here[0] * passed[1];
    passed[0] += here[0], passed[1] += here[1];
  }
  return passed[0] > 0 && passed[1] > 0 ? sum / (passed[0] * passed[1]) : NAN;
}

double ethd__clusters_here(const ethd__clusters *c, ethd__clusters_figure *figure) {
  uint32_t *weight = malloc((c->n + 1) * sizeof *weight);
  if (!weight) return NAN;
  for (size_t i = 0; i < c->n; i++) weight[i] = 1;
  double value = figure(c, weight);
  free(weight);
  return value;
}

/* ---- drawing ---- */

/* Draws as many people as there are, then as many taps of each as that person has; each draw adds 1 to the tap's
   weight. */
static void draw_once(const ethd__clusters *c, uint64_t seed, uint64_t draw, uint32_t *weight) {
  uint32_t tap = 0;
  memset(weight, 0, c->n * sizeof *weight);
  for (size_t k = 0; k < c->persons; k++) {
    size_t who = ethd__draw_below(seed, draw, ETHD_DRAW_PERSON, (uint32_t)k, c->persons);
    for (size_t list = 2 * who; list < 2 * who + 2; list++) {
      size_t first = c->first[list], count = c->first[list + 1] - first;
      for (size_t i = 0; i < count; i++)
        weight[c->of[first + ethd__draw_below(seed, draw, ETHD_DRAW_TAP, tap++, count)]]++;
    }
  }
}

size_t ethd__clusters_draws(const ethd__clusters *c, ethd__clusters_figure *figure, uint64_t seed,
                            double out[ETHD_CLUSTERS_DRAWS]) {
  uint32_t *weight = malloc((c->n + 1) * sizeof *weight);
  size_t count = (size_t)fmin(ETHD_CLUSTERS_DRAWS, fmax(ETHD_CLUSTERS_FEW_DRAWS, WORK / (double)(c->n + 1))), kept = 0;
  for (size_t k = 0; weight && c->n && k < count; k++) {
    draw_once(c, seed, k, weight);
    out[kept] = figure(c, weight);
    kept += !isnan(out[kept]);
  }
  free(weight);
  ethd__sort(out, kept);
  return kept;
}

ethd__interval ethd__clusters_bootstrap(const ethd__clusters *c, ethd__clusters_figure *figure, size_t fewest,
                                        uint64_t seed) {
  double draws[ETHD_CLUSTERS_DRAWS];
  ethd__interval out = {NAN, NAN, c->persons, 0};
  if (c->persons < fewest) return out;
  out.draws = ethd__clusters_draws(c, figure, seed, draws);
  out.low = ethd__quantile(draws, out.draws, 0.025), out.high = ethd__quantile(draws, out.draws, 0.975);
  return out;
}
