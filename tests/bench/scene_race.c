#include "bench/scene_race.h"
#include "clock.h"

#include <math.h>

enum { BLOCK = 100, BLOCKS = ETHD__BENCH_POINTS / BLOCK, CALM = 400, STRIDE_MAX = BLOCKS / 3 };
const size_t ethd__contest_sizes[SIZES] = {1, 10, 100, 1000, 10000, 100000};

static const ethd_vec *points_of(const ethd__contest *t, ethd__ask ask) {
  return ask == ETHD__COLD ? t->anywhere : t->path;
}

/* Returns how many queries a contender gets in a round, from 3 up to all: slow ones get fewer. */
static int affordable(const ethd__contest *t, double ns) {
  double budget = t->quick ? 2.5e6 : 2e7;
  return (int)fmin(ETHD__BENCH_POINTS, fmax(3, budget / ns));
}

static double ask_one(ethd__contest *t, int i, ethd__ask ask, int k) {
  int64_t start = ethd__clock_now();
  ethd__bench_sink = ethd__contender_nearest(&t->contenders[i], ask, points_of(t, ask)[k]);
  return fmax(0, (double)(ethd__clock_now() - start) - t->clock);
}

/* ---- hot: the mean without a clock in the loop ---- */

/* Queries go in blocks, and each block counts with its best time of all rounds, which nothing interrupted. */
typedef struct lap {
  int block, stride; /* queries in a block; one of `stride` blocks is run */
  double best[BLOCKS];
} lap;

static void start_lap(ethd__contest *t, int i, ethd__ask ask, lap *l) {
  double typical = INFINITY;
  for (int k = 0; k < 5; k++) typical = fmin(typical, ask_one(t, i, ask, 3900 * k));
  for (int k = 0; k < 50 && typical < 1e4; k++) typical = fmin(typical, ask_one(t, i, ask, 390 * k));
  int n = affordable(t, typical + 10);
  l->block = typical < 1e4 ? BLOCK : 1;
  l->stride = (int)fmin(STRIDE_MAX, fmax(1, ceil((double)(l->block * BLOCKS) / n)));
  for (int b = 0; b < BLOCKS; b++) l->best[b] = INFINITY;
}

static void run_block(ethd__contest *t, int i, ethd__ask ask, lap *l, int b) {
  const ethd_vec *x = points_of(t, ask) + BLOCK * b;
  ethd__scene_contender *c = &t->contenders[i];
  double sum = ethd__contender_nearest(c, ask, x[b ? -1 : 0]);
  int64_t start = ethd__clock_now();
  for (int k = 0; k < l->block; k++) sum += ethd__contender_nearest(c, ask, x[k]);
  double ns = (double)(ethd__clock_now() - start) - t->clock;
  ethd__bench_sink = sum;
  l->best[b] = fmin(l->best[b], ns / l->block);
}

static double mean_of(const lap *l) {
  double sum = 0;
  int n = 0;
  for (int b = l->stride - 1; b < BLOCKS; b += l->stride) sum += l->best[b], n++;
  return sum / n;
}

/* Contenders run in turns, each over all its blocks, so that caches and branch predictors are warm for it. */
static void race(ethd__contest *t, ethd__ask ask, ethd__race_result *results) {
  static lap laps[CONTENDERS];
  for (int i = 0; i < CONTENDERS; i++)
    if (results[i].there) start_lap(t, i, ask, &laps[i]);
  for (int r = 0; r < t->rounds; r++)
    for (int i = 0; i < CONTENDERS; i++)
      for (int b = laps[i].stride - 1; results[i].there && b < BLOCKS; b += laps[i].stride)
        run_block(t, i, ask, &laps[i], b);
  for (int i = 0; i < CONTENDERS; i++)
    if (results[i].there) results[i].mean = mean_of(&laps[i]);
}

/* ---- query by query, each at its best of the rounds, the clock taken off ---- */

