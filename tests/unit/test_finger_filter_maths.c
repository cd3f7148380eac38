/* What the filters compute: against matrices in long double, by hand, and gated. Their errors side by side, on reaches and
   on recorded movements: tests/bench_quick.sh. */
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
  ethd_filter f = with(_i ? ETHD_FILTER_CV : ETHD_FILTER_CA, NULL, NULL);
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
