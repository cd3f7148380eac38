/* The law that brakes before the wall where things aren't as it hopes, in the controller, on the simulated device: the
   torque stays within its limit, no law fails, and a finger that presses isn't let through. */
#include <stdbool.h>

#include "unit/sim_rig.h"

#define TICKS 600
#define LIMIT 1.3 /* Nm */

static const ethd_transition_law *const laws[] = {&ethd_transition_offset, &ethd_transition_predictive,
                                                  &ethd_transition_smooth, &ethd_transition_predictive,
                                                  &ethd_transition_abrupt, &ethd_transition_predictive};

typedef struct odd_run {
  ethd_setup setup;
  ethd_sim *sim;
  ethd_control *control;
  ethd_scene *scene, *body;
  ethd_trace trace;
  ethd_command command;
  int pressed; /* ticks with the finger pressed against a wall */
} odd_run;

static void begin(odd_run *r, const char *scene, bool has_facts, double finger_to_x) {
  ethd_sim_def def = sim_def();
  ethd_sim_tap tap = sim_tap();
  tap.path.to_x = finger_to_x;
  memset(r, 0, sizeof *r);
  r->sim = sim_open(&def, &tap);
  r->setup = ethd_setup_default();
  r->scene = scene ? rig_scene(scene) : NULL;
  r->body = rig_scene("circle 0 0 0.02\n");
  r->setup.scene = r->scene;
  ethd_setup_transition(&r->setup, &ethd_transition_predictive);
  r->setup.limits.torque = LIMIT;
  if (has_facts) r->setup.dynamics = ethd_plant_dynamics(&def.plant);
}

static void start(odd_run *r) { ck_assert_int_eq(ethd_control_create(&r->setup, &r->control, NULL), ETHD_OK); }

static void step(odd_run *r, const ethd_sense *sense, int tick) {
  ethd_event event;
  ck_assert_int_eq(ethd_control_step(r->control, sense, &r->command, &r->trace), ETHD_OK);
  ck_assert(fabs(r->command.torque[0]) <= LIMIT && fabs(r->command.torque[1]) <= LIMIT); /* fails on NaN */
  while (ethd_control_poll(r->control, &event) == ETHD_OK)
    ck_assert_msg(event.kind != ETHD_EVENT_FAULT || event.code == ETHD_FAULT_TORQUE, "fault %d at tick %d", event.code,
                  tick);
  ethd_sim_write(r->sim, &r->command);
}

static void end(odd_run *r) {
  ethd_control_destroy(r->control);
  ethd_scene_destroy(r->scene);
  ethd_scene_destroy(r->body);
  ethd_sim_destroy(r->sim);
}

/* Once a finger presses into a wall that stands, the wall stays until the finger goes. */
static void check_release(odd_run *r, int32_t before, int tick) {
  if (before != ETHD_VO || !(sim_truth(r->sim).pad > 0)) return;
  r->pressed++;
  ck_assert_msg(r->trace.state == ETHD_VO, "let through at tick %d", tick);
}

typedef struct odd_case {
  const char *scene;
  bool has_facts, sees;
  enum { NEVER, SCENE, LAW } swaps;
  int bodies;
} odd_case;

static const odd_case cases[] = {
    {RIG_WALL, true, true, NEVER, 0},                            /* as it should be */
    {RIG_WALL, false, true, NEVER, 0},                           /* the device says nothing */
    {RIG_WALL, true, false, NEVER, 0},                           /* a finger that is never seen */
    {NULL, true, true, SCENE, 0},                                /* a wall appears inside the ring, and goes */
    {RIG_WALL "halfplane 0 -1 -0.2385\n", true, true, NEVER, 0}, /* a corner */
    {RIG_WALL "halfplane 0 1 0.262\n", true, true, LAW, 0},      /* a narrow channel */
    {"segment 0.238 0.1 0.238 0.4\n", true, true, LAW, 0},       /* a thin wall */
    {"# nothing\n", true, true, NEVER, 1},                       /* a body that comes to meet the ring */
    {"# nothing\n", true, true, NEVER, 2},                       /* and one from the other side */
    {RIG_WALL, true, true, LAW, 2},                              /* all at once */
};

static void move_bodies(ethd_sense *sense, int count, int tick) {
  static const double from[2] = {0.19, 0.33}, speed[2] = {0.2, -0.15};
  for (int i = 0; i < count; i++) {
    double *pose = sense->bodies + (ptrdiff_t)6 * i;
    sense->have |= (int64_t)ETHD_HAVE_BODY << i;
    pose[0] = from[i] + 1e-3 * speed[i] * tick;
    pose[1] = 0.25;
    pose[3] = speed[i];
  }
}

