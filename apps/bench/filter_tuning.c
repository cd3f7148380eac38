#include "bench/filter_tuning.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "ethd/ethd.h"

#define SETTLE 30 /* ticks: a filter starts at its first reading */

/* ---- contenders ---- */

void ethd__filter_work(void *self, const double (*in)[3], double (*out)[2], size_t count) {
  const ethd_filter *f = self;
  ethd_filter_state s;
  memset(&s, 0, sizeof s);
  for (size_t i = 0; i < count; i++) {
    ethd_vec x, v;
    ethd_filter_predict(f, &s, ETHD__TRACK_PERIOD);
    if (!isnan(in[i][2])) (void)!ethd_filter_update(f, &s, (ethd_vec){in[i][0], in[i][1]}, in[i][2]);
    ethd_filter_output(f, &s, &x, &v);
    out[i][0] = x.x;
    out[i][1] = x.y;
  }
}

void ethd__two_readings(void *self, const double (*in)[3], double (*out)[2], size_t count) {
  double x[2] = {0, 0}, v[2] = {0, 0}, age = 0;
  int known = 0;
  (void)self;
  for (size_t i = 0; i < count; i++) {
    age += ETHD__TRACK_PERIOD;
    if (!isnan(in[i][2])) {
      for (int k = 0; k < 2; k++) {
        v[k] = known ? (in[i][k] - x[k]) / (age - in[i][2]) : 0;
        x[k] = in[i][k];
      }
      age = in[i][2];
      known = 1;
    }
    for (int k = 0; k < 2; k++) out[i][k] = x[k] + v[k] * age;
  }
}

/* ---- error ---- */

typedef struct sum {
  double squares;
  double count;
} sum;

static double ticks_out[ETHD__TRACK_MAX][2];

static void add_errors(const ethd__filter_contender *c, const ethd__tracks *set, sum *to) {
  for (size_t t = 0; t < set->count; t++) {
    const ethd__track *track = &set->at[t];
    c->work(c->self, (const double(*)[3])track->in, ticks_out, track->count);
    for (size_t i = SETTLE; i < track->count; i++)
      for (int k = 0; k < 2; k++) {
        double e = ticks_out[i][k] - track->truth[i][k];
        to->squares += e * e;
        to->count += 1;
      }
  }
}

double ethd__filter_contender_error(const ethd__filter_contender *c, const ethd__tracks *sets, size_t count) {
  sum all = {0, 0};
  for (size_t s = 0; s < count; s++) add_errors(c, &sets[s], &all);
  return sqrt(all.squares / all.count);
}

/* ---- tuning ---- */

ethd_filter ethd__tuning_filter(ethd_filter_method method, const ethd__tuning *t) {
  const ethd_method *m = &ethd_filter_methods[method];
  double p[ETHD_PARAMS_MAX];
  ethd_filter f;
  ethd_error error;
  ethd_params_default(m->params, m->param_count, p);
  for (int i = 0; i < 2; i++)
    if (t->row[i]) p[ethd_params_find(m->params, m->param_count, t->row[i])] = t->value[i];
  if (ethd_filter_prepare(method, p, ETHD__TRACK_PERIOD, &f, &error) < 0)
    ethd__fail(ETHD_EXIT_FAILED, "%s: %s", error.name, ethd_status_sentence(error.status));
  return f;
}

double ethd__tuning_error(ethd_filter_method method, const ethd__tuning *t, const ethd__tracks *sets, size_t count) {
  ethd_filter f = ethd__tuning_filter(method, t);
  ethd__filter_contender c = {NULL, ethd__filter_work, &f};
  return ethd__filter_contender_error(&c, sets, count);
}

/* Tries the first row from `from` on, each value 1.25 times the one before, and the listed values of the second. */
ethd__tuning ethd__tuning_best(ethd_filter_method method, const ethd__tracks *sets, size_t count) {
  static const double memories[] = {0.04, 0.08, 0.16, 0.32, (double)INFINITY}, alphas[] = {0.4, 0.5, 0.6, 0.7, 0.8};
  static const struct {
    ethd__tuning t;
    const double *second;
    double from;
  } grids[ETHD_FILTER_COUNT] = {
      [ETHD_FILTER_CA] = {{{"jerk", "memory"}, {0, 0}}, memories, 60},
      [ETHD_FILTER_HOLD] = {{{NULL, NULL}, {0, 0}}, NULL, 0},
      [ETHD_FILTER_ALPHA_BETA] = {{{"beta", "alpha"}, {0, 0}}, alphas, 0.06},
      [ETHD_FILTER_CV] = {{{"acceleration", NULL}, {0, 0}}, NULL, 2},
  };
  ethd__tuning t = grids[method].t, best = t;
  double least = (double)INFINITY;
  for (int i = 0; t.row[0] && i < (grids[method].second ? 5 : 1); i++) {
    if (t.row[1]) t.value[1] = grids[method].second[i];
    t.value[0] = grids[method].from;
    for (int k = 0; k < 13; k++, t.value[0] *= 1.25) {
      double error = ethd__tuning_error(method, &t, sets, count);
      if (error < least) least = error, best = t;
    }
  }
  return best;
}

const char *ethd__tuning_text(const ethd__tuning *t, char text[64]) {
  text[0] = 0;
  for (int i = 0, at = 0; i < 2 && t->row[i]; i++)
    at += snprintf(text + at, 64 - (size_t)at, "%s%s %.3g", i ? " " : "", t->row[i], t->value[i]);
  return text;
}
