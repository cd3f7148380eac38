/* The simulated device from outside: start, motors and their delay, the finger on its path, equal bytes. */
#include <stdlib.h>

#include "unit/draw.h"
#include "unit/sim_rig.h"

#define PI 3.14159265358979323846

TEST(test_start) {
  ethd_sim_def def = sim_def();
  ethd_sim_tap tap = sim_tap();
  ethd_sim *sim = sim_open(&def, &tap);
  ethd_truth t = sim_truth(sim);
  ck_assert(t.t == 0 && t.ring_v[0] == 0 && t.ring_v[1] == 0 && t.finger_v[0] == 0 && t.finger_v[1] == 0);
  ck_assert_double_eq_tol(t.ring[0], 0.29, 1e-15);
  ck_assert_double_eq_tol(t.ring[1], 0.25, 1e-15);
  ck_assert_double_eq_tol(t.finger[0], t.ring[0], 1e-15);
  ck_assert_double_eq_tol(t.pad, -(0.012 - 0.0073), 1e-15);
  ethd_sense s = sim_sense(sim);
  ck_assert_int_eq(s.have, ETHD_HAVE_START);
  ck_assert(s.time_ns == 0 && s.finger[0] == t.finger[0] && s.finger[1] == t.finger[1]);
  ck_assert_double_eq_tol(0.25 * (cos(s.q[0]) + cos(s.q[1])), 0.29, 1e-15);
  ck_assert_double_lt(s.q[1], s.q[0]); /* link 2 is turned clockwise */
  for (int i = 1; i < 4; i++) {
    sim_push(sim, 0, 0);
    s = sim_sense(sim);
    ck_assert_int_eq(s.have & ETHD_HAVE_START, 0);
    ck_assert_int_eq(s.time_ns, 1000000 * i);
  }
  ethd_sim_destroy(sim);
  ethd_sim_destroy(NULL);
}

/* Ticks of a period that isn't a round number of nanoseconds are each rounded, not added up. */
TEST(test_time) {
  ethd_sim_def def = sim_def();
  ethd_sim_tap tap = sim_tap();
  def.period = 1.0 / 3000;
  def.step = def.period;
  ethd_sim *sim = sim_open(&def, &tap);
  for (int k = 0; k < 1500; k++) {
    ck_assert_int_eq(sim_sense(sim).time_ns, (int64_t)floor(k * 1e9 / 3000 + 0.5));
    sim_push(sim, 0, 0);
  }
  ck_assert_double_eq_tol(sim_truth(sim).t, 0.5, 1e-15);
  ethd_sim_destroy(sim);
}

/* ---- motors ---- */

/* Without friction th = alpha (t - delay)^2 / 2 from the first tick on; too much torque is cut at F L. */
TEST_LOOP(test_saturation_and_delay, 0, 9) {
  static const double delays[] = {0, 71e-6, 273e-6, 0.9e-3, 1e-3, 1.3e-3, 2e-3, 7.6e-3, 8e-3};
  ethd_sim_def def = sim_def();
  ethd_sim_tap tap = sim_tap();
  def.plant.friction = def.plant.viscous = 0;
  def.plant.delay = delays[_i];
  tap.path = (ethd_path){{0.25, 0.25}, 0.2, 1e-9, 0, 0, ETHD_PROFILE_CONSTANT, NULL, 0};
  ethd_sim *sim = sim_open(&def, &tap);
  double q0[2] = {PI / 2, 0}, l = 0.25;
  for (int k = 0; k < 15; k++) {
    ethd_sense s = sim_sense(sim);
    double t = fmax(0, 1e-3 * k - delays[_i]);
    double a1 = 5.357 * l / (0.1173 * l * l), a2 = -0.1 / (0.25 * l * l);
    ck_assert_double_eq_tol(s.q[0] - q0[0], a1 * t * t / 2, 1e-13);
    ck_assert_double_eq_tol(s.q[1] - q0[1], a2 * t * t / 2, 1e-13);
    sim_push(sim, k & 1 ? 7 : INFINITY, -0.1);
  }
  ethd_sim_destroy(sim);
}

