/* Each estimator against a second derivation in long double. */
#include "ethd/estimate.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "draw.h"
#include "unit/suite.h"

#define T 1e-3
#define PI_L 3.14159265358979323846264338327950288L

enum { TICKS = 3000, W = ETHD_VELOCITY_WINDOW_MAX };

static ethd_velocity prepared(ethd_velocity_method method, const double *values) {
  double p[ETHD_PARAMS_MAX];
  ethd_velocity v;
  ethd_error error;
  const ethd_method *m = &ethd_velocity_methods[method];
  ethd_params_default(m->params, m->param_count, p);
  for (uint32_t i = 0; values && i < m->param_count; i++) p[i] = values[i];
  ck_assert_int_eq(ethd_velocity_prepare(method, p, T, &v, &error), ETHD_OK);
  return v;
}

/* A lively path far from the origin, read in counts, with ticks missed now and then. */
static double q[TICKS], t[TICKS], dt[TICKS], torque[TICKS];

static void make_path(void) {
  for (int k = 0; k < TICKS; k++) {
    dt[k] = draw(3 * (uint64_t)k, 0, 1) < 0.03 ? 3 * T : T;
    t[k] = (k ? t[k - 1] : 0) + dt[k];
    double x = 700 + 0.8 * sin(9 * t[k]) + 0.05 * sin(71 * t[k]) + 0.3 * fmax(0, sin(2 * t[k]));
    q[k] = 150e-6 * rint(x / 150e-6);
    torque[k] = draw(3 * (uint64_t)k + 1, -1, 1);
  }
}

/* ---- single methods ---- */

TEST(test_lowpass_to_the_letter) {
  const double cutoff = 133.4;
  ethd_velocity v = prepared(ETHD_VELOCITY_LOWPASS, &cutoff);
  ethd_velocity_state s;
  double qd = 0;
  long double exact = 0;
  memset(&s, 0, sizeof s);
  ck_assert_double_le(fabs((double)(v.gain - (1 - expl(-2 * PI_L * cutoff * T)))), 2e-16);
  for (int k = 0; k < TICKS; k++) {
    double out = ethd_velocity_step(&v, &s, q[k], 0, dt[k]);
    if (k) {
      long double raw = ((long double)q[k] - q[k - 1]) / dt[k];
      exact += (1 - expl(-2 * PI_L * cutoff * dt[k])) * (raw - exact);
      double a = dt[k] == T ? v.gain : (double)(1 - expl(-2 * PI_L * cutoff * dt[k]));
      qd += a * ((q[k] - q[k - 1]) / dt[k] - qd);
    }
    ck_assert_double_le(fabs((double)(out - exact)), 1e-12);
    if (dt[k] == T) ck_assert_msg(out == qd, "tick %d: %a, to the letter %a", k, out, qd);
    qd = out;
  }
}

TEST(test_difference) {
  ethd_velocity v = prepared(ETHD_VELOCITY_DIFFERENCE, NULL);
  ethd_velocity_state s;
  memset(&s, 0, sizeof s);
  for (int k = 0; k < TICKS; k++)
    ck_assert(ethd_velocity_step(&v, &s, q[k], 0, dt[k]) == (k ? (q[k] - q[k - 1]) / dt[k] : 0));
}

/* Normal equations of y = b0 + b1 t over samples k - n + 1 to k, by Cramer's rule. */
static long double line_slope(int k, int n) {
  long double s1 = 0, st = 0, stt = 0, sy = 0, sty = 0;
  for (int i = k - n + 1; i <= k; i++) {
    long double ti = 0, y = (long double)q[i] - q[k];
    for (int j = k; j > i; j--) ti -= dt[j];
    s1 += 1, st += ti, stt += ti * ti, sy += y, sty += ti * y;
  }
  return (s1 * sty - st * sy) / (s1 * stt - st * st);
}

TEST_LOOP(test_lsq_is_the_line, 0, 5) {
  const double windows[] = {2, 3, 8, 31, 32};
  double window = windows[_i];
  ethd_velocity v = prepared(ETHD_VELOCITY_LSQ, &window);
  ethd_velocity_state s;
  memset(&s, 0, sizeof s);
  ck_assert(ethd_velocity_step(&v, &s, q[0], 0, dt[0]) == 0);
  for (int k = 1; k < TICKS; k++) {
    int n = k + 1 < window ? k + 1 : (int)window;
    ck_assert_double_le(fabs((double)(ethd_velocity_step(&v, &s, q[k], 0, dt[k]) - line_slope(k, n))), 1e-11);
  }
}

/* Does the line through samples k - n + 1 and k pass within noise of those between? */
static int passes(int k, int n, double noise) {
  int first = k - n + 1;
  long double span = 0, ti = 0;
  for (int j = k; j > first; j--) span += dt[j];
  for (int i = k; i > first; i--) {
    long double on_line = q[k] + ((long double)q[k] - q[first]) / span * ti;
    if (fabsl(on_line - q[i]) > noise * (1 + 1e-9L)) return 0;
    ti -= dt[i];
  }
  return 1;
}