TEST_LOOP(test_odd, 0, sizeof cases / sizeof *cases) {
  const odd_case *c = &cases[_i];
  odd_run r;
  ethd_scene *wall = rig_scene(RIG_WALL), *other = rig_scene("circle 0 0 0.015\n");
  begin(&r, c->scene, c->has_facts, sim_tap().path.to_x);
  if (c->bodies > 0) r.setup.bodies[0] = r.body;
  if (c->bodies > 1) r.setup.bodies[1] = other;
  start(&r);
  for (int i = 0; i < TICKS; i++) {
    ethd_sense sense = sim_sense(r.sim);
    int32_t before = r.trace.state;
    if (!c->sees) sense.have &= ~(int64_t)(ETHD_HAVE_START | ETHD_HAVE_CENTRE);
    move_bodies(&sense, c->bodies, i);
    if (c->swaps != NEVER && i % 7 == 0) {
      if (c->swaps == SCENE) r.setup.scene = i % 14 ? wall : NULL;
      if (c->swaps == LAW) ethd_setup_transition(&r.setup, laws[i / 7 % 6]);
      (void)!ethd_control_post(r.control, &r.setup, NULL);
    }
    step(&r, &sense, i);
    if (c->swaps == NEVER && c->bodies == 0) check_release(&r, before, i);
  }
  ck_assert(_i != 0 || r.pressed > 100);
  end(&r);
  ethd_scene_destroy(wall);
  ethd_scene_destroy(other);
}

/* Out of the law and back again at every third tick of a tap, so that all of its states are met. */
TEST_LOOP(test_swap_in_every_state, 0, 3) {
  int met[3] = {0, 0, 0};
  for (int at = 90; at < 300; at += 3) {
    odd_run r;
    begin(&r, RIG_WALL, true, sim_tap().path.to_x);
    start(&r);
    for (int i = 0; i < at + 60; i++) {
      ethd_sense sense = sim_sense(r.sim);
      if (i == at) met[r.trace.state]++;
      if (i == at || i == at + 5) {
        ethd_setup_transition(&r.setup, i == at ? laws[2 * _i] : &ethd_transition_predictive);
        ck_assert_int_eq(ethd_control_post(r.control, &r.setup, NULL), ETHD_OK);
      }
      step(&r, &sense, i);
    }
    end(&r);
  }
  ck_assert_msg(met[0] > 0 && met[1] > 0 && met[2] > 0, "states met: %d %d %d", met[0], met[1], met[2]);
}

/* The hand stops short of the wall: the ring doesn't brake for ever, and follows it again. */
TEST_LOOP(test_finger_never_comes, 0, 8) {
  odd_run r;
  begin(&r, RIG_WALL, true, 0.2465 + 0.001 * _i);
  start(&r);
  int braked = 0, tick = 0;
  for (; tick < 1200; tick++) {
    ethd_sense sense = sim_sense(r.sim);
    step(&r, &sense, tick);
    braked += r.trace.state == ETHD_BRAKING;
  }
  ck_assert_msg(braked <= 2 * 50, "brakes for %d ticks", braked); /* t_max, at most twice: it meets the curve anew */
  ck_assert(r.trace.state != ETHD_BRAKING);
  double lag = fabs(sim_truth(r.sim).ring[0] - sim_truth(r.sim).finger[0]);
  ck_assert_msg(lag < 0.012 - 0.0073 + 1e-4, "%g m from the finger", lag);
  end(&r);
}

/* What is out of a parameter's range is refused, by its name. */
TEST(test_parameters) {
  const ethd_law *law = &ethd_transition_predictive.law;
  for (uint32_t i = 0; i < law->param_count; i++) {
    const ethd_param *row = &law->params[i];
    const double values[] = {row->min - 1, row->max * 2 + 1, (double)NAN, -(double)INFINITY};
    for (int k = 0; k < 4; k++) {
      ethd_setup setup = ethd_setup_default();
      ethd_control *control = NULL;
      ethd_error error = {0};
      if (k == 1 && isinf(row->max)) continue;
      ethd_setup_transition(&setup, &ethd_transition_predictive);
      setup.transition_p[i] = values[k];
      ck_assert_msg(ethd_control_create(&setup, &control, &error) < 0, "%s = %g is taken", row->name, values[k]);
      ck_assert_msg(strstr(error.name, row->name) != NULL, "%s, not %s", error.name, row->name);
    }
  }
}
