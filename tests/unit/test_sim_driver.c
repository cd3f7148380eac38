/* The simulated device as a driver: settings, refusals with their line, lock-step. */
#include <stdlib.h>
#include <unistd.h>

#include "ethd/driver.h"
#include "unit/sim_rig.h"

#define FOLDER "apps/config"

static ethd_setup setup;

/* As a caller must: what a failed open leaves is closed. */
static ethd_status open_or_close(const ethd_device_def *def, void **device, char *message) {
  ethd_status status = ethd_driver_sim.open(def, device, message);
  if (status && *device) ethd_driver_sim.close(*device), *device = NULL;
  return status;
}

static ethd_status try(const ethd_setting *settings, uint32_t count, void **device, char *message) {
  setup = ethd_setup_default();
  const ethd_device_def def = {&setup, settings, count, FOLDER, "c.ini", 1, NULL};
  message[0] = 0;
  return open_or_close(&def, device, message);
}

static void *open_with(const ethd_setting *settings, uint32_t count) {
  void *device;
  char message[ETHD_MESSAGE_MAX];
  ck_assert_msg(try(settings, count, &device, message) == ETHD_OK, "%s", message);
  ck_assert_int_eq(ethd_driver_sim.start(device), ETHD_OK);
  return device;
}

static void refused(const char *key, const char *value, ethd_status status, const char *name) {
  const ethd_setting setting = {key, value, 17};
  void *device = &setup;
  char message[ETHD_MESSAGE_MAX];
  ck_assert_int_eq(try(&setting, 1, &device, message), status);
  ck_assert_ptr_null(device);
  ck_assert_msg(status == ETHD_E_FILE || strstr(message, ":17: ") || strstr(message, ":2: "), "%s", message);
  ck_assert_msg(strstr(message, name) != NULL, "%s = %s: %s", key, value, message);
}

TEST(test_table) {
  ck_assert_str_eq(ethd_driver_sim.id, "sim");
  ck_assert_uint_eq(ethd_driver_sim.size, sizeof(ethd_driver));
  ck_assert_uint_eq(ethd_driver_sim.abi, ETHD_DRIVER_ABI);
  ethd_error error;
  ck_assert_int_eq(ethd_params_check_table(ethd_driver_sim.params, ethd_driver_sim.param_count, &error), ETHD_OK);
}

TEST(test_refused) {
  refused("colour", "red", ETHD_E_UNKNOWN, "colour");
  refused("step", "1x", ETHD_E_RANGE, "step");
  refused("step", "0", ETHD_E_RANGE, "step");
  refused("step", "nan", ETHD_E_RANGE, "step");
  refused("seed", "1.5", ETHD_E_RANGE, "seed");
  refused("tap", "-1", ETHD_E_RANGE, "tap");
  refused("speed", "inf", ETHD_E_RANGE, "speed");
  refused("finger", "sound", ETHD_E_UNKNOWN, "finger");
  refused("plant", "x", ETHD_E_FILE, "x.plant");
  refused("plant", "wall.scene", ETHD_E_SYNTAX, "wall.scene:2");
}

/* The same device as the one that is built by hand. */
TEST(test_lock_step) {
  static const ethd_setting settings[] = {
      {"plant", "p", 1}, {"seed", "9", 2}, {"tap", "4", 3}, {"speed", "0.3", 4}, {"finger", "rays", 5}};
  void *device = open_with(settings, 5);
  char message[ETHD_MESSAGE_MAX];
  ethd_sim_def def = sim_def();
  ck_assert_int_eq(ethd_plant_load(FOLDER "/p.plant", &def.plant, message), ETHD_OK);
  def.plant.reading = 1;
  def.step = ethd_driver_sim.params[0].def;
  def.tolerance = ETHD_SIM_GOLDEN;
  ethd_sim_tap tap;
  ethd_sim_draw(&def.plant, 9, 4, 0.3, (ethd_vec){0.25, 0.25}, &tap);
  ethd_sim *sim = sim_open(&def, &tap);
  int rays = 0;
  for (int k = 0; k < 100; k++) {
    ethd_sense s = {0}, expected = sim_sense(sim); /* read adds to what is there */
    ethd_command command = {{-0.02 * (k % 5), 0.01}, 0, 0};
    ck_assert_int_eq(ethd_driver_sim.read(device, 12345, &s), ETHD_OK);
    ck_assert_mem_eq(&s, &expected, sizeof s);
    rays += (s.have & ETHD_HAVE_RAYS) != 0;
    ck_assert_int_eq(ethd_driver_sim.write(device, 12345, &command), ETHD_OK);
    ethd_sim_write(sim, &command);
  }
  ck_assert_int_gt(rays, 20);
  /* from the beginning again */
  ethd_driver_sim.safe(device);
  ck_assert_int_eq(ethd_driver_sim.start(device), ETHD_OK);
  ck_assert_int_eq(ethd_sim_start(sim, &tap), ETHD_OK);
  ethd_sense s = {0}, expected = sim_sense(sim);
  ck_assert_int_eq(ethd_driver_sim.read(device, 0, &s), ETHD_OK);
  ck_assert_mem_eq(&s, &expected, sizeof s);
  ethd_driver_sim.close(device);
  ethd_sim_destroy(sim);
}

