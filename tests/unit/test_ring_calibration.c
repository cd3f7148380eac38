/* Counts to distance, calibration files, and fits to a rod at known places. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "text/text.h"
#include "unit/rig.h"
#include "unit/ring_rod.h"

static char message[ETHD_MESSAGE_MAX];

TEST(test_law) {
  ethd__calibration c = ethd__calibration_default();
  ethd__sensor *s = &c.sensors[0];
  ck_assert(isnan(ethd__sensor_distance(s, 9000))); /* no dark yet */
  s->dark = 2000;
  ck_assert(isnan(ethd__sensor_distance(s, 0)));
  ck_assert(ethd__sensor_distance(s, 2000) == ETHD__DISTANCE_MAX && ethd__sensor_distance(s, 1) == ETHD__DISTANCE_MAX);
  ck_assert_double_eq_tol(ethd__sensor_distance(s, 2000 + 10204), 4.5e-3, 1e-6); /* 0.5 / (7 mm)^2 */
  for (double d = 0.4e-3; d < 12e-3; d += 0.1e-3)
    ck_assert_double_eq_tol(ethd__sensor_distance(s, (uint16_t)(ethd__sensor_counts(s, d) + 0.5)), d, 10e-6);
  for (int counts = 2001; counts < 65535; counts++)
    ck_assert(ethd__sensor_distance(s, (uint16_t)(counts + 1)) <= ethd__sensor_distance(s, (uint16_t)counts));
}

TEST(test_table) {
  ethd__calibration c = ethd__calibration_default();
  ethd__sensor *s = &c.sensors[0];
  s->dark = 1000;
  s->points = 3;
  memcpy(s->above, (double[]){40000, 20000, 10000}, 3 * sizeof(double));
  memcpy(s->at, (double[]){1e-3, 2e-3, 4e-3}, 3 * sizeof(double));
  double half = 0.5 * (1 / sqrt(40000) + 1 / sqrt(20000)), middle = rint(1000 + 1 / (half * half));
  const double at[][2] = {{41000, 1e-3}, {middle, 1.5e-3}, {21000, 2e-3}, {11000, 4e-3}, {1000, ETHD__DISTANCE_MAX}};
  for (size_t i = 0; i < sizeof at / sizeof *at; i++)
    ck_assert_double_eq_tol(ethd__sensor_distance(s, (uint16_t)at[i][0]), at[i][1], 1e-7);
  for (double d = 1e-3; d < 6e-3; d += 0.1e-3)
    ck_assert_double_eq_tol(ethd__sensor_distance(s, (uint16_t)(ethd__sensor_counts(s, d) + 0.5)), d, 1e-6);
}

/* ---- fits ---- */

static double recovery(const ethd__calibration *truth, const ethd__calibration *fitted) {
  double sum = 0;
  int count = 0;
  for (int k = 0; k < ETHD_RAYS; k++)
    for (double d = 0.5e-3; d <= 9e-3; d += 0.25e-3, count++) {
      double e = ethd__sensor_distance(&fitted->sensors[k], (uint16_t)rod_counts(truth, k, d, 0, 0)) - d;
      sum += e * e;
    }
  return sqrt(sum / count);
}

static ethd__calibration fitted(ethd__level level, const ethd__calibration *truth, double noise, uint64_t seed) {
  ethd__place_reading at[ROD_PLACES];
  ethd__calibration c = ethd__calibration_default();
  for (int k = 0; k < ETHD_RAYS; k++)
    c.sensors[k].dark = truth->sensors[k].dark + noise * draw_normal(seed * 77 + (uint64_t)k);
  for (int i = 0; i < ROD_PLACES; i++) at[i] = rod_reading(truth, rod_place(i), noise, seed * 100 + (uint64_t)i);
  ethd_status status = ethd__calibration_fit(level, (ethd__place_readings){at, ROD_PLACES}, &c, message);
  ck_assert_msg(status == ETHD_OK, "%s", message);
  return c;
}

TEST(test_fit) {
  static const double most[ETHD__LEVEL_COUNT] = {0.8e-3, 0.6e-3, 0.2e-3, 0.03e-3, 0.1e-3}; /* with noise, m rms */
  double worst[ETHD__LEVEL_COUNT] = {0}, residual[ETHD__LEVEL_COUNT] = {0};
  for (uint64_t seed = 1; seed <= 10; seed++)
    for (int level = 0; level < ETHD__LEVEL_COUNT; level++) {
      ethd__calibration truth = rod_truth(seed), c = fitted((ethd__level)level, &truth, 3, seed);
      worst[level] = fmax(worst[level], recovery(&truth, &c));
      residual[level] = fmax(residual[level], c.residual);
    }
  for (int level = 0; level < ETHD__LEVEL_COUNT; level++) {
    printf("%-7s residual %.4f mm, error of the recovered law over 0.5 to 9 mm %.4f mm rms (worst of 10 rings)\n",
           ethd__level_names[level], 1e3 * residual[level], 1e3 * worst[level]);
    ck_assert_double_le(worst[level], most[level]);
  }
}

/* Without noise the law comes back as it was. */
TEST(test_exact) {
  ethd__calibration truth = rod_truth(3);
  ethd__place_reading at[ROD_PLACES];
  ethd__calibration c = ethd__calibration_default();
  for (int i = 0; i < ROD_PLACES; i++) {
    at[i] = ethd__place_expected(ROD_RING, ROD_RADIUS, rod_place(i));
    for (int k = 0; k < ETHD_RAYS; k++)
      at[i].counts[k] = isnan(at[i].distance[k]) ? 0 : ethd__sensor_counts(&truth.sensors[k], at[i].distance[k]);
  }
  for (int k = 0; k < ETHD_RAYS; k++) c.sensors[k].dark = truth.sensors[k].dark;
  ck_assert_int_eq(ethd__calibration_fit(ETHD__LEVEL_LAW, (ethd__place_readings){at, ROD_PLACES}, &c, message),
                   ETHD_OK);
  ck_assert_double_le(c.residual, 1e-9);
  for (int k = 0; k < ETHD_RAYS; k++) {
    ck_assert_double_eq_tol(c.sensors[k].p, truth.sensors[k].p, 1e-5);
    ck_assert_double_eq_tol(c.sensors[k].d0, truth.sensors[k].d0, 1e-8);
  }
}

