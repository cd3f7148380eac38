/* How often the intervals of a report hold the truth, found by simulating studies whose truth is known. [any] */
#ifndef ETHD__APPS_STATISTICS_COVERAGE_H
#define ETHD__APPS_STATISTICS_COVERAGE_H

#include <stddef.h>
#include <stdint.h>

#define ETHD_COVERAGE_TAPS 3 /* taps of each person in each cell, as in the paper */

/* Shares of simulated studies whose 95 % interval holds the truth. */
typedef struct ethd__coverage {
  size_t people;
  double median, cliff; /* bootstrap of people, then of taps */
  double mean, effect;  /* Student's t of people's differences; d_z from the noncentral t */
} ethd__coverage;

/* Simulates `runs` studies. People, their responses to the strategy and their taps are normal with standard deviations
   1, 0.5 and 1; the strategy shifts the mean by 1. The first two intervals stay valid when any increasing function
   stretches the values; the other two need differences that are about normal. */
ethd__coverage ethd__coverage_of(size_t people, size_t runs, uint64_t seed);

/* Returns what a long run found (tests/README.md has its command) for the largest number of people in its table that
   is at most `people`; for three if there are fewer. */
const ethd__coverage *ethd__coverage_known(size_t people);

#endif
