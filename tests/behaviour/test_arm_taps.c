/* Reaches through an oblique wall to a plate on a simulated UR5e that is commanded by velocity: law `approach`, a headset
   at 72 Hz that is 30 ms late. The plate is to stand at the wall when the finger comes. */
#include <math.h>
#include <string.h>

#include "arm/simulated.h"
#include "tap/placement.h"
#include "unit/arm_tables.h"
#include "unit/draw.h"

#define FINGER 0.008 /* m, radius */
#define WAIT 2.5     /* s, in which the arm goes to the finger's start */
#define AT_WALL 1e-3 /* m: a touch farther before the wall is early */

static const char *const recorded[] = {"avraham_free_mit/avraham_D70_s01_be01_free",
                                       "avraham_free_mit/avraham_ND_s02_be38_free",
                                       "optotrak_reach_mit/tathum_par1_trial031_reach"};
enum {
  BALLISTIC = 2 /* up to 0.86 m/s: it outruns a gap of 60 mm */,
  RECORDED = 3,
  DRAWN = 21,
  TAPS = RECORDED + DRAWN
};

typedef struct tap {
  bool touched, early;
  double offset, speed; /* m behind the wall, m/s along its normal, of the plate at the touch */
} tap;

typedef struct trial {
  ethd__arm_sim sim;
  ethd_space *space;
  ethd_surface wall;
} trial;

/* A reach of minimum jerk that is at 0.4 m/s at the wall, or, when it never is so fast, at its fastest there. */
static ethd_path drawn_reach(uint64_t k) {
  const double before = draw(3 * k, 0.15, 0.3), beyond = draw(3 * k + 1, 0.05, 0.15), whole = before + beyond;
  double low = 0, high = 1; /* the share of the time at which the wall is crossed */
  for (int i = 0; i < 60; i++) {
    const double s = (low + high) / 2;
    if (s * s * s * (10 + s * (6 * s - 15)) < before / whole)
      low = s;
    else
      high = s;
  }
  const double share = 16 * low * low * (1 - low) * (1 - low); /* of the greatest speed */
  return (ethd_path){.from = {before, draw(3 * k + 2, -0.03, 0.03)},
                     .to_x = -beyond,
                     .speed = fmin(1.2, 0.4 / share),
                     .profile = ETHD_PROFILE_MINIMUM_JERK};
}

/* A recorded reach, shifted so that the finger has fallen to 0.4 m/s at the wall. */
static ethd_path recorded_reach(const char *name, ethd__movement *movement) {
  char path[128], message[ETHD_MESSAGE_MAX];
  ethd__touchdown at;
  snprintf(path, sizeof path, "tests/motion/%s.csv", name);
  ck_assert_msg(!ethd__movement_load(path, &ethd__movement_si, movement, message), "%s", message);
  ethd__movement_touchdown(movement, 0.4, &at);
  for (size_t i = 0; i < movement->count; i++) {
    movement->samples[i].x -= at.x.x;
    movement->samples[i].y -= at.x.y;
  }
  return (ethd_path){.samples = movement->samples, .sample_count = movement->count};
}

static ethd_space *controller(const ethd__arm_sim *sim, double gap) {
  ethd_space_setup setup = ethd_space_setup_default();
  setup.effector = ETHD_EFFECTOR_PLATE;
  setup.period = sim->table.limits.period;
  setup.radius = gap + FINGER;
  setup.finger_radius = FINGER;
  setup.speed = 1.5;
  setup.acceleration = 12; /* of 12.9 that the arm's joints allow along the wall's normal */
  ethd_space *space;
  ethd_error error;
  ck_assert_msg(ethd_space_create(&setup, &space, &error) == ETHD_OK, "%s", error.name);
  return space;
}

static void open_trial(trial *t, double delay, double bias, double gap, uint64_t seed) {
  arm_table("ur5e", "", &t->sim.table);
  t->sim.table.servo.delay = delay;
  const ethd_vec3 aslant = {0.9, 0.35, -0.25}, n = ethd_vec3_scale(1 / ethd_vec3_norm(aslant), aslant);
  ethd__arm_sim_start(&t->sim);
  const ethd_vec3 at = ethd_vec3_add(t->sim.motion.tool.x, ethd_vec3_scale(0.12, n));
  t->wall = (ethd_surface){.point = at, .n = n, .id = 1, .material = -1};
  t->sim.finger = ethd__arm_finger_at(ethd_vec3_sub(at, ethd_vec3_scale(FINGER, n)), n);
  t->sim.finger.begin = WAIT;
  t->sim.finger.rate = 72;
  t->sim.finger.latency = 0.03;
  t->sim.finger.noise = 1e-3;
  t->sim.finger.bias = bias;
  t->sim.finger.seed = seed;
  t->space = controller(&t->sim, gap);
}

static void step(trial *t) {
  ethd_space_sense sense = {0};
  ethd_space_command command;
  ethd_surface near = t->wall;
  ethd__arm_sim_read(&t->sim, &sense);
  ethd_ability able = ethd__arm_motion_able(&t->sim.motion, t->wall.n);
  memcpy(sense.ability, &able, sizeof sense.ability);
  sense.have |= ETHD_SPACE_HAVE_ABILITY;
  const ethd_vec3 x = ethd_vec3_of(sense.x);
  near.point = ethd_vec3_add(x, ethd_vec3_scale(ethd_vec3_dot(near.n, ethd_vec3_sub(t->wall.point, x)), near.n));
  ck_assert_int_eq(ethd_space_step(t->space, &sense, &near, 1, &command, NULL), ETHD_OK);
  ck_assert_int_eq(command.safe, 0);
  ethd__arm_sim_write(&t->sim, &command);
}