/* Safe commands and torques that are no numbers drive nothing. */
TEST(test_safe) {
  ethd_sim_def def = sim_def();
  ethd_sim_tap tap = sim_tap();
  ethd_sim *sim = sim_open(&def, &tap);
  ethd_command safe = {{1, 1}, 1, 0}, no_number = {{NAN, -NAN}, 0, 0};
  ethd_sense sense = sim_sense(sim);
  const double *q = sense.q;
  for (int k = 0; k < 20; k++) {
    ethd_sim_write(sim, k & 1 ? &safe : &no_number);
    ck_assert(sim_sense(sim).q[0] == q[0] && sim_sense(sim).q[1] == q[1]);
  }
  ethd_sim_destroy(sim);
}

/* ---- finger ---- */

/* Torque that carries the ring along with the hand: a stiff tracking of the true finger. */
static void follow(ethd_sim *sim) {
  ethd_truth t = sim_truth(sim);
  double ex = t.finger[0] - t.ring[0], ey = t.finger[1] - t.ring[1];
  double fx = 640 * ex + 30 * (t.finger_v[0] - t.ring_v[0]), fy = 640 * ey + 30 * (t.finger_v[1] - t.ring_v[1]);
  ethd_sense sense = sim_sense(sim);
  const double *q = sense.q;
  sim_push(sim, 0.25 * (cos(q[0]) * fy - sin(q[0]) * fx), 0.25 * (cos(q[1]) * fy - sin(q[1]) * fx));
}

/* Left alone the finger is on its path: the synthetic ones, and a recorded one that shakes. */
TEST_LOOP(test_free_finger, 0, 3) {
  enum { COUNT = 300 };
  ethd_path_sample samples[COUNT];
  ethd_sim_def def = sim_def();
  ethd_sim_tap tap = sim_tap();
  if (_i == 2) tap.path.profile = ETHD_PROFILE_MINIMUM_JERK;
  if (_i == 1) {
    for (int i = 0; i < COUNT; i++) {
      double t = 0.00147 * i;
      samples[i] = (ethd_path_sample){t, 0.29 - 0.1 * t + draw((uint64_t)i, -1e-5, 1e-5), 0.25 + 0.01 * sin(9 * t)};
    }
    tap.path = (ethd_path){.samples = samples, .sample_count = COUNT};
  }
  ethd_sim *sim = sim_open(&def, &tap);
  for (int k = 0; k < 400; k++) {
    ethd_truth t = sim_truth(sim);
    ethd_vec x, v;
    ethd_path_at(&tap.path, t.t, &x, &v);
    ck_assert_double_eq_tol(t.hand[0], x.x, 1e-15);
    ck_assert_double_eq_tol(t.finger[0], x.x, 1e-11);
    ck_assert_double_eq_tol(t.finger[1], x.y, 1e-11);
    ck_assert_double_eq_tol(t.finger_v[0], v.x, 1e-8);
    ck_assert(t.pad < 0 && t.pad_force == 0);
    follow(sim);
  }
  ethd_sim_destroy(sim);
}

/* ---- equal bytes ---- */

static void run(ethd_sim *sim, ethd_truth *truth, ethd_sense *sense, int ticks) {
  for (int k = 0; k < ticks; k++) {
    truth[k] = sim_truth(sim);
    sense[k] = sim_sense(sim);
    follow(sim);
  }
}

/* The same tap twice, in two devices, and after another tap; another seed or tap is another thing. */
TEST_LOOP(test_same_bytes, 0, 2) {
  enum { TICKS = 200 };
  static ethd_truth truth[4][TICKS];
  static ethd_sense sense[4][TICKS];
  ethd_sim_def def = sim_def();
  def.plant.noise = 1e-4;
  def.plant.reading = _i;
  def.plant.ray_noise = 1e-4;
  ethd_sim_tap tap = sim_tap(), other = sim_tap();
  other.tap++;
  ethd_sim *a = sim_open(&def, &tap), *b = sim_open(&def, &other);
  run(a, truth[0], sense[0], TICKS);
  run(b, truth[1], sense[1], TICKS);
  ck_assert_int_eq(ethd_sim_start(a, &tap), ETHD_OK);
  run(a, truth[2], sense[2], TICKS);
  ck_assert_int_eq(ethd_sim_start(b, &tap), ETHD_OK);
  run(b, truth[3], sense[3], TICKS);
  for (int k = 2; k < 4; k++) {
    ck_assert_mem_eq(truth[0], truth[k], sizeof truth[0]);
    ck_assert_mem_eq(sense[0], sense[k], sizeof sense[0]);
  }
  ck_assert_mem_ne(sense[0], sense[1], sizeof sense[0]);
  /* reading twice and looking at the truth change nothing */
  ethd_sense twice[2] = {sim_sense(a), sim_sense(a)};
  ck_assert_mem_eq(&twice[0], &twice[1], sizeof twice[0]);
  ethd_sim_destroy(a);
  ethd_sim_destroy(b);
}

