/* The paper's figures and claims beside what was simulated. */
#ifndef ETHD_TAP_CLAIMS_H
#define ETHD_TAP_CLAIMS_H

#include "tap/summary.h"

#define ETHD_TAP_CLAIMS_MAX 16

typedef enum ethd__verdict { ETHD_TAP_UNKNOWN, ETHD_TAP_MET, ETHD_TAP_NOT_MET } ethd__verdict;

/* A mean of Table 1: met when |here - paper| <= the paper's sd + 2 standard errors of here. */
typedef struct ethd__mean {
  const char *name, *unit;
  double paper, paper_sd;
  ethd__figure here;
  double allowed; /* of the difference */
  ethd__verdict verdict;
} ethd__mean;

enum { ETHD_TAP_MEANS = 4 };
void ethd__means(const ethd__cell *cells, size_t count, ethd__mean out[ETHD_TAP_MEANS]);

typedef struct ethd__tap_claim {
  const char *text;
  char here[64];
  ethd__verdict verdict; /* unknown: its cells weren't run or hold too few valid taps */
} ethd__tap_claim;

/* How many were written. */
size_t ethd__claims(const ethd__cell *cells, size_t count, ethd__tap_claim out[ETHD_TAP_CLAIMS_MAX]);

const ethd__cell *ethd__cell_find(const ethd__cell *cells, size_t count, const char *law, const char *speed);

#endif
