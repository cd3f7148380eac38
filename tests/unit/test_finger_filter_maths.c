/* What the filters compute: against matrices in long double, by hand, gated, and side by side on reaches. */
#include "finger_filters.h"
#include "kalman_matrices.h"
#include "unit/suite.h"

/* ---- Kalman filters as matrices ---- */

/* cv, ca, ca without fading; each tick by tick and by stamps; frames lost, ticks missed. */
TEST_LOOP(test_kalman_as_matrices, 0, 6) {
  static const char *const names[] = {"compensation", "gate", "latency", "noise",
                                      "acceleration", "jerk", "memory",  NULL};
  int ca = _i / 2 > 0, by_stamp = _i % 2;
  double memory = _i / 2 == 2 ? INFINITY : 0.05;
  const double values[] = {
      by_stamp ? ETHD_COMPENSATION_STAMP : ETHD_COMPENSATION_NONE, INFINITY, 0.4e-3, 0.101e-3, 9.07, 400, memory};
  ethd_filter f = with(ca ? ETHD_FILTER_CA : ETHD_FILTER_CV, names, values);
  ethd_filter_state s;
  memset(&s, 0, sizeof s);
  ethd_filter_start(&f, &s, (ethd_vec){0.3, 0.2}, (ethd_vec){0.05, 0});
  reference r = {.n = ca ? 3 : 2,
                 .noise = 0.101e-3,
                 .drive = ca ? 400 : 9.07,
                 .memory = memory,
                 .x = {0.3, 0.05, 0},
                 .p = {{1e-6, 0, 0}, {0, 1e-4, 0}, {0, 0, 1}}};
  double now = 0, stands = 0; /* where the reference's state stands */
  int used = 0;
  for (int k = 0; k < 2000; k++) {
    double dt = draw(3 * (uint64_t)k, 0, 1) < 0.02 ? 4 * T : T;
    now += dt;
    ethd_filter_predict(&f, &s, dt);
    if (!by_stamp) ref_move(&r, dt);
    if (k % 3 || draw(3 * (uint64_t)k + 1, 0, 1) < 0.2) continue;
    double sampled = now - 2e-3, z = 0.3 + 0.05 * now + 0.01 * sin(20 * sampled) + 1e-4 * draw_normal((uint64_t)k);
    if (by_stamp && sampled - 0.4e-3 <= stands) continue;
    if (by_stamp) ref_move(&r, (long double)(sampled - 0.4e-3) - stands);
    ref_correct(&r, 0, z, r.noise);
    stands = sampled - 0.4e-3;
    ck_assert_int_eq(ethd_filter_update(&f, &s, (ethd_vec){z, 0.2}, 2e-3), ETHD_OK);
    ref_equal(&r, &s, 0);
    used++;
    reference ahead = r;
    ethd_vec x, v;
    if (by_stamp) ref_move(&ahead, now - stands);
    ethd_filter_output(&f, &s, &x, &v);
    ck_assert_double_le(fabs((double)(x.x - ahead.x[0])), 1e-12);
    ck_assert_double_le(fabs((double)(v.x - ahead.x[1])), 1e-11);
    ck_assert(x.y == 0.2 && v.y == 0);
  }
  ck_assert_int_gt(used, 500);
  ck_assert_uint_eq(s.used, (uint32_t)used);
  ck_assert_uint_eq(s.late + s.gated + s.restarts, 0);
}

/* ---- gate ---- */

/* Within the gate of sqrt(P_xx + noise^2) it is used, outside not; both axes count together. */
TEST_LOOP(test_gate, 0, 2) {
  const ethd_filter_method method = _i ? ETHD_FILTER_CV : ETHD_FILTER_CA;
  static const char *const names[] = {"gate", "noise", NULL};
  const double values[] = {4, 0.1e-3};
  ethd_filter f = with(method, names, values);
  ethd_filter_state s, t;
  memset(&s, 0, sizeof s);
  ramp(&f, &s, 0.1, 2e-3);
  reference r = {.n = method == ETHD_FILTER_CA ? 3 : 2,
                 .noise = 0.1e-3,
                 .drive = method == ETHD_FILTER_CA ? 400 : 8,
                 .memory = 0.08,
                 .x = {s.x[0], s.v[0], s.a[0]},
                 .p = {{s.cov[0], s.cov[1], s.cov[2]}, {s.cov[1], s.cov[3], s.cov[4]}, {s.cov[2], s.cov[4], s.cov[5]}}};
  ethd_filter_predict(&f, &s, T);
  ref_move(&r, 3e-3L);
  double sd = sqrt((double)r.p[0][0] + 1e-8), x = (double)r.x[0];
  for (int k = 0; k < 4; k++) {
    double along = k % 2 ? 4.001 * sd : 3.999 * sd, a = k < 2 ? 0 : 0.8;
    t = s;
    ethd_status status = ethd_filter_update(&f, &t, (ethd_vec){x + along * cos(a), -x + along * sin(a)}, 2e-3);
    ck_assert_int_eq(status, k % 2 ? ETHD_STATUS_STALE : ETHD_OK);
    ck_assert_uint_eq(t.gated, (uint32_t)(k % 2));
    if (k % 2) ck_assert_mem_eq(t.x, s.x, sizeof s.x + sizeof s.v + sizeof s.a + sizeof s.cov + sizeof s.age);
  }
}

