/* The estimators, one table after another. */
#include "bench/bench.h"

static void run(const char *folder, int quick) {
  bench_fits(folder, quick);
  printf("\n");
  bench_filters(folder, quick);
  printf("\n");
  bench_velocity(folder, quick);
}

const bench bench_estimators = {"estimators", run};
