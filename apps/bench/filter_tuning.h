/* What the finger filters' benchmark compares: contenders on tracks, and their best tuning. */
#ifndef ETHD__APPS_BENCH_FILTER_TUNING_H
#define ETHD__APPS_BENCH_FILTER_TUNING_H

#include "bench/tracks.h"
#include "ethd/estimate.h"

/* One method of finding where the finger is; it starts anew with every call. */
typedef struct ethd__filter_contender {
  const char *name;
  void (*work)(void *self, const double (*in)[3], double (*out)[2], size_t count);
  void *self;
} ethd__filter_contender;

/* Runs `self`, an ethd_filter. */
void ethd__filter_work(void *self, const double (*in)[3], double (*out)[2], size_t count);

/* Follows the line through the last two readings; doesn't use `self`. */
void ethd__two_readings(void *self, const double (*in)[3], double (*out)[2], size_t count);

/* Returns the rms error over both axes, m; the first 30 ms of a track don't count. */
double ethd__filter_contender_error(const ethd__filter_contender *c, const ethd__tracks *sets, size_t count);

/* Values of up to two rows of a method's table; all others have their defaults. */
typedef struct ethd__tuning {
  const char *row[2]; /* NULL: none */
  double value[2];
} ethd__tuning;

ethd_filter ethd__tuning_filter(ethd_filter_method method, const ethd__tuning *t);
double ethd__tuning_error(ethd_filter_method method, const ethd__tuning *t, const ethd__tracks *sets, size_t count);

/* Returns the best of a grid on these sets. */
ethd__tuning ethd__tuning_best(ethd_filter_method method, const ethd__tracks *sets, size_t count);

/* Returns a text such as "jerk 183 memory 0.16". */
const char *ethd__tuning_text(const ethd__tuning *t, char text[64]);

#endif
