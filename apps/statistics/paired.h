/* Differences within people: one number a person. All [any]. */
#ifndef ETHD_STATISTICS_PAIRED_H
#define ETHD_STATISTICS_PAIRED_H

#include <stdbool.h>

#include "statistics/sample.h"

/* What the differences say. Tests are made from ETHD_STATISTICS_PEOPLE on, else their p is NaN. */
typedef struct ethd__paired {
  size_t n, positive;
  double mean, sd, median;
  ethd__interval interval; /* of the mean: Student's t, 95 %, from three people on */
  double p;                /* two-sided: the signs flipped */
  double d_z;              /* mean/sd (Cohen 1988) */
  ethd__interval effect;   /* of d_z: from the noncentral t, 95 % (Cumming and Finch 2001) */
} ethd__paired;
void ethd__compare(const double *differences, size_t n, uint64_t seed, ethd__paired *out);

/* Fisher's test (1935): the share of ways to flip the signs that leave a mean at least as far from zero. Exact up to 16
   people, by drawn signs beyond. */
double ethd__sign_flip(const double *differences, size_t n, uint64_t seed);

/* Equivalence (Schuirmann 1987): two one-sided t tests that the mean lies in (low, high). */
typedef struct ethd__equivalence {
  double p;         /* the larger of the two: small where the mean is within; NaN of fewer than two people */
  bool outside;     /* the 95 % interval of the mean lies beyond a margin, as a whole */
  double low, high; /* the 90 % interval of the mean, that lies within the margins when p < 0.05 */
} ethd__equivalence;
ethd__equivalence ethd__equivalent(const double *values, size_t n, double low, double high);

/* Two means of which some people are in both samples and some in one alone (Derrick, Russ, Toher and White 2017, with
   unequal variances): first[i] and second[i] are a person's, NaN: the person isn't in that sample. Everybody in both makes
   it the paired t test, nobody in both Welch's. Who is missing must not depend on the values. */
typedef struct ethd__overlap {
  size_t first, second, both;   /* people */
  double difference, low, high; /* mean of the first less mean of the second, with its 95 % interval */
  double freedom, p;            /* p: two-sided; NaN, as the interval, of fewer than two people in a sample */
} ethd__overlap;
ethd__overlap ethd__overlapping(const double *first, const double *second, size_t people);

/* Wilcoxon's signed rank test: zeros take part in the ranking (Pratt 1959), equal sizes share their mean rank. Exact up
   to 200 people, ties or not; normal beyond. */
typedef struct ethd__signed_rank {
  size_t n, zeros;
  double above, below; /* sums of ranks */
  double p;            /* two-sided; NaN where all are zero */
} ethd__signed_rank;
ethd__signed_rank ethd__wilcoxon(const double *differences, size_t n);

/* Friedman's test of `columns` conditions, a row a person: chi square with the correction for ties, p from its
   distribution. NaN of fewer than two rows or columns, or where no row tells its columns apart. */
double ethd__friedman(const double *values, size_t rows, size_t columns, double *p);

/* Holm's correction (1979), in place. NaN is a test that wasn't made. */
void ethd__holm(double *p, size_t n);

/* Mean ranks, from 1; equal values share theirs. */
void ethd__rank(const double *values, size_t n, double *out);

#endif
