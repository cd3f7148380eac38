/* The paper's figures and sentences, tested within people: a person has one number of each kind, and its contrasts
   between strategies and speeds are what is tested, never the pooled taps. */
#ifndef ETHD__APPS_TAP_CLAIMS_H
#define ETHD__APPS_TAP_CLAIMS_H

#include "tap/people.h"

#define ETHD_TAP_PARTS_MAX 3

/* How far two strategies may differ and still be called alike. */
typedef struct ethd__margins {
  double d_max;        /* m */
  double v_of, v_rmin; /* m/s */
} ethd__margins;

/* 0.3 mm, which the paper's sensors resolve; 0.02 m/s, below which it calls the ring static (v_th). */
extern const ethd__margins ethd__margins_default;

typedef struct ethd__sample {
  const ethd__cell *cells;
  size_t count, people; /* people: above every person of the cells */
  ethd__margins margins;
  uint64_t seed; /* of what is drawn */
} ethd__sample;

typedef enum ethd__verdict {
  ETHD_TAP_UNKNOWN,  /* its cells weren't run, or by fewer people than a test needs */
  ETHD_TAP_SHOWN,    /* p < 0.05, of a claim after Holm's correction */
  ETHD_TAP_OPEN,     /* neither this nor its contrary */
  ETHD_TAP_CONTRARY, /* a part of it is significantly the other way, or beyond its margin */
  ETHD_TAP_VERDICTS
} ethd__verdict;

extern const char *const ethd__verdict_words[ETHD_TAP_VERDICTS];

/* A mean of Table 1: shown to agree when people's mean lies within the paper's sd of the paper's mean (two one-sided
   t tests). */
typedef struct ethd__mean {
  const char *name, *unit;
  double paper, paper_sd;
  ethd__figure here;   /* of all taps */
  size_t people;       /* who have such a tap */
  double average;      /* mean of their means, */
  double low, high, p; /* with its 90 % interval */
  ethd__verdict verdict;
} ethd__mean;

enum { ETHD_TAP_MEANS = 4 };
void ethd__means(const ethd__sample *sample, ethd__mean out[ETHD_TAP_MEANS]);

/* A contrast of people's figures that must lie above `from`, below `to`, or between the two where both are finite. */
typedef struct ethd__claim_part {
  const char *what, *unit; /* "d_max: smooth - 3 offset" */
  double from, to;
  size_t people;
  double mean, low, high; /* 95 % */
  double p;               /* by `test`, two-sided but for "TOST" */
  double d_z;             /* mean/sd of contrasts that are compared with 0, else NaN */
  const char *test;       /* how p comes about; "": no test was made */
  size_t at[2];           /* of "overlap": people who have both strategies at low and at high speed, else 0 */
  ethd__verdict verdict;
} ethd__claim_part;

/* The tests: "sign flip" of people's values; "TOST", two one-sided t tests; "overlap", of a difference between speeds
   where fewer than ETHD_STATISTICS_PEOPLE have all of it, but as many have both strategies at each speed: then these
   people's differences are compared (ethd__overlapping); "bootstrap", of the threshold of early touches. A sentence
   holds when all its parts do: its p is the largest of theirs. */
typedef struct ethd__tap_claim {
  const char *text;
  ethd__claim_part part[ETHD_TAP_PARTS_MAX];
  size_t parts;
  double p, holm; /* holm: corrected for all claims that could be tested */
  ethd__verdict verdict;
} ethd__tap_claim;

enum { ETHD_TAP_CLAIMS = 10 };
void ethd__claims(const ethd__sample *sample, ethd__tap_claim out[ETHD_TAP_CLAIMS]);

const ethd__cell *ethd__cell_find(const ethd__cell *cells, size_t count, const char *law, const char *speed);

#endif
