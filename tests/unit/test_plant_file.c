/* Plant files: the three that come with the programs say what is known of them; anything else than a
   whole file is refused with its line. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "ethd/config.h"
#include "ethd/sim.h"
#include "unit/suite.h"

#define PI 3.14159265358979323846

static ethd_plant plant;
static char message[ETHD_MESSAGE_MAX], file[] = "/tmp/ethd-plant-XXXXXX", text[1 << 14];

static void load(const char *name) {
  char path[64];
  snprintf(path, sizeof path, "apps/config/%s.plant", name);
  ck_assert_msg(ethd_plant_load(path, &plant, message) == ETHD_OK, "%s", message);
}

static void is(double value, double expected) { ck_assert_double_le(fabs(value - expected), 1e-12 * fabs(expected)); }

static void make_file(void) { ck_assert_int_eq(close(mkstemp(file)), 0); }
static void remove_file(void) { unlink(file); }
FIXTURE(make_file, remove_file)

TEST(test_n) {
  load("n");
  const double got[] = {plant.mass[0],
                        plant.mass[1],
                        plant.coupling,
                        plant.force_limit,
                        plant.friction,
                        plant.viscous,
                        plant.delay,
                        plant.count,
                        plant.finger_mass,
                        plant.hand_stiffness,
                        plant.hand_damping,
                        plant.pad_stiffness,
                        plant.pad_damping,
                        plant.finger_radius,
                        plant.finger_radius_sd,
                        plant.rate,
                        plant.latency,
                        plant.noise,
                        plant.start,
                        plant.start_sd,
                        plant.overshoot,
                        plant.overshoot_spread,
                        plant.ramp_up,
                        plant.ramp_down,
                        plant.lateral_sd,
                        plant.speed_low,
                        plant.speed_high,
                        plant.speed_spread,
                        plant.band_low,
                        plant.band_high};
  const double expected[] = {0.1173,  0.25,   0,       5.357, 0.398,   1.267,   71e-6,   2 * PI / (4000 * 9.80),
                             0.0675,  284.7,  4.27,    27436, 1.06,    7.32e-3, 0.43e-3, 300,
                             1.93e-3, 0.1e-3, 31.6e-3, 5e-3,  55.5e-3, 0.35,    0.08,    0.03,
                             0.5e-3,  0.197,  0.521,   0.19,  0.06,    0.08};
  for (size_t i = 0; i < sizeof got / sizeof *got; i++) is(got[i], expected[i]);
  ck_assert(isinf(plant.stiffness) && !plant.count_phase && !plant.reading && !plant.reference && !plant.metrics_side);
}

TEST(test_b) {
  load("b");
  const double got[] = {plant.mass[0],          plant.mass[1],      plant.force_limit,   plant.friction,
                        plant.viscous,          plant.delay,        plant.count,         plant.finger_mass,
                        plant.hand_stiffness,   plant.hand_damping, plant.pad_stiffness, plant.pad_damping,
                        plant.finger_radius,    plant.latency,      plant.start,         plant.overshoot,
                        plant.overshoot_spread, plant.speed_low,    plant.speed_high,    plant.speed_spread};
  const double expected[] = {0.1445, 0.25,    5.369, 0.164, 0.556, 273e-6,  2 * PI / (4000 * 6.56),
                             0.0307, 121.8,   2.70,  15610, 0.057, 8.15e-3, 2.12e-3,
                             73e-3,  50.6e-3, 0.67,  0.183, 0.468, 0.17};
  for (size_t i = 0; i < sizeof got / sizeof *got; i++) is(got[i], expected[i]);
}

/* 88.1 Hz between free ends: k over the reduced mass. */
TEST(test_p) {
  load("p");
  double reduced = plant.motor_mass * (plant.mass[0] - plant.motor_mass) / plant.mass[0];
  ck_assert_double_eq_tol(sqrt(plant.stiffness / reduced) / (2 * PI), 88.1, 0.1);
  const double got[] = {
      plant.mass[0],          plant.mass[1],      plant.motor_mass,    plant.damping,     plant.force_limit,
      plant.friction,         plant.viscous,      plant.delay,         plant.count,       plant.finger_mass,
      plant.hand_stiffness,   plant.hand_damping, plant.pad_stiffness, plant.pad_damping, plant.finger_radius,
      plant.finger_radius_sd, plant.latency,      plant.start,         plant.overshoot,   plant.overshoot_spread,
      plant.speed_low,        plant.speed_high,   plant.speed_spread,  plant.band_low,    plant.band_high};
  const double expected[] = {0.09475,  0.09475, 0.01322, 5.132,  2.6313, 0.18266,  0.03008, 121.3e-6, 157.95e-6,
                             0.0410,   82.39,   2.568,   1e4,    0.5,    6.224e-3, 0.45e-3, 1.001e-3, 77.51e-3,
                             14.89e-3, 0.5595,  0.2050,  0.4713, 0.2726, 0.0339,   0.0577};
  for (size_t i = 0; i < sizeof got / sizeof *got; i++) is(got[i], expected[i]);
  ck_assert(plant.count_phase && plant.reference && plant.metrics_side && !plant.reading);
}

