/* What a finger at the wall feels when laws or scenes are swapped: nothing that the fade doesn't bring.

   The simulated device (plant n, with its encoders and its sensor's noise) after a tap: the hand goes on pressing. */
#include <math.h>
#include <string.h>

#include "ethd/config.h"
#include "unit/sim_rig.h"

#define PERIOD 1e-3
#define STEADY 600 /* ticks until the press is steady */
#define AFTER 40   /* ticks after a swap that are looked at */
#define PRESSES 5  /* hands */

static const ethd_transition_law *const laws[] = {&ethd_transition_abrupt, &ethd_transition_smooth,
                                                  &ethd_transition_offset, &ethd_transition_predictive};
enum { LAWS = sizeof laws / sizeof *laws };

typedef struct press {
  ethd_config *config;
  ethd_setup setup;
  ethd_sim *sim;
  ethd_control *control;
  ethd_command command;
  ethd_trace trace;
} press;

/* Largest step of the torque, Nm. */
static double tick(press *p) {
  ethd_sense sense = sim_sense(p->sim);
  ethd_command last = p->command;
  ck_assert_int_eq(ethd_control_step(p->control, &sense, &p->command, &p->trace), ETHD_OK);
  ethd_sim_write(p->sim, &p->command);
  return fmax(fabs(p->command.torque[0] - last.torque[0]), fabs(p->command.torque[1] - last.torque[1]));
}

/* Hands differ in their seed and in how hard they press. */
static void begin(press *p, const ethd_transition_law *law, int hand) {
  char message[ETHD_MESSAGE_MAX];
  ethd_sim_def def = sim_def();
  ethd_sim_tap tap = sim_tap();
  memset(p, 0, sizeof *p);
  ck_assert_msg(ethd_plant_load("apps/config/n.plant", &def.plant, message) == ETHD_OK, "%s", message);
  ck_assert_msg(ethd_config_load("apps/config/n.ini", &p->config, message) == ETHD_OK, "%s", message);
  tap.seed = (uint64_t)hand;
  tap.path.to_x = 0.235 - 0.004 * hand;
  p->setup = p->config->setup;
  ethd_setup_transition(&p->setup, law);
  p->setup.limits.torque = def.plant.force_limit * 0.25;
  p->setup.dynamics = ethd_plant_dynamics(&def.plant);
  p->sim = sim_open(&def, &tap);
  ck_assert_int_eq(ethd_control_create(&p->setup, &p->control, NULL), ETHD_OK);
  for (int i = 0; i < STEADY; i++) tick(p);
}

static void post(press *p) { ck_assert_int_eq(ethd_control_post(p->control, &p->setup, NULL), ETHD_OK); }

static void end(press *p) {
  ethd_control_destroy(p->control);
  ethd_sim_destroy(p->sim);
  ethd_config_free(p->config);
}

static double largest_step(press *p) {
  double most = 0;
  for (int i = 0; i < AFTER; i++) most = fmax(most, tick(p));
  return most;
}

/* What would step if nothing faded: the old law's torque less the new one's, Nm. */
static double difference(const ethd_transition_law *from, const ethd_transition_law *to, int hand) {
  press p;
  begin(&p, from, hand);
  ethd_setup_transition(&p.setup, to);
  p.setup.swap_time = 0;
  post(&p);
  tick(&p);
  double step = tick(&p);
  end(&p);
  return step;
}

/* A press on noisy encoders steps without a swap, too. The most that the old law does within 0.4 s, or the fade's own
   slope, is what a swap may do. */
TEST_LOOP(test_laws_in_steady_press, 0, LAWS *LAWS) {
  const ethd_transition_law *from = laws[_i / LAWS], *to = laws[_i % LAWS];
  double without = 0, with = 0, slope = 0;
  for (int hand = 1; hand <= PRESSES; hand++) {
    press p;
    begin(&p, from, hand);
    ck_assert_int_eq(p.trace.state, ETHD_VO);
    for (int i = 0; i < 400 / AFTER; i++) without = fmax(without, largest_step(&p));
    end(&p);
    begin(&p, from, hand);
    ethd_setup_transition(&p.setup, to);
    post(&p);
    with = fmax(with, largest_step(&p));
    slope = fmax(slope, difference(from, to, hand) * PERIOD / p.setup.swap_time);
    ck_assert_int_eq(p.trace.state, ETHD_VO);
    end(&p);
  }
  double most = 1.1 * fmax(without, slope) + 1e-9;
  ck_assert_msg(with <= most, "%s -> %s: %.4f Nm a tick; %.4f without, fade %.4f", from->law.id, to->law.id, with,
                without, slope);
}

/* Equal text, another number of the object, other company: the wall under the finger is the same to the bit. */
TEST_LOOP(test_equal_scene, 0, LAWS * 2) {
  static const char *const scenes[] = {RIG_WALL, "circle 0.6 0.6 0.05\n" RIG_WALL};
  press kept, swapped;
  begin(&kept, laws[_i / 2], 1);
  begin(&swapped, laws[_i / 2], 1);
  ethd_scene *scene = rig_scene(scenes[_i % 2]);
  swapped.setup.scene = scene;
  post(&swapped);
  double eps = swapped.trace.eps;
  for (int i = 0; i < AFTER; i++) {
    tick(&kept);
    tick(&swapped);
    ck_assert(swapped.trace.swap == (i == 0) && swapped.trace.eps == eps && swapped.trace.contacts == 1);
    ck_assert_int_eq(swapped.trace.object, _i % 2);
    ck_assert(memcmp(kept.trace.x, swapped.trace.x, sizeof kept.trace.x) == 0);
    ck_assert(memcmp(kept.command.torque, swapped.command.torque, sizeof kept.command.torque) == 0);
  }
  end(&kept);
  end(&swapped);
  ethd_scene_destroy(scene);
}

/* A wall that stands elsewhere, or faces another way, is another one: what was at the old one ends there. */
TEST_LOOP(test_other_scene, 0, 2) {
  static const char *const scenes[] = {"halfplane -1 0 -0.2381\n", "halfplane -1 0.001 -0.23775\n"};
  press p;
  begin(&p, &ethd_transition_offset, 1);
  ck_assert(p.trace.eps > 1e-4);
  ethd_scene *scene = rig_scene(scenes[_i]);
  p.setup.scene = scene;
  post(&p);
  tick(&p);
  ck_assert(p.trace.state == ETHD_BRAKING && p.trace.eps == 0);
  end(&p);
  ethd_scene_destroy(scene);
}
