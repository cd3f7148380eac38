/* How often the intervals of a report hold the truth, found by simulating studies whose truth is known. [any] */
#ifndef ETHD_STATISTICS_COVERAGE_H
#define ETHD_STATISTICS_COVERAGE_H

#include <stddef.h>
#include <stdint.h>

#define ETHD_COVERAGE_TAPS 3 /* of a person in a cell, as the paper has them */

/* Shares of simulated studies whose 95 % interval holds the truth. */
typedef struct ethd__coverage {
  size_t people;
  double median, cliff; /* bootstrap of people, then of taps */
  double mean, effect;  /* Student's t of people's differences; d_z from the noncentral t */
} ethd__coverage;

/* Simulates `runs` studies: person, person's answer to the strategy and tap are normal with sd 1, 0.5 and 1, the
   strategy moves the mean by 1. Two of the intervals do not change when the values are stretched by any increasing
   function, the other two need differences that are about normal. */
ethd__coverage ethd__coverage_of(size_t people, size_t runs, uint64_t seed);

/* What a long run found (tests/README.md has its command), for as many people or the next fewer; of six people or
   fewer, that for six or three. */
const ethd__coverage *ethd__coverage_known(size_t people);

#endif
