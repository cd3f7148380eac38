/* The filters against their contract: every method, every compensation, what is refused. */
#include "finger_filters.h"
#include "unit/suite.h"

static const char *const compensation[] = {"compensation", "gate", "latency", NULL};
static const double none[] = {ETHD_COMPENSATION_NONE, INFINITY, 0};
static const double stamp[] = {ETHD_COMPENSATION_STAMP, INFINITY, 0};

/* ---- the contract, every method ---- */

/* On a ramp the stamp takes the latency away; without it the estimate stands b age behind. */
TEST_LOOP(test_latency_on_a_ramp, 0, ETHD_FILTER_COUNT) {
  const double b = 0.4, age = 5e-3, last = 5999 * T;
  const double more[] = {ETHD_COMPENSATION_STAMP, INFINITY, 2e-3};
  ethd_filter a = with((ethd_filter_method)_i, compensation, stamp),
              c = with((ethd_filter_method)_i, compensation, none);
  ethd_filter d = with((ethd_filter_method)_i, compensation, more);
  ethd_filter_state s[3];
  memset(s, 0, sizeof s);
  ramp(&a, &s[0], b, age);
  ramp(&c, &s[1], b, age);
  ramp(&d, &s[2], b, age);
  if (_i == ETHD_FILTER_HOLD) {
    for (int k = 0; k < 3; k++) ck_assert_double_eq_tol(out_x(&a, &s[k]), b * (5997 * T - age), 1e-12);
    ck_assert(out_v(&a, &s[0]) == 0);
    return;
  }
  ck_assert_double_eq_tol(out_x(&a, &s[0]), b * last, 1e-9);
  ck_assert_double_eq_tol(out_x(&c, &s[1]), b * (last - age), 1e-9);
  ck_assert_double_eq_tol(out_x(&d, &s[2]), b * (last + 2e-3), 1e-9);
  for (int k = 0; k < 3; k++) ck_assert_double_eq_tol(out_v(&a, &s[k]), b, 1e-7);
}

/* With stamps it doesn't matter when a reading arrives, only that they come in order. */
TEST_LOOP(test_arrival_does_not_matter, 0, ETHD_FILTER_COUNT) {
  ethd_filter f = with((ethd_filter_method)_i, compensation, stamp);
  ethd_filter_state a, b;
  memset(&a, 0, sizeof a);
  memset(&b, 0, sizeof b);
  int due = 0;
  for (int k = 0; k < 900; k++) {
    double z = 0.2 * sin(0.02 * k);
    ethd_filter_predict(&f, &a, T);
    ethd_filter_predict(&f, &b, T);
    if (k % 3 == 0) ck_assert_int_eq(feed(&f, &a, z, 0), ETHD_OK);
    for (; due * 3 <= k - (due % 5) * 2; due++) /* up to 8 ticks late, several at once */
      ck_assert_int_eq(feed(&f, &b, 0.2 * sin(0.06 * due), (k - 3 * due) * T), ETHD_OK);
  }
  for (; due * 3 < 900; due++) ck_assert_int_eq(feed(&f, &b, 0.2 * sin(0.06 * due), (899 - 3 * due) * T), ETHD_OK);
  ck_assert_double_eq_tol(out_x(&f, &a), out_x(&f, &b), 1e-11);
  ck_assert_double_eq_tol(out_v(&f, &a), out_v(&f, &b), 1e-9);
  for (int i = 0; i < 6; i++) ck_assert_double_le(fabs(a.cov[i] - b.cov[i]), 1e-9 * fabs(a.cov[i]));
}

