/* The hand's voluntary path: the synthetic reach against its definition, recorded ones against their
 * samples. */
#include <math.h>

#include "sim/path.h"
#include "unit/draw.h"
#include "unit/suite.h"

#define PI 3.14159265358979323846

static const ethd_path reach = {.from = {0.30, 0.24}, .to_x = 0.20, .speed = 0.4, .ramp_up = 0.08, .ramp_down = 0.03};

/* 0.1 m = 0.4 m/s (0.11 s / 2 + cruise): 0.195 s of cruise. */
static double speed_of_reach(double t) {
  if (t < 0 || t > 0.305) return 0;
  if (t < 0.08) return 0.2 * (1 - cos(PI * t / 0.08));
  if (t > 0.275) return 0.2 * (1 - cos(PI * (0.305 - t) / 0.03));
  return 0.4;
}

TEST(test_speed) {
  ethd_vec x, v;
  for (double t = -0.01; t < 0.4; t += 0.00037) {
    ethd_path_at(&reach, t, &x, &v);
    ck_assert_double_eq_tol(v.x, -speed_of_reach(t), 1e-14);
    ck_assert(v.y == 0 && x.y == 0.24);
  }
  ck_assert_double_eq_tol(ethd_path_end(&reach), 0.305, 1e-15);
}

/* The position is the integral of the defined speed (Simpson, 20 us). */
TEST(test_position) {
  double expected = 0.30, h = 20e-6;
  ethd_vec x, v;
  ethd_path_at(&reach, -1, &x, &v);
  ck_assert(x.x == 0.30);
  for (int i = 0; i < 16000; i++) {
    double t = i * h;
    expected -= h / 6 * (speed_of_reach(t) + 4 * speed_of_reach(t + h / 2) + speed_of_reach(t + h));
    ethd_path_at(&reach, t + h, &x, &v);
    ck_assert_double_eq_tol(x.x, expected, 1e-9);
  }
  ethd_path_at(&reach, 5, &x, &v);
  ck_assert_double_eq_tol(x.x, 0.20, 1e-15);
  ck_assert(v.x == 0);
}

/* To the right it is the mirror image. Too short for its ramps, it keeps speed and ramps and ends
 * beyond. */
TEST(test_other_reaches) {
  ethd_path right = reach, hop = reach;
  ethd_vec x, v, y, w;
  right.to_x = 0.40;
  hop.to_x = 0.29;
  for (double t = 0; t < 0.4; t += 0.001) {
    ethd_path_at(&reach, t, &x, &v);
    ethd_path_at(&right, t, &y, &w);
    ck_assert_double_eq_tol(y.x - 0.30, 0.30 - x.x, 1e-14);
    ck_assert_double_eq_tol(w.x, -v.x, 1e-13);
  }
  ck_assert_double_eq_tol(ethd_path_end(&hop), 0.11, 1e-15);
  ethd_path_at(&hop, 0.08, &x, &v);
  ck_assert_double_eq_tol(v.x, -0.4, 1e-14);
  ethd_path_at(&hop, 0.2, &x, &v);
  ck_assert_double_eq_tol(x.x, 0.30 - 0.4 * 0.055, 1e-15);
}

/* ---- minimum jerk ---- */

/* 0.1 m in 0.5 s: on average 0.2 m/s, halfway 15/8 of it. */
static const ethd_path jerk = {
    .from = {0.30, 0.24}, .to_x = 0.20, .speed = 0.375, .profile = ETHD_PROFILE_MINIMUM_JERK};

/* Position and speed as Flash and Hogan (1985) give them; at rest before and after; to the right the mirror image. */
TEST(test_minimum_jerk) {
  ethd_path right = jerk;
  ethd_vec x, v, y, w;
  right.to_x = 0.40;
  ck_assert_double_eq_tol(ethd_path_end(&jerk), 0.5, 1e-15);
  for (double t = -0.1; t < 0.7; t += 0.00037) {
    double s = fmin(1, fmax(0, t / 0.5));
    ethd_path_at(&jerk, t, &x, &v);
    ck_assert_double_eq_tol(x.x, 0.30 - 0.1 * (10 * pow(s, 3) - 15 * pow(s, 4) + 6 * pow(s, 5)), 1e-15);
    ck_assert_double_eq_tol(v.x, -0.2 * 30 * pow(s * (1 - s), 2), 1e-14);
    ck_assert(x.y == 0.24 && v.y == 0);
    ethd_path_at(&right, t, &y, &w);
    ck_assert_double_eq_tol(y.x - 0.30, 0.30 - x.x, 1e-15);
    ck_assert_double_eq_tol(w.x, -v.x, 1e-14);
  }
  ck_assert(x.x == 0.20);
}

