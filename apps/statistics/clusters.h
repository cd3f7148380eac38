/* How sure a figure of people's taps is, by a bootstrap: people are drawn with replacement, then taps of each person,
   since taps of one person are not independent (Davison and Hinkley 1997, 3.8). All [any]. */
#ifndef ETHD__APPS_STATISTICS_CLUSTERS_H
#define ETHD__APPS_STATISTICS_CLUSTERS_H

#include <stdbool.h>

#include "statistics/sample.h"

#define ETHD_CLUSTERS_DRAWS 2000u
#define ETHD_CLUSTERS_FEW_DRAWS 200u /* draws that are made even if they are more than 2e7 taps in all */

/* One tap. `side`, 0 or 1, says to which of two samples it belongs; the same people made both. */
typedef struct ethd__tapped {
  double value;
  uint32_t person, side;
} ethd__tapped;

typedef struct ethd__clusters {
  ethd__tapped *tap;  /* sorted by value */
  size_t n, persons;  /* number of taps, and of the people who have any */
  size_t *of, *first; /* taps of person k and side s: of[first[2 k + s]] up to of[first[2 k + s + 1]] */
} ethd__clusters;

/* Sorts the taps, which stay the caller's and must outlive the clusters. `people` is larger than every person's number.
   Returns false when there is no memory. */
bool ethd__clusters_make(ethd__tapped *taps, size_t n, size_t people, ethd__clusters *out);
void ethd__clusters_free(ethd__clusters *clusters);

/* A figure of the taps, in which tap i counts weight[i] times; takes time linear in their number. */
typedef double ethd__clusters_figure(const ethd__clusters *clusters, const uint32_t *weight);

/* The median of all taps; both sides are one sample. */
double ethd__clusters_median(const ethd__clusters *clusters, const uint32_t *weight);

/* Cliff's delta (1993): the share of pairs in which side 1 is larger, minus the share in which it is smaller. */
double ethd__clusters_cliff(const ethd__clusters *clusters, const uint32_t *weight);

/* Returns the figure of the taps themselves. */
double ethd__clusters_here(const ethd__clusters *clusters, ethd__clusters_figure *figure);

/* Fills `out` with the figures of many draws, sorted, and returns how many there are. A draw whose figure is NaN is
   left out. */
size_t ethd__clusters_draws(const ethd__clusters *clusters, ethd__clusters_figure *figure, uint64_t seed,
                            double out[ETHD_CLUSTERS_DRAWS]);

/* Returns the 95 % percentile interval of the draws' figures; NaN with fewer than `fewest` people. */
ethd__interval ethd__clusters_bootstrap(const ethd__clusters *clusters, ethd__clusters_figure *figure, size_t fewest,
                                        uint64_t seed);

#endif
