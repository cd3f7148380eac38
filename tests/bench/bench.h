/* What all benchmarks share: clocks, races, percentiles, peers, CSV.

   A benchmark answers one question with a table on the terminal and DIR/WHAT.csv; tests/bench/WHAT.gp
   draws it. Times are those of this machine at this moment, so contenders race in turns and only ratios count. */
#ifndef ETHD_TESTS_BENCH_BENCH_H
#define ETHD_TESTS_BENCH_BENCH_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* One question. It exits if it can't be answered. `folder`: where the CSV goes; quick: under 15 s. */
typedef struct bench {
  const char *name;
  void (*run)(const char *folder, int quick);
} bench;

extern const bench bench_tick, bench_scene, bench_plant, bench_estimators, bench_kinematics;

/* Of the estimators: the finger's centre from 16 rays, where the finger is now, joint speed from counts. */
void bench_fits(const char *folder, int quick);
void bench_filters(const char *folder, int quick);
void bench_velocity(const char *folder, int quick);

/* Of the kinematics: an arm in space, and its joints that follow. */
extern const double bench_ur5e[6][4]; /* a, alpha, d, angle: apps/config/ur5e.arm */
void bench_linkage(const char *folder, int quick);
void bench_following(const char *folder, int quick);

/* Returns the cost of two clock readings in a row, ns: the median of many. */
double bench_clock_cost(void);

/* ---- races ---- */

/* work(data) does `items` things; ns is the time that one of them takes. */
typedef struct bench_entry {
  const char *name;
  void (*work)(void *data);
  void *data;
  double items;
  double ns;
} bench_entry;

/* Fills ns of all: they work in turns of about 0.2 ms for `seconds` each. The lower quartile of the turns
   counts, since nothing else has disturbed those. */
void bench_race(bench_entry *entries, size_t count, double seconds);

/* Results go here, so that no work is optimised away. */
extern volatile double bench_sink;

typedef struct bench_times {
  double mean, median, p99, p999, max; /* ns */
} bench_times;

/* Sorts `ns` in place. */
bench_times bench_percentiles(double *ns, size_t count);

/* ---- peers ---- */

/* Returns `symbol` of PEERS/NAME.so (tests/bench/peers/NAME.cc, tables in peers.h), or prints that it isn't there and
   returns NULL. */
const void *bench_peer(const char *name, const char *symbol);
void bench_peers_in(const char *folder);

/* ---- output ---- */

/* Opens folder/name.csv and writes '#' lines with machine, compiler, flags and version, then those of
   `about` (each ends in a newline), then `header`; exits if it can't. One is open at a time. */
FILE *bench_csv(const char *folder, const char *name, const char *about, const char *header);

/* The header of run time against error, which race.gp draws. Words have no comma. */
#define BENCH_RACE "panel,method,time_ns,error"
void bench_row(FILE *csv, const char *panel, const char *method, double ns, double error);

/* Puts the table in its place; exits if any of it couldn't be written. */
void bench_close(void);

/* Sets what else the '#' lines say: commit, flags. */
void bench_about(const char *text);

/* Prints a goal of value <= most, and whether it is met. */
void bench_goal(const char *what, double value, double most, const char *unit);

/* Returns "met" or "MISSED". */
const char *bench_verdict(int met);

#endif
