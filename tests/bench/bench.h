/* What all benchmarks share: clocks, races, percentiles, peers, CSV.

   A benchmark answers one question with a table on the terminal and DIR/WHAT.csv; tests/bench/WHAT.gp
   draws it. Times are those of this machine at this moment, so contenders race in turns and only ratios count. */
#ifndef ETHD_TESTS_BENCH_BENCH_H
#define ETHD_TESTS_BENCH_BENCH_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* One question. It exits if it can't be answered. `folder`: where the CSV goes; quick: under 15 s. */
typedef struct ethd__bench {
  const char *name;
  void (*run)(const char *folder, int quick);
} ethd__bench;

extern const ethd__bench ethd__bench_tick, ethd__bench_scene, ethd__bench_plant, ethd__bench_estimators,
    ethd__bench_kinematics;

/* Of the estimators: the finger's centre from 16 rays, where the finger is now, joint speed from counts. */
void ethd__bench_fits(const char *folder, int quick);
void ethd__bench_filters(const char *folder, int quick);
void ethd__bench_velocity(const char *folder, int quick);

/* Returns the cost of two clock readings in a row, ns: the median of many. */
double ethd__bench_clock_cost(void);

/* ---- races ---- */

/* work(data) does `items` things; ns is the time that one of them takes. */
typedef struct ethd__bench_entry {
  const char *name;
  void (*work)(void *data);
  void *data;
  double items;
  double ns;
} ethd__bench_entry;

/* Fills ns of all: they work in turns of about 0.2 ms for `seconds` each. The lower quartile of the turns
   counts, since nothing else has disturbed those. */
void ethd__bench_race(ethd__bench_entry *entries, size_t count, double seconds);

/* Results go here, so that no work is optimised away. */
extern volatile double ethd__bench_sink;

typedef struct ethd__bench_times {
  double mean, median, p99, p999, max; /* ns */
} ethd__bench_times;

/* Sorts `ns` in place. */
ethd__bench_times ethd__bench_percentiles(double *ns, size_t count);

/* ---- peers ---- */

/* Returns `symbol` of PEERS/NAME.so (tests/bench/peers/NAME.cc, tables in peers.h), or prints that it isn't there and
   returns NULL. */
const void *ethd__bench_peer(const char *name, const char *symbol);
void ethd__bench_peers_in(const char *folder);

/* ---- output ---- */

/* Opens folder/name.csv and writes '#' lines with machine, compiler, flags and version, then those of
   `about` (each ends in a newline), then `header`; exits if it can't. One is open at a time. */
FILE *ethd__bench_csv(const char *folder, const char *name, const char *about, const char *header);

/* Puts the table in its place; exits if any of it couldn't be written. */
void ethd__bench_close(void);

/* Sets what else the '#' lines say: commit, flags. */
void ethd__bench_about(const char *text);

/* Returns "met" or "MISSED". */
const char *ethd__bench_verdict(int met);

#endif
