/* What is drawn for a tap: means and spreads as the plant says, cut where it says, reproducible. */
#include <stdio.h>

#include "unit/sim_rig.h"

enum { MANY = 20000, DRAWN = 6 };

/* Standard deviation of a normal number cut at +-c, drawn anew beyond. */
static double cut_sd(double c) {
  double density = exp(-c * c / 2) / sqrt(2 * 3.14159265358979323846);
  return sqrt(1 - 2 * c * density / erf(c / sqrt(2)));
}

/* Back to standard numbers: speed, radius, start, overshoot, lateral; phase within 0 to 1. */
static void standard(const ethd_plant *p, const ethd_sim_tap *t, double speed, ethd_vec meet, double z[DRAWN]) {
  z[0] = (t->commanded / speed - 1) / p->speed_spread;
  z[1] = (t->finger_radius - p->finger_radius) / p->finger_radius_sd;
  z[2] = (t->path.from.x - meet.x - p->start) / p->start_sd;
  z[3] = log((meet.x - t->path.to_x) / p->overshoot) / p->overshoot_spread;
  z[4] = (t->path.from.y - meet.y) / p->lateral_sd;
  z[5] = t->phase * p->rate;
}

TEST_LOOP(test_moments, 0, 4) {
  static const char *const plants[] = {"n", "b", "p", "q"};
  char path[64], message[ETHD_MESSAGE_MAX];
  snprintf(path, sizeof path, "apps/config/%s.plant", plants[_i]);
  ethd_plant plant;
  ck_assert_msg(ethd_plant_load(path, &plant, message) == ETHD_OK, "%s", message);
  const ethd_vec meet = {0.25, 0.24};
  double sum[DRAWN] = {0}, square[DRAWN] = {0}, most[DRAWN] = {0}, cross[DRAWN][DRAWN] = {{0}};
  for (uint64_t k = 0; k < MANY; k++) {
    ethd_sim_tap t;
    double z[DRAWN];
    ethd_sim_draw(&plant, 11, k, 0.4, meet, &t);
    standard(&plant, &t, 0.4, meet, z);
    ck_assert(t.seed == 11 && t.tap == k && t.path.sample_count == 0);
    ck_assert(t.path.profile == plant.profile && t.path.ramp_up == 0.08 && t.path.ramp_down == 0.03);
    ck_assert(plant.profile ? t.path.speed > t.commanded : t.path.speed == t.commanded);
    ck_assert(z[5] >= 0 && z[5] < 1);
    for (int i = 0; i < DRAWN; i++) {
      double c = z[i] - (i == 5 ? 0.5 : 0);
      sum[i] += c / MANY;
      square[i] += c * c / MANY;
      most[i] = fmax(most[i], fabs(c));
      for (int j = 0; j < i; j++) cross[i][j] += c * (z[j]) / MANY;
    }
  }
  for (int i = 0; i < DRAWN; i++) {
    double cut = i == 0 ? 2.5 : 2, sd = i == 5 ? sqrt(1.0 / 12) : cut_sd(cut);
    ck_assert_double_eq_tol(sum[i], 0, 4 * sd / sqrt(MANY));
    ck_assert_double_eq_tol(sqrt(square[i]), sd, 0.02 * sd);
    ck_assert_double_le(most[i], (i == 5 ? 0.5 : cut) * (1 + 1e-9));
    ck_assert_double_ge(most[i], 0.99 * (i == 5 ? 0.5 : cut));
    for (int j = 0; j < i; j++) ck_assert_double_eq_tol(cross[i][j], 0, 4.5 / sqrt(MANY));
  }
}

/* The same key draws the same; the same numbers stand behind any speed and place. */
TEST(test_key) {
  ethd_sim_def def = sim_def();
  ethd_sim_tap a, b;
  double y[DRAWN], z[DRAWN];
  const ethd_vec here = {0.25, 0.25}, there = {0.22, 0.3};
  memset(&a, 0, sizeof a);
  memset(&b, 0, sizeof b);
  ethd_sim_draw(&def.plant, 1, 2, 0.5, here, &a);
  ethd_sim_draw(&def.plant, 1, 2, 0.5, here, &b);
  ck_assert(a.commanded == b.commanded && a.phase == b.phase && a.path.to_x == b.path.to_x);
  ethd_sim_draw(&def.plant, 1, 2, 0.2, there, &b);
  standard(&def.plant, &a, 0.5, here, y);
  standard(&def.plant, &b, 0.2, there, z);
  for (int i = 0; i < DRAWN; i++) ck_assert_double_eq_tol(y[i], z[i], 1e-9);
  for (uint64_t other = 0; other < 2; other++) {
    ethd_sim_draw(&def.plant, 1 + other, 3 - other, 0.5, here, &b);
    standard(&def.plant, &b, 0.5, here, z);
    for (int i = 0; i < DRAWN; i++) ck_assert_double_gt(fabs(y[i] - z[i]), 1e-6);
  }
}

/* A movement of minimum jerk passes `meet` at the commanded speed, unless it were more than 3 times as fast halfway. */
TEST(test_speed_at_the_wall) {
  ethd_sim_def def = sim_def();
  const ethd_vec meet = {0.25, 0.24};
  def.plant.profile = ETHD_PROFILE_MINIMUM_JERK;
  def.plant.overshoot = 8e-3;
  def.plant.overshoot_spread = 1;
  int capped = 0;
  for (uint64_t k = 0; k < 2000; k++) {
    ethd_sim_tap t;
    ethd_vec x, v;
    ethd_sim_draw(&def.plant, 4, k, 0.4, meet, &t);
    double low = 0, high = ethd_path_end(&t.path), length = t.path.from.x - t.path.to_x;
    ck_assert_double_eq_tol(high, 1.875 * length / t.path.speed, 1e-15);
    while (high - low > 1e-15) {
      double middle = (low + high) / 2;
      ethd_path_at(&t.path, middle, &x, &v);
      *(x.x > meet.x ? &low : &high) = middle;
    }
    ck_assert_double_eq_tol(x.x, meet.x, 1e-14);
    bool cap = fabs(t.path.speed - 3 * t.commanded) < 1e-12;
    ck_assert(cap ? -v.x < t.commanded : fabs(v.x + t.commanded) < 1e-12 && t.path.speed < 3 * t.commanded);
    capped += cap;
  }
  ck_assert(capped > 20 && capped < 1000);
}

/* A hand that would be faster than any isn't drawn, and neither one that doesn't move. */
TEST(test_extreme_movements) {
  ethd_sim_def def = sim_def();
  ethd_sim_tap t;
  def.plant.profile = ETHD_PROFILE_MINIMUM_JERK;
  ethd_sim_draw(&def.plant, 4, 1, 190, (ethd_vec){0.25, 0.24}, &t);
  ck_assert_double_eq(t.path.speed, ETHD_HAND_SPEED_MAX);
  def.plant.start = def.plant.start_sd = def.plant.overshoot = 0;
  ethd_sim_draw(&def.plant, 4, 1, 0.4, (ethd_vec){0.25, 0.24}, &t);
  ethd_sim_destroy(sim_open(&def, &t));
}
