/* Figures of one sample. Each random method of this room draws from its own stream of the given seed, so that the same
   data give the same figures. A figure that isn't defined is NaN. All [any]. */
#ifndef ETHD__APPS_STATISTICS_SAMPLE_H
#define ETHD__APPS_STATISTICS_SAMPLE_H

#include <stddef.h>
#include <stdint.h>

/* With fewer people no test is made and no bootstrap interval shown: the smallest two-sided p that the signs of five
   people can have is 0.0625, and the bootstrap's intervals of 95 % cover far less (coverage.h). */
#define ETHD_STATISTICS_PEOPLE 6u

/* What a random number is drawn for. */
enum { ETHD_DRAW_PERSON, ETHD_DRAW_TAP, ETHD_DRAW_SIGN, ETHD_DRAW_NINE, ETHD_DRAW_UNIFORM, ETHD_DRAW_MODEL };

/* Returns a number below `count`: number `index` of stream `stream` of draw `draw`. */
size_t ethd__draw_below(uint64_t seed, uint64_t draw, uint32_t stream, uint32_t index, size_t count);

typedef struct ethd__summary5 {
  size_t n;
  double mean, sd; /* sd with n - 1; the mean of no value is NaN, and so is the sd of fewer than two */
  double min, q1, median, q3, max;
} ethd__summary5;

/* Fills the figures, and sorts the values. Quantiles are linear between order statistics (Hyndman and Fan's type 7). */
void ethd__summarise(double *values, size_t n, ethd__summary5 *out);

double ethd__mean_of(const double *values, size_t n);
double ethd__sd_of(const double *values, size_t n);
double ethd__quantile(const double *sorted, size_t n, double p);
void ethd__sort(double *values, size_t n);

/* Draws samples of `size` from the values. Gives the shares of samples whose mean lies at least as far out as `mean`,
   and whose sd as `sd`; two-sided, at most 1. */
void ethd__resample(const double *values, size_t n, size_t size, double mean, double sd, uint64_t seed,
                    double share[2]);

typedef struct ethd__interval {
  double low, high; /* NaN: there is no interval */
  size_t people, draws;
} ethd__interval;

#endif
