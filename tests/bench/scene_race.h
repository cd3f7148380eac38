/* Asks the scene's contenders and measures them. */
#ifndef ETHD_TESTS_BENCH_SCENE_RACE_H
#define ETHD_TESTS_BENCH_SCENE_RACE_H

#include "bench/bench.h"
#include "bench/scene_world.h"

enum { OURS, LOOSE, EMBREE, CGAL, CONTENDERS };
enum { SIZES = 6, CALM_FROM = 3 }; /* from this size on the caches matter */
extern const size_t ethd__contest_sizes[SIZES];

/* One contender's times in one world for one order of queries, ns. */
typedef struct ethd__race_result {
  int there;
  double mean, build, bytes, apart;
  ethd__bench_times each, calm; /* query by query; with cold caches */
} ethd__race_result;

typedef struct ethd__contest {
  ethd__scene_contender contenders[CONTENDERS];
  ethd_vec path[ETHD__BENCH_POINTS], anywhere[ETHD__BENCH_POINTS];
  double expected[ETHD__BENCH_POINTS];
  int rounds, quick;
  double clock;
  ethd__race_result results[ETHD__WORLDS][SIZES][ETHD__ASKS][CONTENDERS];
} ethd__contest;

/* Runs all worlds, sizes and ways to ask. Contenders that have a peer, or are ours, take part. */
void ethd__contest_run(ethd__contest *t);

#endif
