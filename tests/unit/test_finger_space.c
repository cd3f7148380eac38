/* The finger's filter in space: against matrices in long double, against the plane's, while it acquires, after a loss. */
#include "finger_filters.h"
#include "kalman_matrices.h"
#include "unit/suite.h"

/* A headset: readings at 72 Hz, 30 ms late. */
#define LATE 30e-3
#define EVERY 14 /* ticks */

static double path(int axis, double t) { return 0.2 * axis + (0.3 - 0.1 * axis) * t + 0.05 * sin((5 + axis) * t); }
static double path_v(int axis, double t) { return 0.3 - 0.1 * axis + 0.05 * (5 + axis) * cos((5 + axis) * t); }

static ethd_filter kalman(ethd_filter_method method, double compensation, double gate) {
  static const char *const names[] = {"compensation", "gate", "latency", "noise", NULL};
  const double values[] = {compensation, gate, 1e-3, 4e-3};
  return with(method, names, values);
}

static ethd_filter_reading reading(ethd_vec3 x, double age) { return (ethd_filter_reading){.x = x, .age = age}; }

/* Each axis against matrices of its own. Noises and measured velocities come and go; in the last runs the tracker
   extrapolates. */
TEST_LOOP(test_space_as_matrices, 0, 8) {
  const bool ca = _i % 2, by_stamp = _i / 2 % 2, extrapolated = _i / 4;
  ethd_filter f = kalman(ca ? ETHD_FILTER_CA : ETHD_FILTER_CV,
                         by_stamp ? ETHD_COMPENSATION_STAMP : ETHD_COMPENSATION_NONE, INFINITY);
  ethd_filter_state s;
  memset(&s, 0, sizeof s);
  ethd_filter_start3(&f, &s, (ethd_vec3){0, 0.2, 0.4}, (ethd_vec3){0.5, 0.4, 0.3});
  reference r[3];
  for (int i = 0; i < 3; i++)
    r[i] = (reference){.n = ca ? 3 : 2,
                       .drive = ca ? 400 : 8,
                       .memory = 0.08L,
                       .x = {0.2 * i, 0.5 - 0.1 * i, 0},
                       .p = {{1e-6, 0, 0}, {0, 1e-4, 0}, {0, 0, ca}}};
  const double before = (extrapolated ? 0 : LATE) + (extrapolated ? 0 : 1e-3);
  double stands = 0;
  for (int k = 1; k <= 4000; k++) {
    const double now = k * T;
    ethd_filter_predict(&f, &s, T);
    for (int i = 0; i < 3 && !by_stamp; i++) ref_move(&r[i], T);
    if (k % EVERY || now - before <= stands) continue;
    const uint64_t at = 8 * (uint64_t)k;
    ethd_filter_reading seen = {.age = extrapolated ? 0.5 : LATE, .extrapolated = extrapolated};
    seen.noise = draw(at, 0, 1) < 0.3 ? 0 : draw(at + 1, 1e-3, 50e-3);
    seen.v_noise = draw(at + 2, 0, 1) < 0.5 ? 0 : draw(at + 3, 0.02, 0.5);
    double x[3], v[3];
    for (int i = 0; i < 3; i++) {
      x[i] = path(i, now - before) + 5e-3 * draw_normal(at + 4 + (uint64_t)i);
      v[i] = path_v(i, now - before);
      if (by_stamp) ref_move(&r[i], (long double)(now - before) - stands);
      ref_correct(&r[i], 0, x[i], seen.noise > 0 ? seen.noise : 4e-3);
      if (seen.v_noise > 0) ref_correct(&r[i], 1, v[i], seen.v_noise);
    }
    stands = now - before;
    seen.x = ethd_vec3_of(x), seen.v = ethd_vec3_of(v);
    ck_assert_int_eq(ethd_filter_update3(&f, &s, &seen), ETHD_OK);
    ethd_vec3 here, speed;
    ethd_filter_output3(&f, &s, &here, &speed);
    double got[3], got_v[3];
    ethd_vec3_put(here, got), ethd_vec3_put(speed, got_v);
    for (int i = 0; i < 3; i++) {
      ref_equal(&r[i], &s, i);
      reference ahead = r[i];
      if (by_stamp) ref_move(&ahead, now - stands);
      ck_assert_double_le(fabs((double)(got[i] - ahead.x[0])), 1e-12);
      ck_assert_double_le(fabs((double)(got_v[i] - ahead.x[1])), 1e-11);
    }
  }
  ck_assert_uint_ge(s.used, 280);
  ck_assert_uint_eq(s.late + s.gated + s.restarts, 0);
}