/* A finger that jumped for good is found again with the fifth reading; four bad ones do nothing. */
TEST_LOOP(test_gated_in_a_row, 0, 2) {
  ethd_filter f = finger_filter(_i ? ETHD_FILTER_CV : ETHD_FILTER_CA, NULL, 0);
  ethd_filter_state s;
  memset(&s, 0, sizeof s);
  ramp(&f, &s, 0.1, 2e-3);
  double here = out_x(&f, &s);
  for (int k = 1; k <= 4; k++) {
    ethd_filter_predict(&f, &s, 3e-3);
    ck_assert_int_eq(feed(&f, &s, here + 0.1, 2e-3), ETHD_STATUS_STALE);
  }
  ck_assert_double_eq_tol(out_x(&f, &s), here + 0.1 * 12e-3, 1e-6);
  ethd_filter_predict(&f, &s, 3e-3);
  ck_assert_int_eq(feed(&f, &s, here + 0.1 * 15e-3, 2e-3), ETHD_OK);
  ck_assert_uint_eq(s.gated_in_a_row, 0);
  for (int k = 1; k <= 5; k++) {
    ethd_filter_predict(&f, &s, 3e-3);
    ck_assert_int_eq(feed(&f, &s, here + 0.1, 2e-3), k < 5 ? ETHD_STATUS_STALE : ETHD_OK);
  }
  ck_assert(s.restarts == 1 && s.gated == 9 && s.started == 1 && s.x[0] == here + 0.1);
}

/* ---- fixed gains, by hand ---- */

TEST(test_alpha_beta_by_hand) {
  static const char *const names[] = {"alpha", "beta", NULL};
  const double gains[] = {0.5, 0.25};
  ethd_filter f = with(ETHD_FILTER_ALPHA_BETA, names, gains);
  ethd_filter_state s;
  memset(&s, 0, sizeof s);
  ethd_filter_start(&f, &s, (ethd_vec){1, -1}, (ethd_vec){2, -2});
  ethd_filter_predict(&f, &s, 0.5);
  ck_assert(out_x(&f, &s) == 2);
  ck_assert_int_eq(feed(&f, &s, 1.9, 0.25), ETHD_OK); /* expected 1 + 2 0.25 = 1.5; r = 0.4 */
  ck_assert_double_eq_tol(s.x[0], 1.7, 1e-15);
  ck_assert_double_eq_tol(s.v[0], 2 + 0.25 * 0.4 / 0.25, 1e-15);
  ck_assert_double_eq_tol(out_x(&f, &s), 1.7 + 2.4 * 0.25, 1e-15);
}

/* ---- accuracy ---- */

typedef struct reach {
  double length, duration, angle;
} reach;

/* Minimum jerk: s = 10 u^3 - 15 u^4 + 6 u^5, peak speed 15/8 length / duration; 50 ms of rest around. */
static ethd_vec reach_at(const void *data, double t) {
  const reach *r = data;
  double u = fmin(1, fmax(0, (t - 0.05) / r->duration)), s = r->length * u * u * u * (10 - 15 * u + 6 * u * u);
  return (ethd_vec){s * cos(r->angle), s * sin(r->angle)};
}

enum { REACHES = 40 };

TEST(test_extrapolation) {
  static reach reaches[REACHES];
  finger_path paths[REACHES];
  const double goal[] = {0.15, 0.25, 0.30};
  for (uint64_t i = 0; i < REACHES; i++) {
    double speed = draw(3 * i, 0.5, 1.1), length = draw(3 * i + 1, 0.1, 0.3);
    reaches[i] = (reach){length, 1.875 * length / speed, draw(3 * i + 2, 0, 6.28)};
    paths[i] = (finger_path){reach_at, &reaches[i], reaches[i].duration + 0.1};
  }
  printf("extrapolation error rms, mm: minimum-jerk reaches of 0.5 to 1.1 m/s, 300 Hz, 0.1 mm noise\n");
  printf("  latency ms   hold  alpha-beta      cv (m/s^2)      ca (m/s^3)  gain    defaults: cv     ca\n");
  for (int l = 0; l < 3; l++) {
    double latency = finger_latencies[l], q = 0, j = 0, b = 0;
    finger_error by[ETHD_FILTER_COUNT] = {{0, 0, 0}};
    for (int m = 0; m < ETHD_FILTER_COUNT; m++) {
      ethd_filter f = finger_filter((ethd_filter_method)m, NULL, 0);
      for (int k = 0; k < REACHES; k++) finger_run(&f, &paths[k], latency, (uint64_t)k, &by[m]);
      ck_assert_int_eq(by[m].gated, 0);
    }
    double hold = finger_rms(by[ETHD_FILTER_HOLD]);
    double fixed = finger_best(ETHD_FILTER_ALPHA_BETA, "beta", 0.1, 9, paths, REACHES, latency, &b);
    double cv = finger_best(ETHD_FILTER_CV, "acceleration", 3, 8, paths, REACHES, latency, &q);
    double ca = finger_best(ETHD_FILTER_CA, "jerk", 80, 9, paths, REACHES, latency, &j);
    printf("  %10.0f  %.3f %11.4f  %.4f (%4.1f)   %.4f (%4.0f)  %4.1f %%          %.4f  %.4f\n", 1e3 * latency, hold,
           fixed, cv, q, ca, j, 100 * (1 - ca / cv), finger_rms(by[ETHD_FILTER_CV]), finger_rms(by[ETHD_FILTER_CA]));
    ck_assert(ca < cv && cv < hold && fixed < hold);
    ck_assert_double_le(ca, (1 - goal[l]) * cv);
    ck_assert_double_le(finger_rms(by[ETHD_FILTER_CA]), 1.15 * ca);
  }
}
