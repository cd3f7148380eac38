/* The closed loop as programs run it against steps and a tolerance far below: on every tap whose counts and
   states agree the traces are within 1e-8 m. Says how many agree. */
#include <stdio.h>
#include <stdlib.h>

#include "unit/sim_rig.h"

enum { TICKS = 700, TAPS = 4 };

typedef struct loop {
  ethd_config *config;
  ethd_control *control;
  ethd_sim *sim;
  ethd_trace trace[TICKS];
  ethd_truth truth[TICKS];
} loop;

static loop coarse, fine;
static ethd_plant plant;

static void open_loop(const char *letter, const char *law, double step, double tolerance, loop *out) {
  char path[64], message[ETHD_MESSAGE_MAX];
  ethd_setup setup;
  ethd_error error;
  snprintf(path, sizeof path, "apps/config/%s.plant", letter);
  ck_assert_msg(ethd_plant_load(path, &plant, message) == ETHD_OK, "%s", message);
  snprintf(path, sizeof path, "apps/config/%s.ini", letter);
  ck_assert_msg(ethd_config_load(path, &out->config, message) == ETHD_OK, "%s", message);
  setup = out->config->setup;
  ck_assert_int_eq(ethd_config_transition(out->config, law, &setup, message), ETHD_OK);
  const ethd_sim_def def = {plant, setup.arm, setup.ring_radius, setup.period, step, tolerance};
  ck_assert_int_eq(ethd_sim_create(&def, &out->sim, &error), ETHD_OK);
  ck_assert_int_eq(ethd_control_create(&setup, &out->control, &error), ETHD_OK);
}

static void close_loop(loop *l) {
  ethd_control_destroy(l->control);
  ethd_sim_destroy(l->sim);
  ethd_config_free(l->config);
}

static int run(loop *l, const ethd_sim_tap *tap) {
  int ticks = (int)fmin(TICKS, 1000 * (ethd_path_end(&tap->path) + 0.1));
  ck_assert_int_eq(ethd_sim_start(l->sim, tap), ETHD_OK);
  ethd_control_reset(l->control);
  for (int k = 0; k < ticks; k++) {
    ethd_sense sense = sim_sense(l->sim);
    ethd_command command;
    l->truth[k] = sim_truth(l->sim);
    ck_assert_int_eq(ethd_control_step(l->control, &sense, &command, &l->trace[k]), ETHD_OK);
    ethd_sim_write(l->sim, &command);
  }
  return ticks;
}

/* The largest difference of ring or finger; NaN: counts or states differ. */
static double difference(int ticks) {
  double most = 0;
  for (int k = 0; k < ticks; k++) {
    const ethd_truth *a = &coarse.truth[k], *b = &fine.truth[k];
    if (memcmp(coarse.trace[k].sense.q, fine.trace[k].sense.q, sizeof fine.trace[k].sense.q) != 0) return NAN;
    if (coarse.trace[k].state != fine.trace[k].state) return NAN;
    most = fmax(most, hypot(a->ring[0] - b->ring[0], a->ring[1] - b->ring[1]));
    most = fmax(most, hypot(a->finger[0] - b->finger[0], a->finger[1] - b->finger[1]));
  }
  return most;
}

TEST_LOOP(test_error, 0, 12) {
  static const char *const letters[] = {"q", "n", "b", "p"}, *const laws[] = {"abrupt", "smooth", "offset"};
  const char *letter = letters[_i % 4], *law = laws[_i / 4];
  double most = 0;
  int agree = 0;
  open_loop(letter, law, 1e-3, ETHD_SIM_GOLDEN, &coarse);
  open_loop(letter, law, 5e-6, 1e-13, &fine);
  for (uint64_t tap = 0; tap < TAPS; tap++) {
    ethd_sim_tap t;
    ethd_sim_draw(&plant, 1, tap, tap % 2 ? plant.speed_high : plant.speed_low, (ethd_vec){0.25, 0.25}, &t);
    run(&fine, &t);
    double error = difference(run(&coarse, &t));
    if (isnan(error)) continue;
    agree++;
    most = fmax(most, error);
  }
  printf("plant %s, %s: %d of %d taps agree, largest difference %.2g m\n", letter, law, agree, TAPS, most);
  ck_assert_double_le(most, 1e-8);
  ck_assert_int_ge(agree, TAPS - 1);
  close_loop(&coarse);
  close_loop(&fine);
}
