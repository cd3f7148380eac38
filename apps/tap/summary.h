/* Figures of a cell: one law at one speed. */
#ifndef ETHD__APPS_TAP_SUMMARY_H
#define ETHD__APPS_TAP_SUMMARY_H

#include "tap/study.h"

typedef struct ethd__cell {
  const char *law;
  const ethd__speed *speed;
  ethd__result *results;
  size_t count;   /* taps done */
  bool by_finger; /* figures are those by the finger's rule, else by the study's */
} ethd__cell;

/* A figure of ethd__metrics, over the valid taps that have it. */
typedef struct ethd__figure {
  size_t n;
  double mean, sd; /* NaN with none, with fewer than two */
} ethd__figure;

#define ETHD_TAP_FIELD(name) offsetof(ethd__metrics, name)
ethd__figure ethd__cell_figure(const ethd__cell *cell, size_t field);

/* Returns the median over the same taps; NaN if there are none. */
double ethd__cell_median(const ethd__cell *cell, size_t field);

size_t ethd__cell_valid(const ethd__cell *cell);

/* Whether the ring stops before the wall: most taps that are valid by the finger are not by the ring, which was too slow
   there, or not there yet. */
bool ethd__cell_stops(const ethd__cell *cell);

/* Returns the share of the valid taps with this figure in [from, to); NaN if there are no valid taps. */
double ethd__cell_share(const ethd__cell *cell, size_t field, double from, double to);

/* Returns the valid tap nearest to the cell's means of v_rvo, v_of, d_max and v_rmin, each measured in its standard
   deviation; 0 without valid taps. */
size_t ethd__cell_typical(const ethd__cell *cell);

#endif
