/* Does a sample have one mode or several? All [any]. */
#ifndef ETHD__APPS_STATISTICS_DIP_H
#define ETHD__APPS_STATISTICS_DIP_H

#include "statistics/sample.h"

/* Hartigan's dip (Hartigan and Hartigan 1985): the largest distance between the distribution function of the sorted
   values and the nearest one with a single mode. It is at least 1/(2 n). */
double ethd__dip(const double *sorted, size_t n);

/* Returns the share of uniform samples of size n whose dip is larger. Beyond 200 values samples of 200 stand for them,
   scaled by the square root of the size. NaN with fewer than eight values. */
double ethd__dip_share(double dip, size_t n, uint64_t seed);

/* Spreads equal ones of the sorted values evenly over `grain`, the step in which they were measured, because equal
   values look like modes of their own. They stay sorted. */
void ethd__dip_spread(double *sorted, size_t n, double grain);

#endif
