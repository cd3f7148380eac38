/* Filters by name of method and rows, fed along x and -x at once. */
#ifndef ETHD_TESTS_FINGER_FILTERS_H
#define ETHD_TESTS_FINGER_FILTERS_H

#include <check.h>
#include <string.h>

#include "draw.h"
#include "ethd/estimate.h"

#define T 1e-3

/* The rows that the method has are set, all others at their defaults. */
static inline ethd_filter with(ethd_filter_method method, const char *const *names, const double *values) {
  double p[ETHD_PARAMS_MAX];
  const ethd_method *m = &ethd_filter_methods[method];
  ethd_filter f;
  ethd_error error;
  ethd_params_default(m->params, m->param_count, p);
  for (; names && *names; names++, values++) {
    int row = ethd_params_find(m->params, m->param_count, *names);
    if (row >= 0) p[row] = *values;
  }
  ck_assert_msg(ethd_filter_prepare(method, p, T, &f, &error) == ETHD_OK, "%s %g", error.name, error.found);
  return f;
}

static inline ethd_status feed(const ethd_filter *f, ethd_filter_state *s, double x, double age) {
  return ethd_filter_update(f, s, (ethd_vec){x, -x}, age);
}

static inline double out_x(const ethd_filter *f, const ethd_filter_state *s) {
  ethd_vec x, v;
  ethd_filter_output(f, s, &x, &v);
  ck_assert_double_eq_tol(x.y, -x.x, 1e-18);
  return x.x;
}

static inline double out_v(const ethd_filter *f, const ethd_filter_state *s) {
  ethd_vec x, v;
  ethd_filter_output(f, s, &x, &v);
  return v.x;
}

/* Ramp a + b t read `age` s late, 3 ticks apart. */
static inline void ramp(const ethd_filter *f, ethd_filter_state *s, double b, double age) {
  for (int k = 0; k < 6000; k++) {
    ethd_filter_predict(f, s, T);
    if (k % 3 == 0) ck_assert_int_eq(feed(f, s, b * (k * T - age), age), ETHD_OK);
  }
}

#endif
