/* Figures of one sample. Whatever is random in this room draws from its own stream of the seed it is given, so that
   the same data give the same figures. NaN is the answer where a figure isn't defined. All [any]. */
#ifndef ETHD_STATISTICS_SAMPLE_H
#define ETHD_STATISTICS_SAMPLE_H

#include <stddef.h>
#include <stdint.h>

/* People below which no test is made and no bootstrap interval shown: the smallest two-sided p that five people's
   signs can have is 0.0625, and the bootstrap's 95 % cover far less (coverage.h). */
#define ETHD_STATISTICS_PEOPLE 6u

/* What a random number is drawn for. */
enum { ETHD_DRAW_PERSON, ETHD_DRAW_TAP, ETHD_DRAW_SIGN, ETHD_DRAW_NINE, ETHD_DRAW_UNIFORM, ETHD_DRAW_MODEL };

/* Below count, from number `index` of that stream of draw `draw`. */
size_t ethd__draw_below(uint64_t seed, uint64_t draw, uint32_t stream, uint32_t index, size_t count);

typedef struct ethd__summary5 {
  size_t n;
  double mean, sd; /* sample sd, n - 1; NaN of none, of fewer than two */
  double min, q1, median, q3, max;
} ethd__summary5;

/* Sorts the values. Quantiles are linear between order statistics (Hyndman and Fan's type 7). */
void ethd__summarise(double *values, size_t n, ethd__summary5 *out);

double ethd__mean_of(const double *values, size_t n);
double ethd__sd_of(const double *values, size_t n);
double ethd__quantile(const double *sorted, size_t n, double p);
void ethd__sort(double *values, size_t n);

/* Shares of samples of `size`, drawn from the values, whose mean and sd lie at least as far on their side as
   these; two-sided, at most 1. */
void ethd__resample(const double *values, size_t n, size_t size, double mean, double sd, uint64_t seed,
                    double share[2]);

typedef struct ethd__interval {
  double low, high; /* NaN: none is given */
  size_t people, draws;
} ethd__interval;

#endif
