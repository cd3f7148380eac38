/* Plain statistics, each by its name. [any]

   Quantiles: linear between order statistics (Hyndman and Fan's type 7). Confidence intervals: percentile
   bootstrap of the median (Efron 1979), 95 %; participants are drawn, with all their taps, since taps of a
   person are no independent sample. Paired: participants' medians under the one and the other strategy. The
   sign-flip test (Fisher 1935) is exact up to 16 participants. */
#ifndef ETHD_REPORT_STATS_H
#define ETHD_REPORT_STATS_H

#include <stddef.h>
#include <stdint.h>

#define ETHD_STATS_DRAWS 2000u
#define ETHD_STATS_FEW_DRAWS 200u /* of medians over more than 4000 taps */
#define ETHD_STATS_PAIRS 6u       /* participants below which no test is made: its smallest p is over 0.05 */

typedef struct ethd__summary5 {
  size_t n;
  double mean, sd; /* sample sd, n - 1; NaN of none, of fewer than two */
  double min, q1, median, q3, max;
} ethd__summary5;

/* Sorts the values. */
void ethd__summarise(double *values, size_t n, ethd__summary5 *out);

double ethd__quantile(const double *sorted, size_t n, double p);

typedef struct ethd__interval {
  double low, high; /* NaN of fewer than two participants */
  size_t people, draws;
} ethd__interval;

/* person[i] belongs to values[i], below `people`. */
ethd__interval ethd__bootstrap_median(const double *values, const uint32_t *person, size_t n, size_t people,
                                      uint64_t seed);

/* Differences of pairs: their mean, its bootstrap interval, the two-sided p of the sign-flip test (NaN: none
   is made). */
typedef struct ethd__paired {
  size_t n, positive;
  double mean, median, p;
  ethd__interval interval;
} ethd__paired;
void ethd__compare(const double *differences, size_t n, uint64_t seed, ethd__paired *out);

/* Shares of samples of `size`, drawn from the values, whose mean and sd lie at least as far on their side as
   these; two-sided, at most 1. */
void ethd__resample(const double *values, size_t n, size_t size, double mean, double sd, uint64_t seed,
                    double *mean_share, double *sd_share);

#endif
