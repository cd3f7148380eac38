/* Tests of differences within people, one number for each person. All [any]. */
#ifndef ETHD__APPS_STATISTICS_PAIRED_H
#define ETHD__APPS_STATISTICS_PAIRED_H

#include <stdbool.h>

#include "statistics/sample.h"

/* What the differences say. With fewer than ETHD_STATISTICS_PEOPLE people no test is made, and its p is NaN. */
typedef struct ethd__paired {
  size_t n, positive;
  double mean, sd, median;
  ethd__interval interval; /* 95 % interval of the mean by Student's t, from three people on */
  double p;                /* two-sided, by flipping signs */
  double d_z;              /* mean/sd (Cohen 1988) */
  ethd__interval effect;   /* 95 % interval of d_z, from the noncentral t (Cumming and Finch 2001) */
} ethd__paired;
void ethd__compare(const double *differences, size_t n, uint64_t seed, ethd__paired *out);

/* Fisher's test (1935): of all ways to flip the signs of the differences, the share whose mean is at least as far from
   zero. Exact up to 16 people; with more, signs are drawn at random. */
double ethd__sign_flip(const double *differences, size_t n, uint64_t seed);

/* Equivalence (Schuirmann 1987): two one-sided t tests that the mean lies in (low, high). */
typedef struct ethd__equivalence {
  double p;         /* the larger p of the two tests, small when the mean lies within; NaN with fewer than two people */
  bool outside;     /* the whole 95 % interval of the mean lies outside of a margin */
  double low, high; /* the 90 % interval of the mean, which lies within the margins when p < 0.05 */
} ethd__equivalence;
ethd__equivalence ethd__equivalent(const double *values, size_t n, double low, double high);

/* Compares two means where some people are in both samples and some in one alone (Derrick, Russ, Toher and White 2017,
   with unequal variances). first[i] and second[i] are one person's values; NaN says that the person isn't in that
   sample. It is the paired t test if everybody is in both, and Welch's if nobody is. Who is missing must not depend on
   the values. */
typedef struct ethd__overlap {
  size_t first, second, both;   /* number of people in each sample, and in both */
  double difference, low, high; /* mean of the first minus mean of the second, with its 95 % interval */
  double freedom, p;            /* p: two-sided; with fewer than two people in a sample it is NaN, as the interval is */
} ethd__overlap;
ethd__overlap ethd__overlapping(const double *first, const double *second, size_t people);

/* Wilcoxon's signed rank test. Zeros take part in the ranking (Pratt 1959), and equal sizes share their mean rank.
   Exact up to 200 people, with ties too; with more, by the normal approximation. */
typedef struct ethd__signed_rank {
  size_t n, zeros;
  double above, below; /* sums of ranks */
  double p;            /* two-sided; NaN where all are zero */
} ethd__signed_rank;
ethd__signed_rank ethd__wilcoxon(const double *differences, size_t n);

/* Friedman's test of `columns` conditions; each row is a person. Returns chi square with the correction for ties, and
   its p from the distribution. NaN with fewer than two rows or columns, or if the values of each row are all equal. */
double ethd__friedman(const double *values, size_t rows, size_t columns, double *p);

/* Holm's correction (1979), in place. NaN stands for a test that wasn't made. */
void ethd__holm(double *p, size_t n);

/* Fills the ranks, from 1; equal values share the mean of theirs. */
void ethd__rank(const double *values, size_t n, double *out);

#endif