/* In the plane z = 0, space gives what the plane gives, to the bit; no axis is another one's. */
TEST_LOOP(test_plane_in_space, 0, ETHD_FILTER_COUNT * 2) {
  static const char *const names[] = {"compensation", "gate", NULL};
  const double values[] = {_i % 2, INFINITY};
  ethd_filter f = with((ethd_filter_method)(_i / 2), names, values);
  ethd_filter_state plane, space, turned;
  memset(&plane, 0, sizeof plane);
  space = turned = plane;
  for (int k = 0; k < 3000; k++) {
    ethd_filter_predict(&f, &plane, T);
    ethd_filter_predict(&f, &space, T);
    ethd_filter_predict(&f, &turned, T);
    if (k % 3) continue;
    const double x = path(0, k * T), y = path(1, k * T);
    const ethd_filter_reading r = reading((ethd_vec3){x, y, 0}, 2e-3), t = reading((ethd_vec3){0, x, y}, 2e-3);
    ck_assert_int_eq(ethd_filter_update(&f, &plane, (ethd_vec){x, y}, 2e-3), ETHD_OK);
    ck_assert_int_eq(ethd_filter_update3(&f, &space, &r), ETHD_OK);
    ck_assert_int_eq(ethd_filter_update3(&f, &turned, &t), ETHD_OK);
    ck_assert_mem_eq(plane.x, space.x, sizeof plane.x + sizeof plane.v + sizeof plane.a + sizeof plane.cov);
    ck_assert(turned.x[0] == 0 && turned.x[1] == space.x[0] && turned.x[2] == space.x[1]);
    ck_assert(turned.v[0] == 0 && turned.v[1] == space.v[0] && turned.v[2] == space.v[1]);
  }
  ck_assert(plane.x[2] == 0 && plane.v[2] == 0 && plane.used == 1000 && space.used == 1000);
}

/* sqrt(3 F(3, 3 n)) / 4 at the probability P(chi^2 > 16), three degrees of freedom: scipy.stats.f.isf, chi2.sf. */
static const double wider[] = {0, 4.931, 2.060, 1.587, 1.402, 1.305, 1.246, 1.206};

/* The gate after n used readings; with a velocity, which has a gate of its own. */
TEST(test_gate_while_acquiring) {
  ethd_filter f = kalman(ETHD_FILTER_CV, ETHD_COMPENSATION_STAMP, 4);
  ethd_filter_state s;
  memset(&s, 0, sizeof s);
  for (int n = 0; n < 12; n++) {
    const double widened = n < ETHD_FILTER_ACQUIRED ? 1 + 4 * pow(n, -1.5) : 1;
    ck_assert_uint_eq(s.acquired, (uint32_t)(n < ETHD_FILTER_ACQUIRED ? n : ETHD_FILTER_ACQUIRED));
    if (n > 0) ethd_filter_predict(&f, &s, EVERY * T);
    if (n > 0 && n < ETHD_FILTER_ACQUIRED) ck_assert(widened >= wider[n] && widened <= 1.18 * wider[n]);
    for (int k = 0; k < 4 && n > 0; k++) {
      reference r = {.n = 2, .drive = 8, .p = {{s.cov[0], s.cov[1]}, {s.cov[1], s.cov[3]}}};
      ref_move(&r, EVERY * T);
      ethd_filter_reading seen = reading((ethd_vec3){0, 0, 0}, LATE);
      double sd = sqrt((double)r.p[0][0] + 4e-3 * 4e-3), off = (k % 2 ? 1.001 : 0.999) * 4 * widened;
      if (k < 2) {
        seen.x = (ethd_vec3){off * sd * 2 / 3, -off * sd / 3, off * sd * 2 / 3};
      } else {
        ref_correct(&r, 0, 0, 4e-3);
        sd = sqrt((double)r.p[1][1] + 0.1 * 0.1);
        seen.v = (ethd_vec3){off * sd / 3, off * sd * 2 / 3, off * sd * 2 / 3}, seen.v_noise = 0.1;
      }
      ethd_filter_state t = s;
      ck_assert_int_eq(ethd_filter_update3(&f, &t, &seen), k % 2 ? ETHD_STATUS_STALE : ETHD_OK);
      if (k % 2) ck_assert_mem_eq(t.x, s.x, sizeof s.x + sizeof s.v + sizeof s.a + sizeof s.cov + sizeof s.age);
      ck_assert_uint_eq(t.gated, (uint32_t)(k % 2));
    }
    const ethd_filter_reading seen = reading((ethd_vec3){0, 0, 0}, LATE);
    ck_assert_int_eq(ethd_filter_update3(&f, &s, &seen), ETHD_OK);
  }
}

