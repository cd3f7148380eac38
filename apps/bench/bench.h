/* What all benchmarks share: a clock, percentiles, the machine's description, CSV. */
#ifndef ETHD_APPS_BENCH_H
#define ETHD_APPS_BENCH_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* One question that ethd-bench answers. `folder`: where CSV and pictures go; quick: under 20 s. */
typedef struct ethd__bench {
  const char *name, *brief;
  int (*run)(const char *folder, int quick); /* exit code */
} ethd__bench;

extern const ethd__bench ethd__bench_tick;

/* CLOCK_MONOTONIC, ns. */
int64_t ethd__bench_now(void);

/* What two clock reads in a row cost, ns: the smallest of many. */
double ethd__bench_clock_cost(void);

typedef struct ethd__bench_times {
  double mean, median, p99, p999, max; /* ns */
} ethd__bench_times;

/* Sorts `ns` in place. */
ethd__bench_times ethd__bench_percentiles(double *ns, size_t count);

/* Opens folder/name.csv with '#' lines that say machine, compiler, flags and version, then `header`;
   exits when it can't. */
FILE *ethd__bench_csv(const char *folder, const char *name, const char *header);

#endif