static ethd__bench_times each_query(ethd__contest *t, int i, ethd__ask ask, double mean) {
  static double ns[ETHD__BENCH_POINTS];
  int count = affordable(t, mean + t->clock);
  for (int k = 0; k < count; k++) ns[k] = INFINITY;
  for (int r = 0; r < t->rounds / 4; r++)
    for (int k = 0; k < count; k++) ns[k] = fmin(ns[k], ask_one(t, i, ask, k));
  return ethd__bench_percentiles(ns, (size_t)count);
}

/* ---- cold: something else uses the caches in between ---- */

static void use_caches(void) {
  static char other[8 << 20];
  for (size_t i = 0; i < sizeof other; i += 64) other[i]++;
}

static ethd__bench_times calm_query(ethd__contest *t, int i, ethd__ask ask, double mean) {
  double ns[CALM];
  int count = (int)fmin(t->quick ? CALM / 8 : CALM, affordable(t, mean)), step = ETHD__BENCH_POINTS / count;
  for (int k = 0; k < count; k++) {
    ask_one(t, i, ask, step * k);
    use_caches();
    ns[k] = ask_one(t, i, ask, step * k + 1);
  }
  return ethd__bench_percentiles(ns, (size_t)count);
}

/* ---- one world ---- */

static void compare_answers(ethd__contest *t, int i, ethd__ask ask, ethd__race_result *r) {
  const ethd_vec *x = points_of(t, ask);
  for (int k = 0; k < affordable(t, 10 * r->mean); k++) {
    double d = ethd__contender_nearest(&t->contenders[i], ask, x[k]);
    if (i == OURS) t->expected[k] = d;
    double e = t->expected[k];
    if (!(d == e)) r->apart = fmax(r->apart, fabs(d - e));
  }
}

static void run_world(ethd__contest *t, ethd__world_kind kind, int size) {
  ethd__world world;
  double build[CONTENDERS];
  ethd__world_create(kind, ethd__contest_sizes[size], &world);
  t->contenders[OURS].chain = kind == ETHD__CONTOUR;
  for (int i = 0; i < CONTENDERS; i++) {
    build[i] = INFINITY;
    int there = i == OURS || (i == LOOSE ? kind == ETHD__CONTOUR : t->contenders[i].peer != NULL);
    for (int ask = 0; ask < ETHD__ASKS; ask++) t->results[kind][size][ask][i].there = there;
    for (int again = 0; there && again < (t->quick ? 2 : 5); again++) {
      if (again) ethd__contender_destroy(&t->contenders[i]);
      build[i] = fmin(build[i], ethd__contender_create(&t->contenders[i], &world));
    }
  }
  for (int ask = 0; ask < ETHD__ASKS; ask++) {
    ethd__race_result *results = t->results[kind][size][ask];
    race(t, (ethd__ask)ask, results);
    for (int i = 0; i < CONTENDERS; i++) {
      if (!results[i].there) continue;
      compare_answers(t, i, (ethd__ask)ask, &results[i]);
      results[i].each = each_query(t, i, (ethd__ask)ask, results[i].mean);
      if (size >= CALM_FROM) results[i].calm = calm_query(t, i, (ethd__ask)ask, results[i].mean);
      results[i].build = build[i];
      results[i].bytes = (double)ethd__contender_bytes(&t->contenders[i]);
    }
  }
  for (int i = 0; i < CONTENDERS; i++)
    if (t->results[kind][size][0][i].there) ethd__contender_destroy(&t->contenders[i]);
  ethd__world_destroy(&world);
}

void ethd__contest_run(ethd__contest *t) {
  t->rounds = t->quick ? 12 : 30;
  t->clock = ethd__bench_clock_cost();
  ethd__world_path(t->path);
  ethd__world_anywhere(t->anywhere);
  for (int kind = 0; kind < ETHD__WORLDS; kind++)
    for (int size = 0; size < SIZES; size++) run_world(t, (ethd__world_kind)kind, size);
}