/* A loop hangs after it has asked for torque: the time that passes once the device is safe passes without it. */
TEST(test_safe_while_it_catches_up) {
  double moved[2];
  for (int is_safe = 0; is_safe < 2; is_safe++) {
    void *device = open_with(NULL, 0);
    ethd_sense a = {0}, b = {0};
    const ethd_command push = {{1, 0}, 0, 0};
    ck_assert_int_eq(ethd_driver_sim.read(device, 0, &a), ETHD_OK);
    ck_assert_int_eq(ethd_driver_sim.write(device, 0, &push), ETHD_OK);
    if (is_safe) ethd_driver_sim.safe(device);
    ck_assert_int_eq(ethd_driver_sim.read(device, 50000000, &b), ETHD_OK);
    moved[is_safe] = fabs(b.q[0] - a.q[0]);
    ethd_driver_sim.close(device);
  }
  ck_assert_double_gt(moved[0], 0.05);
  ck_assert_double_lt(moved[1], 0.05 * moved[0]); /* the first period's torque was under way */
}

/* Once safe, nothing drives it until it is started anew. */
TEST(test_safe) {
  void *device = open_with(NULL, 0);
  ethd_sense a = {0}, b = {0};
  ethd_command push = {{1, 0}, 0, 0};
  ethd_driver_sim.safe(device);
  ck_assert_int_eq(ethd_driver_sim.read(device, 0, &a), ETHD_OK);
  for (int k = 0; k < 10; k++) ck_assert_int_eq(ethd_driver_sim.write(device, 0, &push), ETHD_OK);
  ck_assert_int_eq(ethd_driver_sim.read(device, 0, &b), ETHD_OK);
  ck_assert(a.q[0] == b.q[0] && a.q[1] == b.q[1]);
  ck_assert_int_eq(ethd_driver_sim.start(device), ETHD_OK);
  for (int k = 0; k < 10; k++) ck_assert_int_eq(ethd_driver_sim.write(device, 0, &push), ETHD_OK);
  ck_assert_int_eq(ethd_driver_sim.read(device, 0, &b), ETHD_OK);
  ck_assert_double_gt(fabs(a.q[0] - b.q[0]), 1e-3);
  ethd_driver_sim.close(device);
}

/* What another driver, or a tick without a step, has put into the sense stays, but for what the sim gives itself. */
TEST(test_adds) {
  void *device = open_with(NULL, 0);
  ethd_sense s = {.have = ETHD_HAVE_DQ | ETHD_HAVE_BODY | ETHD_HAVE_CENTRE | ETHD_HAVE_WORLD,
                  .faults = 2,
                  .grave = 4,
                  .q = {9, 9},
                  .dq = {3, 4},
                  .bodies = {5},
                  .finger_noise = 6};
  ck_assert_int_eq(ethd_driver_sim.read(device, 0, &s), ETHD_OK);
  ck_assert(s.have & ETHD_HAVE_START && s.have & ETHD_HAVE_DQ && s.have & ETHD_HAVE_BODY && s.q[0] < 7);
  ck_assert(s.faults == 2 && s.grave == 4 && s.dq[0] == 3 && s.dq[1] == 4 && s.bodies[0] == 5);
  ck_assert(s.have & ETHD_HAVE_CENTRE && s.have & ETHD_HAVE_WORLD && s.finger_noise == 6);
  ethd_driver_sim.close(device);
}

/* What the motors give: 5.016 N at the shorter link. */
TEST(test_limits) {
  void *device = open_with(NULL, 0);
  ethd_limits limits = ethd_driver_sim.limits(device);
  ck_assert_double_eq_tol(limits.torque, 5.016 * 0.25, 1e-15);
  ck_assert(isinf(limits.torque_rate) && isinf(limits.speed));
  ethd_driver_sim.close(device);
}

/* A plant's letter is a file beside the configuration, else one of ETHD_DATA_DIR; a path is a path. */
TEST(test_where_plants_are) {
  const ethd_setting letter = {"plant", "b", 1}, path = {"plant", "../../" FOLDER "/b.plant", 1};
  setup = ethd_setup_default();
  const ethd_device_def defs[] = {{&setup, &letter, 1, FOLDER, NULL, 1, NULL},
                                  {&setup, &letter, 1, "tests", NULL, 1, NULL},
                                  {&setup, &path, 1, FOLDER, NULL, 1, NULL},
                                  {&setup, &path, 1, "tests", NULL, 1, NULL}};
  ck_assert_int_eq(setenv("ETHD_DATA_DIR", FOLDER, 1), 0);
  for (size_t i = 0; i < 4; i++) {
    void *device;
    char message[ETHD_MESSAGE_MAX];
    ethd_status status = open_or_close(&defs[i], &device, message);
    ck_assert_int_eq(status, i == 3 ? ETHD_E_FILE : ETHD_OK);
    if (status) continue;
    ck_assert_double_eq_tol(ethd_driver_sim.limits(device).torque, 5.369 * 0.25, 1e-15);
    ethd_driver_sim.close(device);
  }
}

/* A wall elsewhere; one that the arm can't reach. */
TEST(test_meet) {
  const ethd_setting near[] = {{"meet_x", "0.1", 1}, {"meet_y", "0.3", 2}, {"tap", "1", 3}};
  void *device = open_with(near, 3);
  ethd_sense s = {0};
  ck_assert_int_eq(ethd_driver_sim.read(device, 0, &s), ETHD_OK);
  ck_assert_double_eq_tol(s.finger[0], 0.1 + 47.67e-3, 10e-3);
  ck_assert_double_eq_tol(s.finger[1], 0.3, 1e-3);
  ethd_driver_sim.close(device);
  const ethd_setting far = {"meet_x", "0.6", 1};
  char message[ETHD_MESSAGE_MAX];
  ck_assert_int_eq(try(&far, 1, &device, message), ETHD_E_UNREACHABLE);
  ck_assert_ptr_null(device);
}
