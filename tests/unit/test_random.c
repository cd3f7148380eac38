/* Random numbers by key: known answers of the cipher, moments, independence of every part of the key. */
#include <math.h>

#include "sim/random.h"
#include "unit/rig.h"

enum { MANY = 40000 };

/* The vectors published with the cipher: zeros, ones, digits of pi. */
TEST(test_known_answers) {
  static const struct {
    uint32_t key[2], counter[4], out[4];
  } known[] = {
      {{0, 0}, {0, 0, 0, 0}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
      {{0xffffffff, 0xffffffff},
       {0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff},
       {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
      {{0xa4093822, 0x299f31d0},
       {0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
       {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}},
  };
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    uint32_t block[4];
    for (int k = 0; k < 4; k++) block[k] = known[i].counter[k];
    ethd__philox(known[i].key, block);
    for (int k = 0; k < 4; k++) ck_assert_uint_eq(block[k], known[i].out[k]);
  }
}

/* Chi square of 32 equal bins: 31 +- 7.9. */
TEST(test_uniform) {
  ethd__sim_key key = {1, 2};
  int bins[32] = {0};
  double sum = 0, chi = 0;
  for (uint32_t i = 0; i < MANY; i++) {
    double u = ethd__uniform(key, 3, i);
    ck_assert(u >= 0 && u < 1);
    ck_assert(u * 0x1p53 == floor(u * 0x1p53));
    bins[(int)(32 * u)]++;
    sum += u;
  }
  for (int i = 0; i < 32; i++) chi += pow(bins[i] - MANY / 32.0, 2) / (MANY / 32.0);
  ck_assert_double_eq_tol(sum / MANY, 0.5, 4 * sqrt(1.0 / 12 / MANY));
  ck_assert_double_eq_tol(chi, 31, 4 * 7.9);
}

/* Mean, variance, skewness, kurtosis, share within one and two sd; neighbours are independent. */
TEST(test_normal) {
  ethd__sim_key key = {7, 0};
  double m[5] = {0}, last = 0, product = 0;
  int within[3] = {0};
  for (uint32_t i = 0; i < MANY; i++) {
    double g = ethd__normal(key, 9, i), power = 1;
    for (int k = 1; k <= 4; k++) m[k] += (power *= g) / MANY;
    for (int k = 1; k <= 2; k++) within[k] += fabs(g) < k;
    product += g * last / MANY;
    last = g;
  }
  double unit = sqrt(1.0 / MANY);
  ck_assert_double_eq_tol(m[1], 0, 4 * unit);
  ck_assert_double_eq_tol(m[2], 1, 4 * sqrt(2) * unit);
  ck_assert_double_eq_tol(m[3], 0, 4 * sqrt(15) * unit);
  ck_assert_double_eq_tol(m[4], 3, 4 * sqrt(96) * unit);
  for (int k = 1; k <= 2; k++) {
    double share = erf(k / sqrt(2));
    ck_assert_double_eq_tol((double)within[k] / MANY, share, 4 * sqrt(share * (1 - share)) * unit);
  }
  ck_assert_double_eq_tol(product, 0, 4 * unit);
}

/* Drawn anew, not moved to the cut: variance 1 - 2 c phi(c)/(2 Phi(c) - 1), nothing piles up at +-c. */
static void cut_is_right(double cut) {
  double square = 0, sum = 0;
  int edge = 0;
  for (uint64_t tap = 0; tap < MANY; tap++) {
    double g = ethd__normal_cut((ethd__sim_key){5, tap}, 4, cut);
    ck_assert(fabs(g) <= cut);
    edge += fabs(g) > 0.99 * cut;
    sum += g / MANY;
    square += g * g / MANY;
  }
  double density = exp(-cut * cut / 2) / sqrt(2 * 3.14159265358979323846), inside = erf(cut / sqrt(2));
  double variance = 1 - 2 * cut * density / inside;
  ck_assert_double_eq_tol(sum, 0, 4 * sqrt(variance / MANY));
  ck_assert_double_eq_tol(square, variance, 4 * sqrt(2.0 / MANY));
  double at_edge = 2 * density * 0.01 * cut / inside * MANY;
  ck_assert_double_eq_tol(edge, at_edge, 0.05 * at_edge + 4 * sqrt(at_edge));
}

TEST(test_cut) {
  cut_is_right(2);
  cut_is_right(2.5);
  cut_is_right(0.5);
}

/* Every bit of the key counts, and the same key gives the same number. */
TEST(test_key) {
  const ethd__sim_key key = {0x0123456789abcdef, 42};
  double one = ethd__uniform(key, 5, 6);
  ck_assert(one == ethd__uniform(key, 5, 6));
  for (int bit = 0; bit < 64; bit++) {
    uint64_t flip = (uint64_t)1 << bit;
    ck_assert(one != ethd__uniform((ethd__sim_key){key.seed ^ flip, key.tap}, 5, 6));
    ck_assert(one != ethd__uniform((ethd__sim_key){key.seed, key.tap ^ flip}, 5, 6));
    if (bit >= 32) continue;
    ck_assert(one != ethd__uniform(key, 5 ^ (uint32_t)flip, 6));
    ck_assert(one != ethd__uniform(key, 5, 6 ^ (uint32_t)flip));
  }
  ck_assert(ethd__uniform((ethd__sim_key){1, 2}, 0, 0) != ethd__uniform((ethd__sim_key){2, 1}, 0, 0));
}
