/* Figures of a cell: one law at one speed. */
#ifndef ETHD_TAP_SUMMARY_H
#define ETHD_TAP_SUMMARY_H

#include "tap/study.h"

typedef struct ethd__cell {
  const char *law;
  const ethd__speed *speed;
  ethd__result *results;
  size_t count; /* taps done */
} ethd__cell;

/* A figure of ethd__metrics, over the valid taps that have it. */
typedef struct ethd__figure {
  size_t n;
  double mean, sd; /* NaN of none, of fewer than two */
} ethd__figure;

#define ETHD_TAP_FIELD(name) offsetof(ethd__metrics, name)
ethd__figure ethd__cell_figure(const ethd__cell *cell, size_t field);

/* Over the same taps; NaN of none. */
double ethd__cell_median(const ethd__cell *cell, size_t field);

/* Standard error of the mean. */
double ethd__figure_error(const ethd__figure *figure);

size_t ethd__cell_valid(const ethd__cell *cell);

/* Share of the valid taps that have the figure and a value of it in [from, to); NaN of none. */
double ethd__cell_share(const ethd__cell *cell, size_t field, double from, double to);

/* The valid tap nearest to the cell's means of v_rvo, v_of, d_max and v_rmin, each in its sd; 0 without
   valid taps. */
size_t ethd__cell_typical(const ethd__cell *cell);

/* The commanded speed above which most taps touch early: of all thresholds the one that mistakes the
   fewest taps. NaN unless taps of both kinds are there. */
double ethd__cells_early_from(const ethd__cell *cells, size_t count);

#endif