/* Fills the tap at the first touch. */
static void look(const trial *t, tap *out) {
  ethd__tool plate;
  ethd_vec3 v, finger, finger_v;
  ethd__arm_sim_true(&t->sim, &plate, &v);
  ethd__arm_finger_true(&t->sim.finger, 1e-9 * (double)ethd__arm_sim_time_ns(&t->sim), &finger, &finger_v);
  if (out->touched || 1e-9 * (double)ethd__arm_sim_time_ns(&t->sim) < WAIT ||
      !(ethd_vec3_dot(t->wall.n, ethd_vec3_sub(plate.x, finger)) <= FINGER))
    return;
  out->touched = true;
  out->offset = ethd_vec3_dot(t->wall.n, ethd_vec3_sub(plate.x, t->wall.point));
  out->speed = ethd_vec3_dot(t->wall.n, v);
  out->early = out->offset < -AT_WALL;
}

static tap run(double delay, double bias, uint64_t k) {
  static trial t;
  ethd__movement movement = {0};
  tap out = {0};
  open_trial(&t, delay, bias, k == BALLISTIC ? 0.12 : 0.06, k + 1);
  t.sim.finger.path = k < RECORDED ? recorded_reach(recorded[k], &movement) : drawn_reach(k);
  const double end = WAIT + ethd_path_end(&t.sim.finger.path) + 0.2;
  while (1e-9 * (double)ethd__arm_sim_time_ns(&t.sim) < end) {
    step(&t);
    look(&t, &out);
  }
  ethd_space_destroy(t.space);
  if (k < RECORDED) ethd__movement_free(&movement);
  return out;
}

typedef struct summary {
  double offset, speed; /* mean of those that aren't early, most of all */
  int touched, early;
} summary;

static summary all(double delay, double bias) {
  summary s = {0};
  for (uint64_t k = 0; k < TAPS; k++) {
    const tap one = run(delay, bias, k);
    s.touched += one.touched;
    s.early += one.early;
    if (one.touched && !one.early) s.offset += one.offset;
    s.speed = fmax(s.speed, fabs(one.speed));
  }
  s.offset /= s.touched - s.early;
  printf("delay %2.0f ms, bias %+3.0f mm: felt offset %+.3f mm, worst speed %.4f m/s, early %d of %d\n", 1e3 * delay,
         1e3 * bias, 1e3 * s.offset, s.speed, s.early, s.touched);
  return s;
}

TEST_LOOP(test_goals, 0, 2) {
  const double delay = _i ? 0.03 : 0.008;
  const summary s = all(delay, 0);
  ck_assert_int_eq(s.touched, TAPS);
  ck_assert_double_le(fabs(s.offset), 0.1e-3);
  ck_assert_double_le(s.speed, _i ? 0.10 : 0.05);
  ck_assert_int_le(s.early, TAPS * (_i ? 8 : 5) / 100);
  /* a tracker that sees the hand 13 mm off shortens or lengthens the gap, and no more */
  for (double bias = -13e-3; bias < 0.02; bias += 26e-3) {
    const summary off = all(delay, bias);
    ck_assert_double_le(fabs(off.offset), 0.1e-3);
    ck_assert_int_le(off.early, s.early + 1);
  }
}

/* To the bit, also after another tap. */
TEST(test_repeats) {
  const tap first = run(0.008, 0, 5);
  (void)run(0.03, 0.01, 6);
  const tap second = run(0.008, 0, 5);
  ck_assert(first.touched && first.offset == second.offset && first.speed == second.speed);
}

/* Told to be safe in the middle of a motion, an arm that holds itself stops by its accelerations and one with brakes at
   once; both stay. */
TEST_LOOP(test_safe, 0, 2) {
  static trial t;
  open_trial(&t, 0.008, 0, 0.06, 1);
  t.sim.table.safe = _i ? ETHD__ARM_BRAKES : ETHD__ARM_HOLDS;
  ethd_space_command command = {.value = {0.2, 0.1, -0.1}, .kind = ETHD_SPACE_VELOCITY};
  for (int k = 0; k < 250; k++) ethd__arm_sim_write(&t.sim, &command);
  ethd__tool moving, at, later;
  ethd_vec3 v;
  ethd__arm_sim_true(&t.sim, &moving, &v);
  ck_assert_double_ge(ethd_vec3_norm(v), 0.2);
  command.safe = 1;
  for (int k = 0; k < 250; k++) ethd__arm_sim_write(&t.sim, &command);
  ethd__arm_sim_true(&t.sim, &at, &v);
  ck_assert_double_le(ethd_vec3_norm(v), 1e-12);
  const double way = ethd_vec3_norm(ethd_vec3_sub(at.x, moving.x));
  if (_i)
    ck_assert(way == 0);
  else
    ck_assert_double_le(way, 0.25 * (0.008 + 2 / 150.0 + 0.05));
  for (int k = 0; k < 250; k++) ethd__arm_sim_write(&t.sim, &command);
  ethd__arm_sim_true(&t.sim, &later, &v);
  ck_assert_double_le(ethd_vec3_norm(ethd_vec3_sub(later.x, at.x)), 1e-12);
  ethd_space_destroy(t.space);
}