/* Older than the last one used, or the same again: nothing changes but the count. */
TEST_LOOP(test_late, 0, ETHD_FILTER_COUNT) {
  for (int mode = 0; mode < 2; mode++) {
    ethd_filter f = with((ethd_filter_method)_i, compensation, mode ? none : stamp);
    ethd_filter_state s, before;
    memset(&s, 0, sizeof s);
    ck_assert_int_eq(feed(&f, &s, 0.1, 3e-3), ETHD_OK);
    for (int k = 0; k < 4; k++) ethd_filter_predict(&f, &s, T);
    ck_assert_int_eq(feed(&f, &s, 0.11, 2e-3), ETHD_OK);
    ethd_filter_predict(&f, &s, T);
    before = s;
    ck_assert_int_eq(feed(&f, &s, 5, 3.5e-3), ETHD_STATUS_STALE);
    ck_assert_int_eq(feed(&f, &s, 5, s.age), ETHD_STATUS_STALE);
    before.late = 2;
    ck_assert_mem_eq(&s, &before, sizeof s);
    ck_assert_uint_eq(s.used, 2);
    ck_assert_int_eq(feed(&f, &s, 0.111, 2.9e-3), ETHD_OK);
  }
}

/* A start is known for now: with stamps a reading from before says nothing new; without, it counts. */
TEST_LOOP(test_start, 0, ETHD_FILTER_COUNT) {
  for (int mode = 0; mode < 2; mode++) {
    const double known[] = {mode ? ETHD_COMPENSATION_NONE : ETHD_COMPENSATION_STAMP, INFINITY, 1e-3};
    ethd_filter f = with((ethd_filter_method)_i, compensation, known);
    int ordered = !mode && _i != ETHD_FILTER_HOLD;
    ethd_filter_state s;
    memset(&s, 0, sizeof s);
    s.used = 3;
    ethd_filter_start(&f, &s, (ethd_vec){0.5, -0.5}, (ethd_vec){0.25, 0});
    ck_assert(out_x(&f, &s) == 0.5 && out_v(&f, &s) == 0.25);
    ethd_filter_predict(&f, &s, T);
    ck_assert_int_eq(feed(&f, &s, 0.5, 1.5e-3), ordered ? ETHD_STATUS_STALE : ETHD_OK);
    ck_assert_uint_eq(s.used, ordered ? 3 : 4);
  }
}

/* Unstarted, it starts at the first reading, whatever its age; two more give the speed. */
TEST_LOOP(test_starts_itself, 0, ETHD_FILTER_COUNT) {
  ethd_filter f = with((ethd_filter_method)_i, compensation, stamp);
  ethd_filter_state s;
  memset(&s, 0, sizeof s);
  for (int k = 0; k < 7; k++) ethd_filter_predict(&f, &s, T);
  ck_assert_int_eq(feed(&f, &s, 0.3, 20e-3), ETHD_OK);
  ck_assert(s.started == 1 && s.used == 1);
  ck_assert(out_x(&f, &s) == 0.3 && out_v(&f, &s) == 0);
  if (_i != ETHD_FILTER_CV && _i != ETHD_FILTER_CA) return;
  for (int k = 1; k < 4; k++) ck_assert_int_eq(feed(&f, &s, 0.3 + 0.5 * k / 300, 20e-3 - k / 300.0), ETHD_OK);
  ck_assert_double_eq_tol(out_v(&f, &s), 0.5, 0.05);
}

TEST_LOOP(test_not_finite_is_not_used, 0, ETHD_FILTER_COUNT) {
  const double bad[] = {NAN, INFINITY, -INFINITY};
  ethd_filter f = with((ethd_filter_method)_i, compensation, stamp);
  ethd_filter_state s, before;
  memset(&s, 0, sizeof s);
  for (int i = 0; i < 3; i++) ck_assert_int_eq(feed(&f, &s, bad[i], 0), ETHD_STATUS_STALE);
  ck_assert_uint_eq(s.started, 0);
  ck_assert_int_eq(feed(&f, &s, 0.1, 0), ETHD_OK);
  ethd_filter_predict(&f, &s, 4 * T);
  before = s;
  for (int i = 0; i < 12; i++) {
    ck_assert_int_eq(feed(&f, &s, bad[i % 3], 0), ETHD_STATUS_STALE);
    ck_assert_int_eq(ethd_filter_update(&f, &s, (ethd_vec){0.1, bad[i % 3]}, 0), ETHD_STATUS_STALE);
    ck_assert_int_eq(ethd_filter_update(&f, &s, (ethd_vec){0.1, -0.1}, bad[i % 3]), ETHD_STATUS_STALE);
  }
  before.gated = 3 + 36;
  ck_assert_mem_eq(&s, &before, sizeof s);
}

