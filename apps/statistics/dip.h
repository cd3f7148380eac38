/* Is a sample one heap or more? All [any]. */
#ifndef ETHD_STATISTICS_DIP_H
#define ETHD_STATISTICS_DIP_H

#include "statistics/sample.h"

/* Hartigan's dip (Hartigan and Hartigan 1985): the largest distance between the sample's distribution function and the
   nearest one with a single mode. Sorted values; at least 1/(2 n). */
double ethd__dip(const double *sorted, size_t n);

/* The share of uniform samples of this size that have a larger dip; beyond 200 values, of samples of 200, scaled by the
   root of the size. NaN of fewer than eight values. */
double ethd__dip_share(double dip, size_t n, uint64_t seed);

/* Values that were counted in whole `grain`s: equal ones spread evenly over their grain, since equal values look like
   heaps of their own. Sorted in, sorted out. */
void ethd__dip_spread(double *sorted, size_t n, double grain);

#endif
