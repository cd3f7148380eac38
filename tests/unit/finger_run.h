/* A filter follows a path: readings at 300 Hz with noise and latency, ticks at 1 kHz. */
#ifndef ETHD_TESTS_FINGER_RUN_H
#define ETHD_TESTS_FINGER_RUN_H

#include <string.h>

#include "draw.h"
#include "ethd/estimate.h"

#define RUN_T 1e-3
#define RUN_NOISE 0.1e-3
#define RUN_SETTLE 0.03 /* s that don't count: the filter starts at its first reading */

typedef struct finger_path {
  ethd_vec (*at)(const void *data, double t);
  const void *data;
  double duration;
} finger_path;

typedef struct finger_error {
  double sum; /* of squares over both axes, m^2 */
  long count;
  long gated;
} finger_error;

static inline double finger_rms(finger_error e) { return 1e3 * sqrt(e.sum / (double)e.count); }

/* Row `row` of the method's table set to value, all others at their defaults. */
static inline ethd_filter finger_filter(ethd_filter_method method, const char *row, double value) {
  double p[ETHD_PARAMS_MAX];
  const ethd_method *m = &ethd_filter_methods[method];
  ethd_filter f;
  memset(&f, 0, sizeof f);
  ethd_params_default(m->params, m->param_count, p);
  if (row) p[ethd_params_find(m->params, m->param_count, row)] = value;
  if (ethd_filter_prepare(method, p, RUN_T, &f, NULL) != ETHD_OK) f.method = ETHD_FILTER_COUNT;
  return f;
}

static inline void finger_run(const ethd_filter *f, const finger_path *path, double latency, uint64_t seed,
                              finger_error *error) {
  ethd_filter_state s;
  memset(&s, 0, sizeof s);
  double next = draw(seed << 20, 0, 1.0 / 300);
  uint64_t i = 1;
  for (int k = 1; k * RUN_T < path->duration; k++) {
    double now = k * RUN_T;
    ethd_filter_predict(f, &s, RUN_T);
    for (; next + latency <= now; next += 1.0 / 300, i++) {
      ethd_vec x = path->at(path->data, next);
      x.x += RUN_NOISE * draw_normal((seed << 20) + 2 * i);
      x.y += RUN_NOISE * draw_normal((seed << 20) + 2 * i + 1);
      if (ethd_filter_update(f, &s, x, now - next) != ETHD_OK) error->gated++;
    }
    if (now < RUN_SETTLE) continue;
    ethd_vec x, v, truth = path->at(path->data, now);
    ethd_filter_output(f, &s, &x, &v);
    x = ethd_vec_sub(x, truth);
    error->sum += ethd_vec_dot(x, x);
    error->count += 2;
  }
}

/* The best of a row's values from `from`, each 1.3 times the one before. */
static inline double finger_best(ethd_filter_method method, const char *row, double from, int steps,
                                 const finger_path *paths, int count, double latency, double *best_value) {
  double best = INFINITY, value = from;
  for (int i = 0; i < steps; i++, value *= 1.3) {
    ethd_filter f = finger_filter(method, row, value);
    finger_error e = {0, 0, 0};
    for (int k = 0; k < count; k++) finger_run(&f, &paths[k], latency, (uint64_t)k, &e);
    if (finger_rms(e) < best) best = finger_rms(e), *best_value = value;
  }
  return best;
}

static const double finger_latencies[] = {0, 3e-3, 6e-3};

#endif
