#include "statistics/coverage.h"

#include <math.h>
#include <stdlib.h>

#include "sim/random.h"
#include "statistics/clusters.h"
#include "statistics/distribution.h"
#include "statistics/paired.h"

#define MOVE 1.0   /* by which the strategy shifts the mean */
#define ANSWER 0.5 /* standard deviation, between people, of that shift */
#define TAPS ETHD_COVERAGE_TAPS
#define WITHOUT_LIMIT 2u /* people: with fewer a bootstrap makes no sense */

static const ethd__coverage known[] = {
    {3, 0.872, 0.911, 0.951, 0.948},
    {6, 0.946, 0.960, 0.954, 0.955},
    {12, 0.958, 0.977, 0.955, 0.953},
    {24, 0.967, 0.980, 0.956, 0.948},
};

const ethd__coverage *ethd__coverage_known(size_t people) {
  size_t i = sizeof known / sizeof *known - 1;
  while (i && known[i].people > people) i--;
  return &known[i];
}

static double middle_of_three(const double v[TAPS]) { return fmax(fmin(v[0], v[1]), fmin(fmax(v[0], v[1]), v[2])); }

/* Simulates one study: fills its taps of both sides, and each person's difference of medians. */
static void make_study(size_t people, uint64_t seed, uint64_t run, ethd__tapped *taps, double *difference) {
  ethd__sim_key key = {seed, run};
  uint32_t number = 0;
  for (size_t p = 0; p < people; p++) {
    double person = ethd__normal(key, ETHD_DRAW_MODEL, number++);
    double moved = MOVE + ANSWER * ethd__normal(key, ETHD_DRAW_MODEL, number++), middle[2];
    for (uint32_t side = 0; side < 2; side++) {
      double own[TAPS];
      for (int i = 0; i < TAPS; i++) {
        own[i] = person + (side ? moved : 0) + ethd__normal(key, ETHD_DRAW_MODEL, number++);
        *taps++ = (ethd__tapped){own[i], (uint32_t)p, side};
      }
      middle[side] = middle_of_three(own);
    }
    difference[p] = middle[1] - middle[0];
  }
}

static bool holds(ethd__interval i, double truth) { return i.low <= truth && truth <= i.high; }

/* Returns the interval of the median over side 0 alone, whose true value is 0. */
static ethd__interval of_one_side(const ethd__tapped *taps, size_t n, size_t people, uint64_t seed) {
  ethd__tapped *side = malloc((n + 1) * sizeof *side);
  ethd__interval out = {NAN, NAN, 0, 0};
  ethd__clusters clusters;
  size_t count = 0;
  for (size_t i = 0; side && i < n; i++)
    if (!taps[i].side) side[count++] = taps[i];
  if (side && ethd__clusters_make(side, count, people, &clusters)) {
    out = ethd__clusters_bootstrap(&clusters, ethd__clusters_median, WITHOUT_LIMIT, seed);
    ethd__clusters_free(&clusters);
  }
  free(side);
  return out;
}

ethd__coverage ethd__coverage_of(size_t people, size_t runs, uint64_t seed) {
  /* the median of three standard normal numbers has the variance 1 - sqrt(3)/pi */
  const double d_z = MOVE / sqrt(ANSWER * ANSWER + 2 * (1 - sqrt(3) / acos(-1)));
  const double cliff = 2 * ethd__normal_below(MOVE / sqrt(4 + ANSWER * ANSWER)) - 1;
  size_t n = people * 2 * TAPS, hits[4] = {0};
  ethd__tapped *taps = malloc((n + 1) * sizeof *taps);
  double *difference = malloc((people + 1) * sizeof *difference);
  for (uint64_t run = 0; taps && difference && run < runs; run++) {
    ethd__clusters clusters;
    ethd__paired paired;
    make_study(people, seed, run, taps, difference);
    hits[0] += holds(of_one_side(taps, n, people, seed + 1 + run), 0);
    if (ethd__clusters_make(taps, n, people, &clusters))
      hits[1] += holds(ethd__clusters_bootstrap(&clusters, ethd__clusters_cliff, WITHOUT_LIMIT, seed + 1 + run), cliff);
    ethd__clusters_free(&clusters);
    ethd__compare(difference, people, seed, &paired);
    hits[2] += holds(paired.interval, MOVE);
    hits[3] += holds(paired.effect, d_z);
  }
  free(taps);
  free(difference);
  double all = (double)runs;
  return (ethd__coverage){people, (double)hits[0] / all, (double)hits[1] / all, (double)hits[2] / all,
                          (double)hits[3] / all};
}
