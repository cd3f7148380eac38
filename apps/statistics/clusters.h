/* Taps of people, and how sure a figure of them is: people are drawn with replacement, then taps of each person, since
   taps of one person are no independent sample (Davison and Hinkley 1997, 3.8). All [any]. */
#ifndef ETHD_STATISTICS_CLUSTERS_H
#define ETHD_STATISTICS_CLUSTERS_H

#include <stdbool.h>

#include "statistics/sample.h"

#define ETHD_CLUSTERS_DRAWS 2000u
#define ETHD_CLUSTERS_FEW_DRAWS 200u /* at least, where more would be more than 2e7 taps */

/* One tap; side 0 or 1 tells two samples apart that the same people made. */
typedef struct ethd__tapped {
  double value;
  uint32_t person, side;
} ethd__tapped;

typedef struct ethd__clusters {
  ethd__tapped *tap;  /* by value */
  size_t n, persons;  /* persons: those who have taps */
  size_t *of, *first; /* taps of person k and side s: of[first[2 k + s]] up to of[first[2 k + s + 1]] */
} ethd__clusters;

/* Sorts the taps, which stay the caller's and outlive the clusters. people: above every person. False: no memory. */
bool ethd__clusters_make(ethd__tapped *taps, size_t n, size_t people, ethd__clusters *out);
void ethd__clusters_free(ethd__clusters *clusters);

/* A figure of the taps in which tap i stands weight[i] times; time linear in them. */
typedef double ethd__clusters_figure(const ethd__clusters *clusters, const uint32_t *weight);

/* The median of all, of both sides as one. */
double ethd__clusters_median(const ethd__clusters *clusters, const uint32_t *weight);

/* Cliff's delta (1993): the share of pairs in which side 1 is larger, less the share in which it is smaller. */
double ethd__clusters_cliff(const ethd__clusters *clusters, const uint32_t *weight);

/* The figure of the taps themselves. */
double ethd__clusters_here(const ethd__clusters *clusters, ethd__clusters_figure *figure);

/* The figure of each of many draws, sorted; how many there are. A draw without the figure is left out. */
size_t ethd__clusters_draws(const ethd__clusters *clusters, ethd__clusters_figure *figure, uint64_t seed,
                            double out[ETHD_CLUSTERS_DRAWS]);

/* Their 95 % percentile interval; NaN of fewer than `fewest` people. */
ethd__interval ethd__clusters_bootstrap(const ethd__clusters *clusters, ethd__clusters_figure *figure, size_t fewest,
                                        uint64_t seed);

#endif
