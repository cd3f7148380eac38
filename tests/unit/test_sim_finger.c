/* The other sensors of the simulated finger: what a reading holds, how often and how late it comes, and that its error
   is what it says. */
#include <stdlib.h>

#include "ethd/driver.h"
#include "unit/sim_rig.h"

enum { TICKS = 400 };

typedef struct seen {
  int readings;
  int64_t late_most, late_least; /* ns, from the sample to the tick at which it came */
  double square[2], told;        /* of the errors, m^2; mean of what was told, squared */
} seen;

/* A finger that wanders through the ring, which stands still. */
static seen watch(const ethd_sim_def *def, int64_t have) {
  ethd_sim_tap tap = sim_tap();
  ethd_path_sample path[9];
  ethd_truth truth[TICKS];
  seen s = {.late_least = INT64_MAX};
  for (int i = 0; i < 9; i++)
    path[i] = (ethd_path_sample){0.05 * i, 0.25 + 2e-3 * cos(2.1 * i), 0.25 + 1.5e-3 * sin(1.3 * i)};
  tap.path = (ethd_path){.samples = path, .sample_count = 9};
  tap.finger_radius = def->plant.finger_radius;
  ethd_sim *sim = sim_open(def, &tap);
  for (int k = 0; k < TICKS; k++) {
    truth[k] = sim_truth(sim);
    ethd_sense r = sim_sense(sim);
    if (k && (r.have & (ETHD_HAVE_CENTRE | ETHD_HAVE_RAYS))) {
      ck_assert_int_eq(r.have, have);
      double at = 1e-6 * (double)r.sample_ns, share = at - floor(at);
      const ethd_truth *a = &truth[(int)at], *b = &truth[(int)at + ((int)at < k)];
      for (int i = 0; i < 2; i++) {
        double finger = (1 - share) * a->finger[i] + share * b->finger[i];
        double from = have & ETHD_HAVE_WORLD ? 0 : (1 - share) * a->ring[i] + share * b->ring[i];
        s.square[i] += pow(r.centre[i] - (finger - from), 2);
      }
      s.told += r.finger_noise * r.finger_noise;
      s.late_most = s.late_most > r.time_ns - r.sample_ns ? s.late_most : r.time_ns - r.sample_ns;
      s.late_least = s.late_least < r.time_ns - r.sample_ns ? s.late_least : r.time_ns - r.sample_ns;
      s.readings++;
    }
    sim_push(sim, 0, 0);
  }
  ethd_sim_destroy(sim);
  s.told /= s.readings;
  for (int i = 0; i < 2; i++) s.square[i] /= s.readings;
  return s;
}

static ethd_sim_def with(int32_t reading) {
  ethd_sim_def def = sim_def();
  sim_hold(&def);
  ethd_plant_finger(&def.plant, reading);
  return def;
}

static void check_timing(const seen *s, double rate, double latency) {
  ck_assert_int_le(abs(s->readings - (int)(TICKS * 1e-3 * rate)), 5);
  ck_assert_double_ge(1e-9 * (double)s->late_least, latency - 1e-9);
  ck_assert_double_le(1e-9 * (double)s->late_most, latency + 1e-3 + 1e-9);
}

/* The camera's noise is white: 36 readings, each axis. */
TEST(test_camera) {
  ethd_sim_def def = with(ETHD_READING_CAMERA);
  seen s = watch(&def, ETHD_HAVE_CENTRE | ETHD_HAVE_WORLD);
  check_timing(&s, 90, 11.1e-3);
  ck_assert_double_eq_tol(sqrt(s.told), 0.15e-3, 1e-12);
  for (int i = 0; i < 2; i++) ck_assert_double_eq_tol(sqrt(s.square[i]) / 0.15e-3, 1, 0.35);
}

/* The plate's distance along x; across it nothing is known. */
TEST(test_nail) {
  ethd_sim_def def = with(ETHD_READING_NAIL);
  seen s = watch(&def, ETHD_HAVE_CENTRE | ETHD_HAVE_RING);
  check_timing(&s, 300, 1.2e-3);
  ck_assert_double_eq_tol(sqrt(s.square[0]) / sqrt(s.told), 1, 0.3);
  ck_assert_double_gt(sqrt(s.square[1]), 0.5e-3);
  def.plant.noise = 0;
  s = watch(&def, ETHD_HAVE_CENTRE | ETHD_HAVE_RING); /* the converter's steps alone */
  ck_assert_double_eq_tol(sqrt(s.told), 10e-3 / 1024 / sqrt(12), 1e-12);
  ck_assert_double_le(sqrt(s.square[0]), 2 * sqrt(s.told));
}

/* Barriers: an error of tenths of a millimetre, which each reading tells about; finer with more of them. */
TEST(test_zones) {
  double error[2];
  for (int i = 0; i < 2; i++) {
    ethd_sim_def def = with(ETHD_READING_ZONES);
    def.plant.zones = i ? 16 : 8;
    seen s = watch(&def, ETHD_HAVE_CENTRE | ETHD_HAVE_RING);
    check_timing(&s, 300, 1.2e-3);
    error[i] = sqrt((s.square[0] + s.square[1]) / 2);
    ck_assert_double_gt(error[i], 0.1e-3);
    ck_assert_double_lt(error[i], 2 * sqrt(s.told));
    ck_assert_double_gt(error[i], 0.4 * sqrt(s.told));
  }
  ck_assert_double_lt(error[1], error[0]);
}

/* ---- [device] ---- */

static ethd_status open_sim(const char *key, const char *value, ethd_limits *limits, char message[ETHD_MESSAGE_MAX]) {
  const ethd_setting settings[] = {{"finger", key ? "zones" : value, 3}, {key, value, 4}};
  const ethd_setup setup = ethd_setup_default();
  const ethd_device_def def = {&setup, settings, key ? 2 : 1, "apps/config", "c.ini", 1, NULL};
  ethd_device *device;
  ethd_status status = ethd_device_open("sim", NULL, &def, &device, message);
  if (status) return status;
  *limits = ethd_device_limits(device);
  ethd_device_close(device);
  return ETHD_OK;
}

TEST(test_settings) {
  char message[ETHD_MESSAGE_MAX];
  ethd_limits limits;
  ck_assert_msg(!open_sim(NULL, "camera", &limits, message), "%s", message);
  ck_assert_double_eq_tol(limits.finger_age, 11.1e-3 + 3 / 90.0, 1e-12);
  ck_assert(!open_sim(NULL, "rays", &limits, message));
  ck_assert(isinf(limits.finger_age)); /* as ever */
  ck_assert(!open_sim("finger_rate", "50", &limits, message));
  ck_assert_double_eq_tol(limits.finger_age, 1.2e-3 + 3 / 50.0, 1e-12);
  const char *const bad[][3] = {
      {NULL, "eyes", "c.ini:3: device.finger: "},          {"zones", "7", "c.ini:4: device.zones: "},
      {"zones", "17", "c.ini:4: device.zones: "},          {"zones", "9.5", "c.ini:4: device.zones: "},
      {"zone_reach", "0", "c.ini:4: device.zone_reach: "}, {"finger_rate", "0", "c.ini:4: device.finger_rate: "}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    ck_assert_int_lt(open_sim(bad[i][0], bad[i][1], &limits, message), 0);
    ck_assert_msg(strstr(message, bad[i][2]) == message, "%s", message);
  }
}
