/* Accuracy against long double, special cases, symmetries, and the same bits everywhere. */
#include "ethd/maths.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include "maths/two_waves.h"
#include "unit/draw.h"
#include "unit/suite.h"

#define PI_2 0x1.921fb54442d18469898cc517018p+0L

enum { POINTS = 150000 };

/* ---- points ---- */

static uint64_t bits_of(double x) {
  uint64_t u;
  memcpy(&u, &x, sizeof u);
  return u;
}

static double of_bits(uint64_t u) {
  double x;
  memcpy(&x, &u, sizeof x);
  return x;
}

static double nudge(double x, uint64_t i) { return x == 0 ? x : of_bits(bits_of(x) + draw_bits(i ^ 0x5555) % 9 - 4); }

static double any_finite(uint64_t i) {
  uint64_t u = draw_bits(i);
  return of_bits((u & 0x7ff0000000000000) == 0x7ff0000000000000 ? u ^ 0x4000000000000000 : u);
}

static double any_positive(uint64_t i) { return fabs(any_finite(i)); }
static double quarter(uint64_t i) { return draw(i, -0.79, 0.79); }
static double turns(uint64_t i) { return draw(i, -10, 10); }
static double many_turns(uint64_t i) { return draw(i, -1e5, 1e5); }
static double at_method_border(uint64_t i) { return draw(i, 0x1p20 - 10, 0x1p20 + 10); }
static double near_zero(uint64_t i) { return draw(i, -1, 1) * exp2(-(double)(i % 1074)); }

/* Next to the first 64k multiples of pi/4, then to larger and larger ones. */
static double near_eighth_turns(uint64_t i) {
  uint64_t k = i % 2 ? i : draw_bits(i) >> (i / 2 % 60);
  return nudge((double)((long double)k * (PI_2 / 2)), i);
}

static double all_powers(uint64_t i) { return draw(i, -708.39, 709.79); }
static double subnormal_powers(uint64_t i) { return draw(i, -745.2, -708.396); }
static double small_powers(uint64_t i) { return draw(i, -1, 1); }

/* Where exp changes its row of the table. */
static double power_borders(uint64_t i) {
  double k = (double)(i % 32000) - 16000;
  return nudge((double)(((long double)k + 0.5L) * logl(2) / 16), i);
}

static double near_one(uint64_t i) { return 1 + draw(i, -1, 1) * exp2(-(double)(i % 53)); }
static double octave(uint64_t i) { return draw(i, 0.5, 2); }
static double subnormal(uint64_t i) { return of_bits(draw_bits(i) >> (12 + i % 52)); }
static double small(uint64_t i) { return draw(i, -0.3, 0.3); }
static double middling(uint64_t i) { return draw(i, 0.24, 1); }
static double wide(uint64_t i) { return draw(i, -21, 21); }

/* ---- accuracy ---- */

/* |got - want| in ulp of want; subnormals count as such. */
static double ulps(double got, long double want) {
  int e;
  if (isinf(got) || isinf(want)) return got == (double)want ? 0 : HUGE_VAL;
  frexpl(want, &e);
  double error = (double)(fabsl(got - want) / ldexpl(1, (e < -1021 ? -1021 : e) - 53));
  return isnan(error) ? HUGE_VAL : error;
}

typedef struct accuracy {
  const char *name;
  double (*function)(double);
  long double (*reference)(long double);
  double (*point)(uint64_t);
  double bound; /* ulp, as the header promises */
} accuracy;