TEST(test_foaw_window) {
  const double p[] = {24, 160e-6};
  ethd_velocity v = prepared(ETHD_VELOCITY_FOAW, p);
  ethd_velocity_state s;
  int seen[W + 1] = {0}, kinds = 0;
  memset(&s, 0, sizeof s);
  ck_assert(ethd_velocity_step(&v, &s, q[0], 0, dt[0]) == 0);
  for (int k = 1; k < TICKS; k++) {
    int n = 2;
    while (n < k + 1 && n < 24 && passes(k, n + 1, p[1])) n++;
    seen[n]++;
    ck_assert_double_le(fabs((double)(ethd_velocity_step(&v, &s, q[k], 0, dt[k]) - line_slope(k, n))), 1e-11);
  }
  for (int n = 0; n <= W; n++) kinds += seen[n] > 0;
  ck_assert_int_gt(kinds, 8);
}

/* x+ = F x + G u, P+ = F P F^T + Q; K = P H^T / (H P H^T + R), P+ = (I - K H) P, all as matrices. */
TEST(test_kalman_as_matrices) {
  const double p[] = {46e-6, 50, 0.0073};
  ethd_velocity v = prepared(ETHD_VELOCITY_KALMAN, p);
  ethd_velocity_state s;
  memset(&s, 0, sizeof s);
  long double x[2] = {q[0], 0}, c[2][2] = {{p[0] * p[0], 0}, {0, 1}};
  ck_assert(ethd_velocity_step(&v, &s, q[0], 0, dt[0]) == 0);
  for (int k = 1; k < TICKS; k++) {
    long double h = dt[k], f[2][2] = {{1, h}, {0, 1}}, g[2] = {h * h / 2, h}, fc[2][2], n[2][2];
    long double u = torque[k] / p[2], y[2];
    for (int i = 0; i < 2; i++) {
      y[i] = f[i][0] * x[0] + f[i][1] * x[1] + g[i] * u;
      for (int j = 0; j < 2; j++) fc[i][j] = f[i][0] * c[0][j] + f[i][1] * c[1][j];
    }
    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 2; j++) n[i][j] = fc[i][0] * f[j][0] + fc[i][1] * f[j][1] + p[1] * p[1] * g[i] * g[j];
    long double gain[2] = {n[0][0] / (n[0][0] + p[0] * p[0]), n[1][0] / (n[0][0] + p[0] * p[0])};
    for (int i = 0; i < 2; i++) {
      x[i] = y[i] + gain[i] * (q[k] - y[0]);
      for (int j = 0; j < 2; j++) c[i][j] = n[i][j] - gain[i] * n[0][j];
    }
    double out = ethd_velocity_step(&v, &s, q[k], torque[k], dt[k]);
    ck_assert_double_le(fabs((double)(out - x[1])), 1e-9);
    ck_assert_double_le(fabs((double)(s.cov[2] / c[1][1] - 1)), 1e-9);
  }
}

/* ---- all methods ---- */

TEST(test_tables) {
  ethd_error error;
  for (int m = 0; m < ETHD_VELOCITY_COUNT; m++) {
    const ethd_method *method = &ethd_velocity_methods[m];
    ck_assert_int_eq(ethd_params_check_table(method->params, method->param_count, &error), ETHD_OK);
    ck_assert(method->id[0] && method->brief[0]);
  }
  ck_assert_str_eq(ethd_velocity_methods[ETHD_VELOCITY_FOAW].id, "foaw");
}

/* The same bytes, whatever the memory held before. */
TEST_LOOP(test_prepared_whole, 0, ETHD_VELOCITY_COUNT) {
  const ethd_method *m = &ethd_velocity_methods[_i];
  double p[ETHD_PARAMS_MAX];
  ethd_velocity a, b;
  memset(&a, 0, sizeof a);
  memset(&b, 0xa5, sizeof b);
  ethd_params_default(m->params, m->param_count, p);
  ck_assert_int_eq(ethd_velocity_prepare((ethd_velocity_method)_i, p, T, &a, NULL), ETHD_OK);
  ck_assert_int_eq(ethd_velocity_prepare((ethd_velocity_method)_i, p, T, &b, NULL), ETHD_OK);
  ck_assert_mem_eq(&a, &b, sizeof a);
}

/* The first call gives what the state says, the second what two samples tell. */
TEST_LOOP(test_start, 0, ETHD_VELOCITY_COUNT) {
  ethd_velocity v = prepared((ethd_velocity_method)_i, NULL);
  ethd_velocity_state s;
  memset(&s, 0, sizeof s);
  ck_assert(ethd_velocity_step(&v, &s, 1, 0, T) == 0);
  memset(&s, 0, sizeof s);
  s.speed = 0.75;
  ck_assert(ethd_velocity_step(&v, &s, 1, 0, T) == 0.75);
  double next = 0.75;
  for (int k = 1; k < 4; k++) next = ethd_velocity_step(&v, &s, 1 + k * 0.75 * T, 0, T);
  ck_assert_double_eq_tol(next, 0.75, 1e-9);
}