/* A tracker that is three times noisier than it says: the second reading's innovation is 2.94 times as large as the filter
   expects. Without acquisition the gate of 4 sd would lose P(chi^2 > (4 / 2.94)^2), three degrees of freedom, of them:
   60.46 % by scipy.stats.chi2.sf. */
TEST(test_noisy_tracker) {
  enum { TRIALS = 4000 };
  ethd_filter f = kalman(ETHD_FILTER_CV, ETHD_COMPENSATION_STAMP, 4);
  double lost[2] = {0, 0};
  for (int i = 0; i < 2 * TRIALS; i++) {
    ethd_filter_state s;
    memset(&s, 0, sizeof s);
    for (int k = 0; k < 2; k++) {
      double x[3];
      for (int a = 0; a < 3; a++) x[a] = 0.15 * draw_normal(8 * (uint64_t)i + 4 * (uint64_t)k + (uint64_t)a);
      ethd_filter_reading seen = reading(ethd_vec3_of(x), LATE);
      seen.noise = 0.05;
      ethd_filter_predict(&f, &s, EVERY * T);
      lost[i % 2] += ethd_filter_update3(&f, &s, &seen) != ETHD_OK;
      if (i % 2) s.acquired = ETHD_FILTER_ACQUIRED;
    }
  }
  ck_assert(lost[0] == 0);
  ck_assert_double_eq_tol(lost[1] / TRIALS, 0.6046, 4 * sqrt(0.6046 * 0.3954 / TRIALS));
}

/* Two used readings that are further apart than ETHD_FILTER_LOSS: the second one is a start. A known start that no
   reading follows for so long is forgotten, too, where ages count. */
TEST_LOOP(test_loss, 0, 4) {
  const bool lost = _i % 2, by_stamp = _i / 2;
  ethd_filter f = kalman(ETHD_FILTER_CA, by_stamp ? ETHD_COMPENSATION_STAMP : ETHD_COMPENSATION_NONE, INFINITY);
  ethd_filter_state s;
  memset(&s, 0, sizeof s);
  for (int k = 0; k < 20; k++) {
    const ethd_filter_reading seen = reading((ethd_vec3){0.5 * k * EVERY * T, 0, 0}, LATE);
    ethd_filter_predict(&f, &s, EVERY * T);
    ck_assert_int_eq(ethd_filter_update3(&f, &s, &seen), ETHD_OK);
  }
  ck_assert_uint_eq(s.acquired, ETHD_FILTER_ACQUIRED);
  ethd_filter_reading seen = {.x = {1, 2, 3}, .v = {4, 5, 6}, .age = LATE, .noise = 0.02, .v_noise = 0.3};
  ethd_filter_predict(&f, &s, lost ? 0.1001 : 0.0999);
  ck_assert_int_eq(ethd_filter_update3(&f, &s, &seen), ETHD_OK);
  ck_assert_uint_eq(s.restarts, lost);
  ck_assert_uint_eq(s.acquired, lost ? 1 : ETHD_FILTER_ACQUIRED);
  if (lost) {
    const double cov[6] = {0.02 * 0.02, 0, 0, 0.3 * 0.3, 0, 100};
    ck_assert(s.x[0] == 1 && s.x[1] == 2 && s.x[2] == 3 && s.v[0] == 4 && s.v[1] == 5 && s.v[2] == 6);
    ck_assert(s.a[0] == 0 && s.a[1] == 0 && s.a[2] == 0 && s.age == LATE);
    ck_assert_mem_eq(s.cov, cov, sizeof cov);
  }
  ethd_filter_start3(&f, &s, (ethd_vec3){0, 0, 0}, (ethd_vec3){0, 0, 0});
  ethd_filter_predict(&f, &s, 1);
  ck_assert_int_eq(ethd_filter_update3(&f, &s, &seen), ETHD_OK);
  ck_assert_uint_eq(s.restarts, (uint32_t)lost + by_stamp);
}