/* Its acceleration is greatest, 10 / sqrt(3) D / T^2, at s = (1 -+ 1 / sqrt(3)) / 2, and 0 at its ends and halfway; of all
   movements between rests without acceleration it has the least integral of squared jerk, 720 D^2 / T^5. */
TEST(test_acceleration) {
  ethd__piece piece;
  ethd__path_piece(&jerk, 0, &piece);
  double most = 10 / sqrt(3) * 0.1 / 0.25, squared = 0, h = 1e-4;
  ck_assert_double_eq_tol(ethd__piece_at(&piece, 0.25 * (1 - 1 / sqrt(3))).a.x, -most, 1e-13);
  ck_assert_double_eq_tol(ethd__piece_at(&piece, 0.25 * (1 + 1 / sqrt(3))).a.x, most, 1e-13);
  for (int i = 0; i < 3; i++) ck_assert_double_eq_tol(ethd__piece_at(&piece, 0.25 * i).a.x, 0, 1e-13);
  for (int i = 0; i < 5000; i++) {
    double change = ethd__piece_at(&piece, h * (i + 1)).a.x - ethd__piece_at(&piece, h * i).a.x;
    squared += change * change / h;
  }
  ck_assert_double_eq_tol(squared, 720 * 0.01 / pow(0.5, 5), 1e-4);
}

/* The power series about any instant is the piece itself. */
TEST_LOOP(test_terms, 0, 2) {
  static const ethd_path *const paths[] = {&reach, &jerk};
  for (double t = 0.001; t < 0.07; t += 0.001) {
    ethd__piece piece;
    ethd__two term[ETHD__PATH_TERMS];
    ethd__path_piece(paths[_i], t, &piece);
    ethd__sim_motion at = ethd__piece_at(&piece, t), then = ethd__piece_at(&piece, t + 1e-3);
    ethd__piece_terms(&piece, &at, term);
    double x = 0, v = 0;
    for (int k = ETHD__PATH_TERMS - 1; k >= 0; k--) x = x * 1e-3 + term[k][0], v = k ? v * 1e-3 + k * term[k][0] : v;
    ck_assert_double_eq_tol(x, then.x.x, _i ? 1e-16 : 3e-14); /* of a ramp, terms from the sixth on are left out */
    ck_assert_double_eq_tol(v, then.v.x, _i ? 1e-15 : 2e-10);
  }
}

/* A movement of no length is a jump, not 0 / 0. */
TEST(test_no_length) {
  ethd_path still = jerk;
  ethd_vec x, v;
  for (int i = 0; i < 2; i++) {
    still.to_x = i ? nextafter(0.30, 1) : 0.30;
    for (double t = -1; t < 2; t++) {
      ethd_path_at(&still, t, &x, &v);
      ck_assert(x.x == (t < 0 ? 0.30 : still.to_x) && v.x == 0);
    }
  }
}

/* ---- recorded ---- */

enum { COUNT = 40 };

/* Uneven in time. */
static ethd_path record(ethd_path_sample *s, ethd_vec (*at)(double t)) {
  for (int i = 0; i < COUNT; i++) {
    double t = 0.1 + 0.004 * i + (i && i + 1 < COUNT ? draw((uint64_t)i, 0, 0.003) : 0);
    ethd_vec x = at(t);
    s[i] = (ethd_path_sample){t, x.x, x.y};
  }
  return (ethd_path){.samples = s, .sample_count = COUNT};
}

static ethd_vec parabola(double t) { return (ethd_vec){0.3 - 0.2 * t - 3 * t * t, 0.2 + t - 7 * t * t}; }

/* Slopes of parabolas make a parabola exact, all but the end pieces; there the slope ends at 0. */
TEST(test_parabola) {
  ethd_path_sample s[COUNT];
  ethd_path path = record(s, parabola);
  ethd_vec x, v;
  for (double t = s[1].t; t < s[COUNT - 2].t; t += 0.00011) {
    ethd_vec expected = parabola(t);
    ethd_path_at(&path, t, &x, &v);
    ck_assert_double_eq_tol(x.x, expected.x, 1e-15);
    ck_assert_double_eq_tol(x.y, expected.y, 1e-15);
    ck_assert_double_eq_tol(v.x, -0.2 - 6 * t, 1e-12);
    ck_assert_double_eq_tol(v.y, 1 - 14 * t, 1e-12);
  }
  ck_assert(ethd_path_end(&path) == s[COUNT - 1].t);
}