/* ---- refusals ---- */

TEST(test_refused_definitions) {
  static const struct {
    const char *name;
    size_t offset;
    double value;
  } bad[] = {
      {"device.mass_x", offsetof(ethd_sim_def, plant.mass[0]), 0},
      {"device.mass_y", offsetof(ethd_sim_def, plant.mass[1]), NAN},
      {"device.coupling", offsetof(ethd_sim_def, plant.coupling), 0.02},
      {"device.delay", offsetof(ethd_sim_def, plant.delay), 8.001e-3},
      {"transmission.stiffness", offsetof(ethd_sim_def, plant.stiffness), 0},
      {"transmission.motor_mass", offsetof(ethd_sim_def, plant.stiffness), 1000},
      {"finger.mass", offsetof(ethd_sim_def, plant.finger_mass), -1},
      {"proximity.rate", offsetof(ethd_sim_def, plant.rate), INFINITY},
      {"proximity.latency", offsetof(ethd_sim_def, plant.latency), 0.25},
      {"movement.speed_spread", offsetof(ethd_sim_def, plant.speed_spread), 0.4},
      {"link1", offsetof(ethd_sim_def, arm.link1), -0.25},
      {"period", offsetof(ethd_sim_def, period), 0},
      {"step", offsetof(ethd_sim_def, step), NAN},
      {"ring.radius", offsetof(ethd_sim_def, ring_radius), 0.008},
  };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    ethd_sim_def def = sim_def();
    ethd_sim *sim = (ethd_sim *)&def;
    ethd_error error;
    memcpy((char *)&def + bad[i].offset, &bad[i].value, sizeof bad[i].value);
    ck_assert_int_lt(ethd_sim_create(&def, &sim, &error), 0);
    ck_assert_ptr_null(sim);
    ck_assert_str_eq(error.name, bad[i].name);
    ck_assert_int_lt(ethd_sim_create(&def, &sim, NULL), 0);
  }
}

TEST(test_refused_taps) {
  ethd_sim_def def = sim_def();
  ethd_path_sample s[3] = {{0, 0.29, 0.25}, {0.1, 0.28, 0.25}, {0.2, 0.27, 0.25}};
  ethd_sim_tap good = sim_tap(), t;
  ethd_sim *sim = sim_open(&def, &good);
#define REFUSED(status, change)                        \
  do {                                                 \
    t = good;                                          \
    change;                                            \
    ck_assert_int_eq(ethd_sim_start(sim, &t), status); \
  } while (0)
  REFUSED(ETHD_E_RANGE, t.finger_radius = 0.012);
  REFUSED(ETHD_E_RANGE, t.finger_radius = NAN);
  REFUSED(ETHD_E_RANGE, t.phase = -1e-9);
  REFUSED(ETHD_E_RANGE, t.path.speed = 0);
  REFUSED(ETHD_E_RANGE, t.path.speed = 1.001 * ETHD_HAND_SPEED_MAX);
  REFUSED(ETHD_E_RANGE, t.path.ramp_up = NAN);
  REFUSED(ETHD_E_RANGE, t.path.profile = 2);
  REFUSED(ETHD_E_UNREACHABLE, t.path.from.x = 0.45);
  t.path.samples = good.path.samples = s;
  good.path.sample_count = 3;
  REFUSED(ETHD_OK, (void)0);
  REFUSED(ETHD_E_ARGUMENT, s[1].t = s[0].t);
  REFUSED(ETHD_E_ARGUMENT, s[1].t = 0.3);
  REFUSED(ETHD_E_ARGUMENT, (s[1].t = 0.1, s[2].y = INFINITY));
  REFUSED(ETHD_E_ARGUMENT, (s[2].y = 0.25, t.path.samples = NULL));
  REFUSED(ETHD_OK, s[1].x = 0.29 - 0.999 * ETHD_HAND_SPEED_MAX * 0.1);
  REFUSED(ETHD_E_RANGE, s[2].x = s[1].x + 1.001 * ETHD_HAND_SPEED_MAX * 0.1);
  ethd_sim_destroy(sim);
}
