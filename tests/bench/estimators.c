/* The estimators, one table after another. */
#include "bench/bench.h"

static void run(const char *folder, int quick) {
  ethd__bench_fits(folder, quick);
  printf("\n");
  ethd__bench_filters(folder, quick);
  printf("\n");
  ethd__bench_velocity(folder, quick);
}

const ethd__bench ethd__bench_estimators = {"estimators", run};
