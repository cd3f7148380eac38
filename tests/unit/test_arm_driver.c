/* Driver `arm`: opened as a device in space and driven by the loop, it is the simulated arm to the bit, also when it is
   opened again; a reach through an oblique wall is felt where the wall is; what doesn't fit is refused. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "arm/simulated.h"
#include "device/device.h"
#include "ethd/conform.h"
#include "ethd/loop.h"
#include "unit/arm_tables.h"

#define PERIOD 2000000 /* ns */
#define FINGER 0.008   /* m */
#define TICKS 2000

static ethd_setting settings[16];
static char values[16][40], message[ETHD_MESSAGE_MAX];
static ethd_surface wall;
static ethd_space_setup setup;
static ethd_device_def def;

static void set(const char *key, const char *value) { settings[def.setting_count++] = (ethd_setting){key, value, 7}; }

static void set_number(const char *key, double value) {
  snprintf(values[def.setting_count], sizeof *values, "%.17g", value);
  set(key, values[def.setting_count]);
}

/* An oblique wall 120 mm behind the plate of a UR5e at its posture, and a reach through it. */
static void describe(const char *table) {
  static ethd__arm_table t;
  static ethd__arm_motion m;
  const ethd_vec3 aslant = {0.9, 0.35, -0.25}, n = ethd_vec3_scale(1 / ethd_vec3_norm(aslant), aslant);
  arm_table("ur5e", "", &t);
  ethd__arm_motion_start(&t, NULL, &m);
  const ethd_vec3 at = ethd_vec3_add(m.tool.x, ethd_vec3_scale(0.12, n));
  const ethd_vec3 meet = ethd_vec3_sub(at, ethd_vec3_scale(FINGER, n));
  wall = (ethd_surface){.point = at, .n = n, .id = 1, .material = -1};
  setup = ethd_space_setup_default();
  setup.effector = ETHD_EFFECTOR_PLATE;
  setup.period = 1e-9 * PERIOD;
  setup.radius = 0.068;
  setup.finger_radius = FINGER;
  setup.acceleration = 12;
  def = (ethd_device_def){
      .space = &setup, .settings = settings, .folder = "apps/config", .file = "t.ini", .is_virtual = 1};
  if (table) set("table", table);
  set("hand", "reach");
  set_number("hand_x", meet.x);
  set_number("hand_y", meet.y);
  set_number("hand_z", meet.z);
  set_number("hand_nx", n.x);
  set_number("hand_ny", n.y);
  set_number("hand_nz", n.z);
}

static ethd_surface nearest(ethd_vec3 x) {
  ethd_surface near = wall;
  near.point = ethd_vec3_add(x, ethd_vec3_scale(ethd_vec3_dot(wall.n, ethd_vec3_sub(wall.point, x)), wall.n));
  return near;
}

static uint32_t near_wall(void *of, const ethd_space_sense *sense, ethd_surface out[ETHD_SURFACES_MAX]) ETHD_RT {
  (void)of;
  out[0] = nearest(ethd_vec3_of(sense->x));
  return 1;
}

typedef struct felt {
  double offset, speed; /* m behind the wall, m/s of the plate at the touch */
  double sum;           /* of all places that were commanded, m */
} felt;

/* Runs the loop over the whole reach. */
static felt run(void) {
  ethd_device *device;
  ethd_space *space;
  ethd_loop *loop;
  ethd_space_row row;
  int64_t clock = -PERIOD;
  felt f = {.offset = NAN};
  ck_assert_msg(ethd_device_open("arm", NULL, &def, &device, message) == ETHD_OK, "%s", message);
  ck_assert_int_eq(ethd_space_create(&setup, &space, NULL), ETHD_OK);
  ethd_loop_def loop_def = ethd_loop_default();
  loop_def.device = device;
  loop_def.space = space;
  loop_def.period = setup.period;
  loop_def.clock = &clock;
  loop_def.soft_start = 0;
  loop_def.surfaces = near_wall;
  ck_assert_int_eq(ethd_loop_create(&loop_def, &loop, NULL), ETHD_OK);
  ck_assert_int_eq(ethd_loop_start(loop, NULL), ETHD_OK);
  const ethd__arm_sim *sim = device->at[0].state;
  for (int i = 0; i < TICKS; i++) {
    ethd__tool plate;
    ethd_vec3 v, finger, finger_v;
    ethd_loop_tick(loop);
    ck_assert_int_eq(ethd_loop_take_space(loop, &row), ETHD_OK);
    ck_assert(row.trace.fault == 0 && row.armed == 1);
    f.sum += row.trace.sense.x[0] + row.trace.sense.x[1] + row.trace.sense.x[2];
    ck_assert(i == 0 || !memcmp(row.trace.sense.v, row.trace.sense.commanded, sizeof row.trace.sense.v));
    ethd__arm_sim_true(sim, &plate, &v);
    ethd__arm_finger_true(&sim->finger, 1e-9 * (double)ethd__arm_sim_time_ns(sim), &finger, &finger_v);
    if (!isnan(f.offset) || 1e-9 * (double)clock < 2.5) continue;
    if (ethd_vec3_dot(wall.n, ethd_vec3_sub(plate.x, finger)) > FINGER) continue;
    f.offset = ethd_vec3_dot(wall.n, ethd_vec3_sub(plate.x, wall.point));
    f.speed = fabs(ethd_vec3_dot(wall.n, v));
  }
  ethd_figure figures[3];
  ck_assert_uint_eq(ethd_device_figures(device, figures, 3), 3);
  ck_assert(figures[0].value >= 0 && figures[0].value < TICKS / 10 && figures[1].value > 0.1);
  ck_assert_double_eq_tol(figures[2].value, 0.008 + 2 / 150.0, 1e-15);
  ethd_loop_destroy(loop);
  ethd_space_destroy(space);
  ethd_device_close(device);
  return f;
}

