/* A simulated device in a test: plant n without noise, a tap along -x at 0.4 m/s. */
#ifndef ETHD_TESTS_SIM_RIG_H
#define ETHD_TESTS_SIM_RIG_H

#include <math.h>
#include <string.h>

#include "ethd/sim.h"
#include "unit/rig.h"

static inline ethd_sim_def sim_def(void) {
  ethd_sim_def def = {
      .arm = {ETHD_ARM_PARALLEL, 0.25, 0.25}, .ring_radius = 0.012, .period = 1e-3, .step = 50e-6, .tolerance = 1e-10};
  char message[ETHD_MESSAGE_MAX];
  ck_assert_msg(ethd_plant_load("apps/config/n.plant", &def.plant, message) == ETHD_OK, "%s", message);
  def.plant.noise = 0;
  def.plant.count = 0;
  return def;
}

/* A ring that practically stands still. */
static inline void sim_hold(ethd_sim_def *def) {
  def->plant.mass[0] = def->plant.mass[1] = 1000;
  def->plant.friction = 1000;
}

static inline ethd_sim_tap sim_tap(void) {
  ethd_sim_tap tap = {.seed = 3, .tap = 5, .finger_radius = 0.0073, .phase = 0.7e-3, .commanded = 0.4};
  tap.path = (ethd_path){{0.29, 0.25}, 0.19, 0.4, 0.08, 0.03, ETHD_PROFILE_CONSTANT, NULL, 0};
  return tap;
}

static inline ethd_sim *sim_open(const ethd_sim_def *def, const ethd_sim_tap *tap) {
  ethd_sim *sim;
  ethd_error error;
  ck_assert_int_eq(ethd_sim_create(def, &sim, &error), ETHD_OK);
  ck_assert_int_eq(ethd_sim_start(sim, tap), ETHD_OK);
  return sim;
}

/* One tick under these torques. */
static inline void sim_push(ethd_sim *sim, double torque1, double torque2) {
  ethd_command command = {{torque1, torque2}, 0, 0};
  ethd_sim_write(sim, &command);
}

static inline ethd_truth sim_truth(const ethd_sim *sim) {
  ethd_truth truth;
  ethd_sim_truth(sim, &truth);
  return truth;
}

static inline ethd_sense sim_sense(ethd_sim *sim) {
  ethd_sense sense;
  ethd_sim_read(sim, &sense);
  return sense;
}

#endif