/* ---- set-up ---- */

TEST(test_tables) {
  for (int m = 0; m < ETHD_FILTER_COUNT; m++) {
    const ethd_method *method = &ethd_filter_methods[m];
    ethd_filter a, b;
    double p[ETHD_PARAMS_MAX];
    ck_assert_int_eq(ethd_params_check_table(method->params, method->param_count, NULL), ETHD_OK);
    memset(&a, 0, sizeof a);
    memset(&b, 0xa5, sizeof b);
    ethd_params_default(method->params, method->param_count, p);
    ck_assert_int_eq(ethd_filter_prepare((ethd_filter_method)m, p, T, &a, NULL), ETHD_OK);
    ck_assert_int_eq(ethd_filter_prepare((ethd_filter_method)m, p, T, &b, NULL), ETHD_OK);
    ck_assert_mem_eq(&a, &b, sizeof a);
    ck_assert_int_eq(a.reference, ETHD_REFERENCE_SAMPLE);
    p[ethd_params_find(method->params, method->param_count, "reference")] = ETHD_REFERENCE_TICK;
    ck_assert_int_eq(ethd_filter_prepare((ethd_filter_method)m, p, T, &a, NULL), ETHD_OK);
    ck_assert_int_eq(a.reference, ETHD_REFERENCE_TICK);
  }
}

TEST(test_refusals) {
  static const struct {
    int method;
    const char *name;
    double value;
    ethd_status status;
  } bad[] = {
      {ETHD_FILTER_CV, "noise", 0, ETHD_E_RANGE},
      {ETHD_FILTER_CV, "acceleration", NAN, ETHD_E_NOT_FINITE},
      {ETHD_FILTER_CA, "jerk", -1, ETHD_E_RANGE},
      {ETHD_FILTER_CA, "memory", 0, ETHD_E_RANGE},
      {ETHD_FILTER_CA, "gate", 0.5, ETHD_E_RANGE},
      {ETHD_FILTER_CA, "compensation", 0.5, ETHD_E_RANGE},
      {ETHD_FILTER_HOLD, "reference", 2, ETHD_E_RANGE},
      {ETHD_FILTER_ALPHA_BETA, "alpha", 1.1, ETHD_E_RANGE},
      {ETHD_FILTER_CV, "latency", INFINITY, ETHD_E_NOT_FINITE},
  };
  double p[ETHD_PARAMS_MAX] = {0};
  ethd_filter f = {.period = 42};
  ethd_error error;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    const ethd_method *m = &ethd_filter_methods[bad[i].method];
    ethd_params_default(m->params, m->param_count, p);
    p[ethd_params_find(m->params, m->param_count, bad[i].name)] = bad[i].value;
    ck_assert_int_eq(ethd_filter_prepare((ethd_filter_method)bad[i].method, p, T, &f, &error), bad[i].status);
    ck_assert_str_eq(error.name, bad[i].name);
  }
  ethd_params_default(ethd_filter_methods[0].params, ethd_filter_methods[0].param_count, p);
  ck_assert_int_eq(ethd_filter_prepare(ETHD_FILTER_CA, p, -T, &f, &error), ETHD_E_RANGE);
  ck_assert_str_eq(error.name, "period");
  ck_assert_int_eq(ethd_filter_prepare(ETHD_FILTER_COUNT, p, T, &f, &error), ETHD_E_UNKNOWN);
  ck_assert(f.period == 42);
}