TEST(test_reach) {
  describe("ur5e.arm");
  const felt first = run(), second = run();
  printf("felt offset %.4f mm, %.4f m/s\n", 1e3 * first.offset, first.speed);
  ck_assert(first.offset == second.offset && first.speed == second.speed && first.sum == second.sum);
  ck_assert_double_le(fabs(first.offset), 0.1e-3);
  ck_assert_double_le(first.speed, 0.05);
}

/* The loop's ticks are those of the simulated arm and the controller by themselves. */
TEST(test_as_by_hand) {
  static ethd__arm_sim sim;
  ethd_device *device;
  ethd_space *space;
  describe("ur5e.arm");
  ck_assert_msg(ethd_device_open("arm", NULL, &def, &device, message) == ETHD_OK, "%s", message);
  ck_assert(ethd_device_safe_is(device) == ETHD_SAFE_NO_SPEED);
  sim.table = ((const ethd__arm_sim *)device->at[0].state)->table;
  sim.finger = ((const ethd__arm_sim *)device->at[0].state)->finger;
  ethd_device_close(device);
  ethd__arm_sim_start(&sim);
  ck_assert_int_eq(ethd_space_create(&setup, &space, NULL), ETHD_OK);
  double sum = 0;
  for (int i = 0; i < TICKS; i++) {
    ethd_space_sense sense = {0};
    ethd_space_command command;
    ethd__arm_sim_read(&sim, &sense);
    if (i) {
      sense.have |= ETHD_SPACE_HAVE_COMMANDED;
      ethd_vec3_put(sim.motion.v, sense.commanded);
    }
    ethd_ability able = ethd__arm_motion_able(&sim.motion, wall.n);
    able.delay = 0;
    memcpy(sense.ability, &able, sizeof sense.ability);
    sense.have |= ETHD_SPACE_HAVE_ABILITY;
    const ethd_surface near = nearest(ethd_vec3_of(sense.x));
    sum += sense.x[0] + sense.x[1] + sense.x[2];
    ck_assert_int_eq(ethd_space_step(space, &sense, &near, 1, &command, NULL), ETHD_OK);
    ethd__arm_sim_write(&sim, &command);
  }
  ethd_space_destroy(space);
  ck_assert(sum == run().sum);
}

static void refused(const char *why) {
  ethd_device *device;
  ck_assert_int_lt(ethd_device_open("arm", NULL, &def, &device, message), 0);
  ck_assert_ptr_null(device);
  ck_assert_msg(strstr(message, why) != NULL, "%s", message);
}

TEST(test_refused) {
  describe(NULL);
  refused("t.ini: device arm.table is missing");
  describe("no-such.arm");
  refused("apps/config/no-such.arm");
  describe("fr3.arm");
  refused("found a period of 0.002 s, the arm's table allows 0.001 s (1000 Hz)");
  describe("ur5e.arm");
  setup.kind = ETHD_SPACE_FORCE;
  refused("found a controller of forces, driver arm takes velocities");
  describe("ur5e.arm");
  for (uint32_t i = 5; i < 8; i++) settings[i].value = "0";
  refused("found 0, a direction is allowed");
}

/* The questions of ethd-conform: the arm keeps what a device in space promises. */
TEST(test_conforms) {
  describe("ur5e.arm");
  def.setting_count = 1;
  setup.speed = 0.5;
  ethd_conform_answer answers[ETHD_SPACE_QUESTIONS];
  const ethd_conform_def conform = {"arm", NULL, &def, 0.1, NULL};
  const ethd_status status = ethd_conform_space(&conform, answers);
  for (int i = 0; i < ETHD_SPACE_QUESTIONS; i++)
    ck_assert_msg(answers[i].verdict == ETHD_VERDICT_KEPT, "%s: %s", answers[i].question, answers[i].found);
  ck_assert_int_eq(status, ETHD_OK);
}