static const accuracy accuracies[] = {
    {"sin, an eighth of a turn", ethd_sin, sinl, quarter, 0.86},
    {"sin, turns", ethd_sin, sinl, turns, 0.86},
    {"sin, many turns", ethd_sin, sinl, many_turns, 0.86},
    {"sin, border of the methods", ethd_sin, sinl, at_method_border, 0.86},
    {"sin, near multiples of pi/4", ethd_sin, sinl, near_eighth_turns, 0.86},
    {"sin, near zero", ethd_sin, sinl, near_zero, 0.86},
    {"sin, any", ethd_sin, sinl, any_finite, 0.86},
    {"cos, an eighth of a turn", ethd_cos, cosl, quarter, 0.86},
    {"cos, turns", ethd_cos, cosl, turns, 0.86},
    {"cos, many turns", ethd_cos, cosl, many_turns, 0.86},
    {"cos, border of the methods", ethd_cos, cosl, at_method_border, 0.86},
    {"cos, near multiples of pi/4", ethd_cos, cosl, near_eighth_turns, 0.86},
    {"cos, near zero", ethd_cos, cosl, near_zero, 0.86},
    {"cos, any", ethd_cos, cosl, any_finite, 0.86},
    {"exp, small", ethd_exp, expl, small_powers, 0.57},
    {"exp, whole range", ethd_exp, expl, all_powers, 0.57},
    {"exp, near zero", ethd_exp, expl, near_zero, 0.57},
    {"exp, table borders", ethd_exp, expl, power_borders, 0.57},
    {"exp, subnormal results", ethd_exp, expl, subnormal_powers, 0.78},
    {"exp, any", ethd_exp, expl, any_finite, 0.78},
    {"log, near one", ethd_log, logl, near_one, 0.56},
    {"log, an octave", ethd_log, logl, octave, 0.56},
    {"log, subnormal", ethd_log, logl, subnormal, 0.56},
    {"log, any", ethd_log, logl, any_positive, 0.56},
    {"tanh, small", ethd_tanh, tanhl, small, 0.60},
    {"tanh, middling", ethd_tanh, tanhl, middling, 0.60},
    {"tanh, wide", ethd_tanh, tanhl, wide, 0.60},
    {"tanh, near zero", ethd_tanh, tanhl, near_zero, 0.60},
    {"tanh, any", ethd_tanh, tanhl, any_finite, 0.60},
};

enum { ACCURACIES = sizeof accuracies / sizeof accuracies[0] };

TEST_LOOP(test_accuracy, 0, LDBL_MANT_DIG < 64 ? 0 : ACCURACIES) {
  const accuracy *a = &accuracies[_i];
  for (uint64_t i = 0; i < POINTS; i++) {
    double x = a->point(i);
    if (a->reference == logl && x == 0) continue;
    double error = ulps(a->function(x), a->reference(x));
    if (!(error < a->bound)) ck_abort_msg("%s: %.3f ulp at %a", a->name, error, x);
  }
}

static void check_atan2(double y, double x) {
  double error = ulps(ethd_atan2(y, x), atan2l(y, x));
  if (!(error < 0.51)) ck_abort_msg("atan2: %.3f ulp at (%a, %a)", error, y, x);
}

TEST_LOOP(test_atan2_accuracy, 0, LDBL_MANT_DIG >= 64) {
  for (uint64_t i = 0; i < POINTS; i++) {
    double x = draw(2 * i, -1, 1), y = draw(2 * i + 1, -1, 1);
    double ratio = (double)(i % 33) / 16 - 1; /* the borders between rows, and the rows */

    check_atan2(y, x);
    check_atan2(nudge(x * ratio, i), x);
    check_atan2(x, nudge(x * ratio, i));
    check_atan2(y * exp2((double)(i % 160) - 80), x);
    check_atan2(y * 0x1p-1010, x * exp2(-(double)(i % 64) - 1010));
    check_atan2(y * 0x1p1023, x * 0x1p1023);
    check_atan2(any_finite(2 * i), any_finite(2 * i + 1));
  }
}

/* The double that comes nearest to a multiple of pi/2 (Muller, Elementary Functions, table 11.1), the
   one below 2^20 that asks most of the three parts of pi/2, and a large one; values from 400 digits. */
TEST(test_hardest_reduction) {
  double x = 6381956970095103.0 * 0x1p797;
  ck_assert_double_eq(ethd_cos(x), -4.687165924254627611122583e-19);
  ck_assert_double_eq(ethd_sin(x), 1);
  ck_assert_double_eq(ethd_cos(0x1.93c05c9ed3cbcp+18), -2.275653995178154324420141e-16);
  ck_assert_double_eq(ethd_sin(0x1.93c05c9ed3cbcp+19), -4.551307990356308648840282e-16);
  ck_assert_double_eq_tol(ethd_sin(0x1p1023), 0.5631277798508840134529434, 2e-16);
  ck_assert_double_eq_tol(ethd_cos(0x1p1023), -0.8263698346141479945007857, 2e-16);
}

/* ---- special cases ---- */