TEST(test_too_few) {
  ethd__calibration truth = rod_truth(1), c = truth;
  ethd__place_reading at[ROD_PLACES];
  for (int i = 0; i < ROD_PLACES; i++) {
    at[i] = rod_reading(&truth, rod_place(i), 0, 1);
    at[i].counts[5] = i == 1 ? 5000 : i % 2 ? 0 : 65535;
  }
  ck_assert_int_lt(ethd__calibration_fit(ETHD__LEVEL_LAW, (ethd__place_readings){at, ROD_PLACES}, &c, message), 0);
  ck_assert_str_eq(message, "sensor 5: 1 usable reading, at least 4 are needed: is it missing, dirty or saturated?");
  ck_assert_int_lt(ethd__calibration_fit(ETHD__LEVEL_COMMON, (ethd__place_readings){at, 0}, &c, message), 0);
}

/* ---- files ---- */

TEST(test_round_trip) {
  char path[] = "/tmp/ethd-ring-XXXXXX";
  close(mkstemp(path));
  for (int level = 0; level < ETHD__LEVEL_COUNT; level++) {
    ethd__calibration truth = rod_truth(7), c = fitted((ethd__level)level, &truth, 3, 7), back;
    strcpy(c.date, "2026-11-22");
    strcpy(c.serial, "ring 7");
    strcpy(c.sensors[9].serial, "a 9");
    ck_assert_msg(ethd__calibration_save(&c, path, message) == ETHD_OK, "%s", message);
    ck_assert_msg(ethd__calibration_load(path, &back, message) == ETHD_OK, "%s", message);
    ck_assert(back.level == c.level && back.residual == c.residual);
    ck_assert_str_eq(back.date, c.date);
    ck_assert_str_eq(back.sensors[9].serial, "a 9");
    for (int k = 0; k < ETHD_RAYS; k++)
      for (uint32_t counts = 1; counts < 65536; counts += 17)
        ck_assert(ethd__sensor_distance(&back.sensors[k], (uint16_t)counts) ==
                  ethd__sensor_distance(&c.sensors[k], (uint16_t)counts));
  }
  unlink(path);
}

static const struct {
  const char *text, *says;
} bads[] = {
    {"", "x: calibration.level is missing"},
    {"[calibration]\nlevel = best\n", "x:2: calibration.level: found \"best\", none|common|gain|law|table is allowed"},
    {"[calibration]\nlevel = none\n[law]\na = 1\n", "x:4: [law]: level none has none"},
    {"[calibration]\nlevel = common\n[law]\na = 1x\n",
     "x:4: law.a: found \"1x\", 1e-09 to 1000000000 counts m^p is allowed"},
    {"[calibration]\nlevel = common\n[law]\np = 9\n", "x:4: law.p: found \"9\", 0.5 to 8 is allowed"},
    {"[calibration]\nlevel = common\n[law]\na = nan\n",
     "x:4: law.a: found \"nan\", 1e-09 to 1000000000 counts m^p is allowed"},
    {"[calibration]\nlevel = common\n[law]\ndark = 1\n",
     "x:4: law.dark: unknown key at level common; a, p, d0 are allowed"},
    {"[calibration]\nlevel = common\n[sensor 3]\na = 1\n",
     "x:4: sensor 3.a: unknown key at level common; dark, residual, serial are allowed"},
    {"[calibration]\nlevel = gain\n[sensor 3]\np = 1\n", "x:4: sensor 3.p: unknown key at level gain"},
    {"[calibration]\nlevel = law\n[sensor 3]\np = 2\n", "x: [sensor 0] is missing; level law needs all 16"},
    {"[calibration]\nlevel = none\n[sensor 16]\ndark = 2\n", "x:3: [\"sensor 16\"]: unknown section"},
    {"[calibration]\nlevel = none\n[sensor 01]\ndark = 2\n", "x:3: [\"sensor 01\"]: unknown section"},
    {"[calibration]\nlevel = none\nlevel = law\n", "x:3:"},
    {"[calibration]\nlevel = table\n[sensor 0]\npoint1 = 2 1\n", "x:4: sensor 0.point1: unknown key at level table"},
    {"[calibration]\nlevel = table\n[sensor 0]\npoint0 = 2\n",
     "x:4: sensor 0.point0: found \"2\", COUNTS_ABOVE_DARK METRES"},
    {"[calibration]\nlevel = table\n[sensor 0]\npoint0 = 2 1e-3\npoint1 = 2 2e-3\n", "x:5: sensor 0.point1: found"},
    {"[calibration]\nlevel = table\n[sensor 0]\npoint0 = 2 1e-3\npoint1 = 1 1e-3\n", "x:5: sensor 0.point1: found"},
};

TEST(test_bad_texts) {
  for (size_t i = 0; i < sizeof bads / sizeof *bads; i++) {
    ethd__calibration c;
    ck_assert_msg(ethd__calibration_parse(bads[i].text, strlen(bads[i].text), "x", &c, message) < 0, "%s",
                  bads[i].text);
    ck_assert_msg(!strncmp(message, bads[i].says, strlen(bads[i].says)), "%s\nsays %s", bads[i].text, message);
  }
}