/* Fixed gains don't ask for noise or velocity. */
TEST(test_fixed_gains_in_space) {
  static const char *const names[] = {"alpha", "beta", NULL};
  const double gains[] = {0.5, 0.25};
  ethd_filter f = with(ETHD_FILTER_ALPHA_BETA, names, gains), h = with(ETHD_FILTER_HOLD, NULL, NULL);
  ethd_filter_state s;
  memset(&s, 0, sizeof s);
  ethd_filter_start3(&f, &s, (ethd_vec3){0, 0, 1}, (ethd_vec3){0, 0, 2});
  ethd_filter_predict(&f, &s, 0.05);
  ethd_filter_reading seen = {.x = {0, 0, 1.45}, .v = {9, 9, 9}, .age = 0.025, .noise = 0.01, .v_noise = 1};
  ck_assert_int_eq(ethd_filter_update3(&f, &s, &seen), ETHD_OK); /* expected 1 + 2 0.025 = 1.05; r = 0.4 */
  ck_assert_double_eq_tol(s.x[2], 1.25, 1e-15);
  ck_assert_double_eq_tol(s.v[2], 2 + 0.25 * 0.4 / 0.025, 1e-14);
  ck_assert(s.x[0] == 0 && s.v[0] == 0);
  memset(&s, 0, sizeof s);
  ethd_vec3 x, v;
  ck_assert_int_eq(ethd_filter_update3(&h, &s, &seen), ETHD_OK);
  ethd_filter_output3(&h, &s, &x, &v);
  ck_assert(x.z == 1.45 && v.x == 0 && v.y == 0 && v.z == 0);
}

/* Each refused reading is counted and leaves the state; what isn't measured may be anything. */
TEST(test_impossible_readings) {
  ethd_filter f = kalman(ETHD_FILTER_CA, ETHD_COMPENSATION_STAMP, INFINITY);
  const ethd_filter_reading good = {.x = {1, 2, 3}, .v = {0, 0, 0}, .age = LATE, .noise = 0.05, .v_noise = 10};
  for (int k = 0; k < 14; k++) {
    ethd_filter_reading bad = good;
    double *const numbers[] = {&bad.x.x, &bad.x.y, &bad.x.z, &bad.v.x, &bad.v.y, &bad.v.z, &bad.age};
    if (k < 7) *numbers[k] = k % 2 ? (double)NAN : (double)INFINITY;
    if (k == 7) bad.noise = 0.0501;
    if (k == 8) bad.noise = -1e-3;
    if (k == 9) bad.noise = (double)NAN;
    if (k == 10) bad.v_noise = 10.001;
    if (k == 11) bad.v_noise = -1;
    if (k == 12) bad.v_noise = (double)NAN;
    if (k == 13) bad.v_noise = 0, bad.v.x = (double)NAN; /* no velocity: a possible reading */
    for (int started = 0; started < 2; started++) {
      ethd_filter_state s, t;
      memset(&s, 0, sizeof s);
      if (started) ck_assert_int_eq(ethd_filter_update3(&f, &s, &good), ETHD_OK);
      ethd_filter_predict(&f, &s, EVERY * T);
      t = s;
      ck_assert_int_eq(ethd_filter_update3(&f, &t, &bad), k == 13 ? ETHD_OK : ETHD_STATUS_STALE);
      ck_assert_uint_eq(t.gated, k != 13);
      t.gated = s.gated;
      if (k != 13) ck_assert_mem_eq(&t, &s, sizeof s);
      if (k == 13) ck_assert(t.x[0] - t.x[0] == 0 && t.v[0] - t.v[0] == 0 && t.v[2] - t.v[2] == 0);
    }
  }
  ethd_filter_state s;
  memset(&s, 0, sizeof s);
  ethd_filter_reading of_now = good;
  of_now.extrapolated = true, of_now.age = (double)NAN;
  ck_assert_int_eq(ethd_filter_update3(&f, &s, &of_now), ETHD_OK);
  ck_assert(s.age == -1e-3); /* as of now: the parameter's latency isn't compensated */
  ck_assert_int_eq(ethd_filter_update3(&f, &s, &of_now), ETHD_STATUS_STALE);
  ck_assert_uint_eq(s.late, 1);
}