/* A constant speed is found exactly, however far away and with ticks missed. */
TEST_LOOP(test_constant_speed, 0, ETHD_VELOCITY_COUNT) {
  ethd_velocity v = prepared((ethd_velocity_method)_i, NULL);
  ethd_velocity_state s;
  double out = 0, now = 0;
  memset(&s, 0, sizeof s);
  for (int k = 0; k < TICKS; k++) {
    now += dt[k];
    out = ethd_velocity_step(&v, &s, 5000 - 0.3125 * now, 0, dt[k]);
  }
  ck_assert_double_eq_tol(out, -0.3125, 1e-8);
}

/* Slow acceleration a: the estimate stands a lag behind. With its input known, kalman has none. */
TEST_LOOP(test_lag, 0, ETHD_VELOCITY_COUNT) {
  ethd_velocity v = prepared((ethd_velocity_method)_i, NULL);
  const double a = 1e-2;
  for (int known = 0; known < 2; known++) {
    ethd_velocity_state s;
    double out = 0, now = 0, u = known ? a * 0.1173 * 0.0625 : 0;
    memset(&s, 0, sizeof s);
    for (int k = 0; k < TICKS; k++) {
      now = k * T;
      out = ethd_velocity_step(&v, &s, a * now * now / 2, u, T);
    }
    double lag = (a * now - out) / a;
    double expected = known && _i == ETHD_VELOCITY_KALMAN ? 0 : ethd_velocity_lag(&v);
    ck_assert_double_eq_tol(lag, expected, 1e-8);
  }
}

TEST_LOOP(test_not_finite_stays, 0, ETHD_VELOCITY_COUNT) {
  ethd_velocity v = prepared((ethd_velocity_method)_i, NULL);
  ethd_velocity_state s;
  memset(&s, 0, sizeof s);
  for (int k = 0; k < 5; k++) ethd_velocity_step(&v, &s, k * 1e-4, 0, T);
  ck_assert(!isfinite(ethd_velocity_step(&v, &s, NAN, 0, T)));
  memset(&s, 0, sizeof s);
  ck_assert(ethd_velocity_step(&v, &s, 1, 0, T) == 0);
}

TEST(test_refusals) {
  static const struct {
    int method;
    double p0, p1, period;
    ethd_status status;
    const char *name;
  } bad[] = {
      {ETHD_VELOCITY_LOWPASS, 0.5, 0, T, ETHD_E_RANGE, "cutoff"},
      {ETHD_VELOCITY_LOWPASS, NAN, 0, T, ETHD_E_NOT_FINITE, "cutoff"},
      {ETHD_VELOCITY_LOWPASS, 130, 0, 0, ETHD_E_RANGE, "period"},
      {ETHD_VELOCITY_LOWPASS, 130, 0, 1.05, ETHD_E_RANGE, "period"},
      {ETHD_VELOCITY_LOWPASS, 130, 0, NAN, ETHD_E_NOT_FINITE, "period"},
      {ETHD_VELOCITY_LSQ, 33, 0, T, ETHD_E_RANGE, "window"},
      {ETHD_VELOCITY_LSQ, 1, 0, T, ETHD_E_RANGE, "window"},
      {ETHD_VELOCITY_LSQ, 7.5, 0, T, ETHD_E_RANGE, "window"},
      {ETHD_VELOCITY_FOAW, 2.5, 1e-4, T, ETHD_E_RANGE, "window"},
      {ETHD_VELOCITY_FOAW, 16, 0, T, ETHD_E_RANGE, "noise"},
      {ETHD_VELOCITY_KALMAN, 1e-5, INFINITY, T, ETHD_E_NOT_FINITE, "acceleration"},
      {ETHD_VELOCITY_COUNT, 0, 0, T, ETHD_E_UNKNOWN, "method"},
      {-1, 0, 0, T, ETHD_E_UNKNOWN, "method"},
  };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    double p[ETHD_PARAMS_MAX] = {bad[i].p0, bad[i].p1, 1};
    ethd_velocity v = {.period = 42};
    ethd_error error;
    ethd_status status = ethd_velocity_prepare((ethd_velocity_method)bad[i].method, p, bad[i].period, &v, &error);
    ck_assert_int_eq(status, bad[i].status);
    ck_assert_int_eq(error.status, bad[i].status);
    ck_assert_str_eq(error.name, bad[i].name);
    if (strcmp(error.name, "window") == 0) ck_assert(error.found == bad[i].p0 && error.min == 2 && error.max == 32);
    if (bad[i].status == ETHD_E_RANGE && strcmp(error.name, "period") == 0)
      ck_assert(error.min == 1e-6 && error.max == 1);
    ck_assert(v.period == 42);
    ck_assert_int_eq(ethd_velocity_prepare((ethd_velocity_method)bad[i].method, p, bad[i].period, &v, NULL), status);
  }
}

FIXTURE(make_path, NULL)