static ethd_vec jagged(double t) {
  uint64_t n = (uint64_t)(t * 1e6);
  return (ethd_vec){draw(n, 0.2, 0.3), draw(n + 1, 0.2, 0.3)};
}

/* Whatever the samples: through each of them, one slope on both sides, still before and after. */
TEST(test_through_samples) {
  ethd_path_sample s[COUNT];
  ethd_path path = record(s, jagged);
  for (int i = 0; i < COUNT; i++) {
    ethd__piece before, after;
    ethd__path_piece(&path, i ? s[i - 1].t : 0, &before);
    ethd__path_piece(&path, s[i].t, &after);
    ck_assert(before.end == s[i].t && after.begin == s[i].t);
    ethd__sim_motion left = ethd__piece_at(&before, s[i].t), right = ethd__piece_at(&after, s[i].t);
    ck_assert(right.x.x == s[i].x && right.x.y == s[i].y);
    ck_assert_double_eq_tol(left.x.x, s[i].x, 1e-15);
    ck_assert_double_eq_tol(left.x.y, s[i].y, 1e-15);
    ck_assert_double_eq_tol(left.v.x, right.v.x, 1e-11);
    ck_assert_double_eq_tol(left.v.y, right.v.y, 1e-11);
    if (i == 0 || i + 1 == COUNT) ck_assert(right.v.x == 0 && right.v.y == 0);
  }
  ethd_vec x, v;
  ethd_path_at(&path, 0, &x, &v);
  ck_assert(x.x == s[0].x && x.y == s[0].y && v.x == 0 && v.y == 0);
  ethd_path_at(&path, 9, &x, &v);
  ck_assert(x.x == s[COUNT - 1].x && x.y == s[COUNT - 1].y && v.x == 0 && v.y == 0);
}

TEST(test_single_sample) {
  ethd_path_sample one = {0.5, 0.3, 0.2};
  ethd_path path = {.samples = &one, .sample_count = 1};
  ethd_vec x, v;
  for (double t = 0; t < 1.1; t += 0.25) {
    ethd_path_at(&path, t, &x, &v);
    ck_assert(x.x == 0.3 && x.y == 0.2 && v.x == 0 && v.y == 0);
  }
  ck_assert(ethd_path_end(&path) == 0.5);
}

/* ---- both ---- */

/* A bound, also on a piece without an end, and mostly less than twice what it bounds. */
TEST(test_travel) {
  int close = 0;
  for (uint64_t i = 0; i < 2000; i++) {
    ethd__piece piece = {.begin = -INFINITY, .end = INFINITY, .b = {draw(9 * i, -1, 1), draw(9 * i + 1, -1, 1)}};
    if (i % 2) {
      piece.c = (ethd_vec){draw(9 * i + 2, -20, 20), draw(9 * i + 3, -20, 20)};
      piece.d = (ethd_vec){draw(9 * i + 4, -500, 500), draw(9 * i + 5, -500, 500)};
      piece.f = draw(9 * i + 8, -5e4, 5e4) * (i % 4 == 1);
      piece.g = draw(9 * i, -5e6, 5e6) * (i % 4 == 1);
    } else {
      piece.e = (ethd_vec){draw(9 * i + 4, -0.01, 0.01), draw(9 * i + 5, -0.01, 0.01)};
      piece.w = 100;
    }
    double t = draw(9 * i + 6, -0.05, 0.05), h = draw(9 * i + 7, 0, 0.01), most = 0;
    ethd__sim_motion at = ethd__piece_at(&piece, t);
    for (int k = 0; k <= 100; k++) {
      ethd__sim_motion then = ethd__piece_at(&piece, t + h * k / 100);
      most = fmax(most, fabs(then.x.x - at.x.x) + fabs(then.x.y - at.x.y));
    }
    double bound = ethd__piece_travel(&piece, &at, h);
    ck_assert(most <= bound * (1 + 1e-12) + 1e-15);
    close += bound < 2 * most;
  }
  ck_assert_int_gt(close, 1000);
}