/* The rotors of the paper's motors, 70 g cm^2, at the ratio that the counts tell, are a part of the motor side; what q.ini and
   q.plant both say, they say alike. */
TEST(test_q) {
  load("q");
  double ratio = 2 * PI / (4000 * plant.count);
  ck_assert(ratio > 14 && ratio < 15 && plant.profile == ETHD_PROFILE_MINIMUM_JERK);
  ck_assert_double_gt(plant.motor_mass, 70e-7 * ratio * ratio / (0.25 * 0.25));
  ethd_config *config;
  ck_assert_msg(ethd_config_load("apps/config/q.ini", &config, message) == ETHD_OK, "%s", message);
  is(config->setup.dynamics.mass[0], plant.mass[0]);
  is(config->setup.dynamics.mass[1], plant.mass[1]);
  is(config->setup.finger_radius, plant.finger_radius);
  ethd_config_free(config);
  ck_assert(plant.count_phase && plant.reference && plant.metrics_side && !plant.reading);
}

/* ---- refusals ---- */

static void read_n(void) {
  FILE *in = fopen("apps/config/n.plant", "r");
  ck_assert_ptr_nonnull(in);
  text[fread(text, 1, sizeof text - 1, in)] = 0;
  fclose(in);
}

static ethd_status try(const char *content, size_t length) {
  FILE *out = fopen(file, "w");
  ck_assert_ptr_nonnull(out);
  ck_assert_uint_eq(fwrite(content, 1, length, out), length);
  fclose(out);
  memset(&plant, 0x55, sizeof plant);
  message[0] = 0;
  return ethd_plant_load(file, &plant, message);
}

/* n.plant with `was` replaced is refused, in one line that says `why`. */
static void refused(const char *was, const char *now, const char *why) {
  static char changed[sizeof text + 256];
  char *at = strstr(text, was);
  ck_assert_msg(at != NULL, "no %s", was);
  snprintf(changed, sizeof changed, "%.*s%s%s", (int)(at - text), text, now, at + strlen(was));
  ck_assert_msg(try(changed, strlen(changed)) < 0, "%s passes", now);
  ck_assert_msg(strstr(message, why) && !strchr(message, '\n'), "%s: %s", now, message);
  ck_assert_msg(!strncmp(message, file, strlen(file)), "%s", message);
}

TEST(test_refused) {
  read_n();
  ck_assert_int_eq(try(text, strlen(text)), ETHD_OK);
  refused("force_limit = 5.357", "force_limit = 5.357x", ":7: device.force_limit: found \"5.357x\", 0 to 1000000 N");
  refused("force_limit = 5.357", "force_limit = nan", ":7: device.force_limit");
  refused("force_limit = 5.357", "force_limit = inf", ":7: device.force_limit");
  refused("force_limit = 5.357", "force_limit = 0x5", ":7: device.force_limit");
  refused("force_limit = 5.357", "force_limit = -1", ":7: device.force_limit");
  refused("force_limit = 5.357", "force_limit = 1\nforce_limit = 1", "force_limit");
  refused("force_limit = 5.357", "force = 5.357", ":7: device.force: unknown key");
  refused("force_limit = 5.357", "", "device.force_limit is missing");
  refused("[finger]", "[thumb]", "thumb.mass: unknown section");
  refused("count_phase = zero", "count_phase = 0", "found \"0\", zero|drawn is allowed");
  refused("stiffness = inf", "stiffness = 3000", "transmission.motor_mass");
  refused("latency = 1.93e-3", "latency = 0.9", "proximity.latency");
  refused("speed_spread = 0.19", "speed_spread = 0.5", "movement.speed_spread");
  refused("radius_sd = 0.43e-3", "radius_sd = 4e-3", "finger.radius_sd");
}

/* Without any one of its lines the file isn't whole. */
TEST(test_every_key_counts) {
  static char less[sizeof text];
  read_n();
  int keys = 0;
  for (char *line = text; *line; line = strchr(line, '\n') + 1) {
    size_t length = (size_t)(strchr(line, '\n') + 1 - line), key = strcspn(line, " =\n");
    if (*line == '[' || *line == '#' || *line == '\n') continue;
    snprintf(less, sizeof less, "%.*s%s", (int)(line - text), text, line + length);
    ck_assert_int_lt(try(less, strlen(less)), 0);
    char name[64];
    snprintf(name, sizeof name, ".%.*s is missing", (int)key, line);
    ck_assert_msg(strstr(message, name) != NULL, "%s: %s", name, message);
    keys++;
  }
  ck_assert_int_eq(keys, 40);
}

/* Cut anywhere before its last key's value, or no text at all. */
TEST(test_no_plant) {
  read_n();
  size_t whole = (size_t)(strstr(text, "band_high = 0.08") - text) + strlen("band_high = ");
  for (size_t length = 0; length <= whole; length += 7) ck_assert_int_lt(try(text, length), 0);
  ck_assert_int_lt(try("\x7f\x45LF\0\1\2", 7), 0);
  ck_assert_int_eq(ethd_plant_load("apps/config/no-such.plant", &plant, message), ETHD_E_FILE);
  ck_assert_ptr_nonnull(strstr(message, "no-such.plant"));
  ck_assert_int_lt(ethd_plant_load("apps/config", &plant, message), 0);
}