#define SAME(got, want)                                                             \
  do {                                                                              \
    if (bits_of(got) != bits_of(want)) ck_abort_msg("%s: %a", #got, (double)(got)); \
  } while (0)
#define IS_NAN(got) SAME(got, (double)NAN)

TEST(test_special_cases) {
  const double inf = HUGE_VAL, nan = -(double)NAN;

  SAME(ethd_sin(0.0), 0.0);
  SAME(ethd_sin(-0.0), -0.0);
  SAME(ethd_cos(-0.0), 1.0);
  IS_NAN(ethd_sin(nan));
  IS_NAN(ethd_cos(nan));
  IS_NAN(ethd_sin(inf));
  IS_NAN(ethd_sin(-inf));
  IS_NAN(ethd_cos(inf));
  IS_NAN(ethd_cos(-inf));

  SAME(ethd_exp(0.0), 1.0);
  SAME(ethd_exp(-0.0), 1.0);
  SAME(ethd_exp(inf), inf);
  SAME(ethd_exp(-inf), 0.0);
  SAME(ethd_exp(0x1.62e42fefa39fp+9), inf); /* the first to overflow */
  ck_assert(ethd_exp(0x1.62e42fefa39efp+9) <= DBL_MAX);
  SAME(ethd_exp(-0x1.74910d52d3051p+9), 0x1p-1074); /* the last above nothing */
  SAME(ethd_exp(-0x1.74910d52d3052p+9), 0.0);
  SAME(ethd_exp(1e300), inf);
  SAME(ethd_exp(-1e300), 0.0);
  IS_NAN(ethd_exp(nan));

  SAME(ethd_log(1.0), 0.0);
  SAME(ethd_log(0.0), -inf);
  SAME(ethd_log(-0.0), -inf);
  SAME(ethd_log(inf), inf);
  IS_NAN(ethd_log(-1.0));
  IS_NAN(ethd_log(-0x1p-1074));
  IS_NAN(ethd_log(-inf));
  IS_NAN(ethd_log(nan));

  SAME(ethd_tanh(0.0), 0.0);
  SAME(ethd_tanh(-0.0), -0.0);
  SAME(ethd_tanh(inf), 1.0);
  SAME(ethd_tanh(-inf), -1.0);
  SAME(ethd_tanh(1e300), 1.0);
  IS_NAN(ethd_tanh(nan));
}

/* C11 F.10.1.4, in its order. */
TEST(test_atan2_special_cases) {
  const double pi = (double)(2 * PI_2), inf = HUGE_VAL, nan = -(double)NAN;

  for (int negative = 0; negative < 2; negative++) {
    double s = negative ? -1 : 1;
    SAME(ethd_atan2(s * 0.0, -0.0), s * pi);
    SAME(ethd_atan2(s * 0.0, 0.0), s * 0.0);
    SAME(ethd_atan2(s * 0.0, -3), s * pi);
    SAME(ethd_atan2(s * 0.0, -0x1p-1074), s * pi);
    SAME(ethd_atan2(s * 0.0, 3), s * 0.0);
    SAME(ethd_atan2(s * 3, 0.0), s * pi / 2);
    SAME(ethd_atan2(s * 0x1p-1074, -0.0), s * pi / 2);
    SAME(ethd_atan2(s * 3, -inf), s * pi);
    SAME(ethd_atan2(s * DBL_MAX, inf), s * 0.0);
    SAME(ethd_atan2(s * inf, 3), s * pi / 2);
    SAME(ethd_atan2(s * inf, -DBL_MAX), s * pi / 2);
    SAME(ethd_atan2(s * inf, -inf), s * (double)(3 * PI_2 / 2));
    SAME(ethd_atan2(s * inf, inf), s * pi / 4);
    SAME(ethd_atan2(s * 1, 1), s * pi / 4);
    SAME(ethd_atan2(s * 0x1p-1074, 1), s * 0x1p-1074);
    SAME(ethd_atan2(s * 0x1p-1074, DBL_MAX), s * 0.0);
    SAME(ethd_atan2(s * DBL_MAX, DBL_MAX), s * pi / 4);
    SAME(ethd_atan2(s * 0x1p-1074, 0x1p-1074), s * pi / 4);
    IS_NAN(ethd_atan2(nan, s * 1));
    IS_NAN(ethd_atan2(s * inf, nan));
    IS_NAN(ethd_atan2(nan, nan));
  }
}

/* ---- properties ---- */

TEST(test_symmetry) {
  for (uint64_t i = 0; i < POINTS; i++) {
    double x = i % 2 ? turns(i) : any_finite(i), y = any_finite(i + POINTS), s, c;

    ethd_sincos(x, &s, &c);
    SAME(s, ethd_sin(x));
    SAME(c, ethd_cos(x));
    SAME(ethd_sin(-x), -ethd_sin(x));
    SAME(ethd_cos(-x), ethd_cos(x));
    SAME(ethd_tanh(-x), -ethd_tanh(x));
    SAME(ethd_atan2(-y, x), -ethd_atan2(y, x));
    if (!(fabs(s) <= 1 && fabs(c) <= 1 && fabs(ethd_tanh(x)) <= 1)) ck_abort_msg("over 1 at %a", x);
    if (!(fabs(ethd_atan2(y, x)) <= (double)(2 * PI_2))) ck_abort_msg("over pi at %a, %a", y, x);
  }
  double s, c;
  ethd_sincos(-0.0, &s, &c);
  SAME(s, -0.0);
  SAME(c, 1.0);
}

/* Side by side as one by one: angles of all sizes, and those next to multiples of pi/4. */
TEST(test_two_at_once) {
  for (uint64_t i = 0; i < POINTS; i++) {
    two x = {i % 3 ? turns(i) : any_finite(i), i % 5 ? many_turns(i) : near_eighth_turns(i)};
    two_waves w = two_sincos(x);
    for (int k = 0; k < 2; k++) {
      SAME(w.sine[k], ethd_sin(x[k]));
      SAME(w.cosine[k], ethd_cos(x[k]));
    }
  }
}

TEST(test_monotonic) {
  double before[4] = {-2, -1, -2000, -4};
  for (int i = -POINTS; i <= POINTS; i++) {
    double u = (double)i / POINTS, a = (double)(2 * PI_2) * u * (1 - 1e-9);
    double now[4] = {ethd_tanh(8 * u), ethd_exp(700 * u), ethd_log(ethd_exp(700 * u)),
                     ethd_atan2(ethd_sin(a), ethd_cos(a))};
    for (int k = 0; k < 4; k++) {
      if (!(k ? now[k] > before[k] : now[k] >= before[k])) ck_abort_msg("function %d at %a", k, u);
      before[k] = now[k];
    }
  }
}

/* ---- the same bits everywhere ---- */

static uint64_t fnv(uint64_t hash, double x) {
  uint64_t u = bits_of(x);
  for (int k = 0; k < 8; k++, u >>= 8) hash = (hash ^ (u & 0xff)) * 0x100000001b3u;
  return hash;
}

/* 1e5 results; points and results all normal. */
static uint64_t golden(void) {
  uint64_t hash = 0xcbf29ce484222325u;
  for (uint64_t i = 0; i < 10000; i++) {
    double u = (double)(draw_bits(i) >> 11) * 0x1p-53 - 0.5, v = (double)(draw_bits(~i) >> 11) * 0x1p-53 - 0.5;
    double s, c, scale = of_bits((1023 + i % 900) << 52);

    ethd_sincos(u * 0x1p17, &s, &c);
    hash = fnv(fnv(hash, s), c);
    hash = fnv(hash, ethd_sin(u * 4));
    hash = fnv(hash, ethd_cos(u * scale));
    hash = fnv(hash, ethd_atan2(u, v));
    hash = fnv(hash, ethd_atan2(u * 0x1p-20, v));
    hash = fnv(hash, ethd_exp(u * 1400));
    hash = fnv(hash, ethd_log((u + 0.75) * scale));
    hash = fnv(hash, ethd_tanh(u * 8));
    hash = fnv(hash, ethd_tanh(u / 2));
  }
  return hash;
}

static const uint64_t golden_hash = 0x6cba1c17bc660b0bu;

TEST(test_golden) { ck_assert_uint_eq(golden(), golden_hash); }

#ifdef __SSE2__
TEST(test_golden_without_subnormals) {
  unsigned before = _mm_getcsr();
  _mm_setcsr(before | 0x8040); /* FTZ, DAZ */
  uint64_t hash = golden();
  _mm_setcsr(before);
  ck_assert_uint_eq(hash, golden_hash);
}
#endif
