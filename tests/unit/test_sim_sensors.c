/* Encoders and the proximity ring: counts, instants, delivery, what a reading holds. */
#include <stdlib.h>

#include "ethd/estimate.h"
#include "unit/sim_rig.h"

/* ---- encoders ---- */

/* The nearest count; with a phase, of a grid shifted by it, the same for the whole tap. */
static double grid_of(ethd_sim *sim, const ethd_sim_def *def, const double q[2], int joint) {
  ethd_sense s = sim_sense(sim);
  double count = def->plant.count;
  ck_assert_double_le(fabs(s.q[joint] - q[joint]), count / 2 * (1 + 1e-9));
  double share = s.q[joint] / count;
  return share - floor(share);
}

TEST_LOOP(test_counts, 0, 2) {
  ethd_sim_def def = sim_def(), ideal = sim_def();
  ethd_sim_tap tap = sim_tap();
  def.plant.count = 2e-4;
  def.plant.count_phase = _i;
  double phases[8][2];
  for (tap.tap = 0; tap.tap < 8; tap.tap++) {
    ethd_sim *sim = sim_open(&def, &tap), *truth = sim_open(&ideal, &tap);
    for (int k = 0; k < 60; k++) {
      ethd_sense exact = sim_sense(truth);
      for (int j = 0; j < 2; j++) {
        double phase = grid_of(sim, &def, exact.q, j);
        if (k == 0) phases[tap.tap][j] = phase;
        double off = phase - phases[tap.tap][j];
        ck_assert_double_eq_tol(off - floor(off + 0.5), 0, 1e-9);
      }
      sim_push(sim, 0.1, -0.05);
      sim_push(truth, 0.1, -0.05);
    }
    ethd_sim_destroy(sim);
    ethd_sim_destroy(truth);
  }
  for (int k = 0; k < 8; k++)
    for (int j = 0; j < 2; j++) {
      if (!_i) ck_assert_double_eq_tol(fmin(phases[k][j], 1 - phases[k][j]), 0, 1e-9);
      if (_i && k) ck_assert_double_gt(fabs(phases[k][j] - phases[k - 1][j]), 1e-3);
      if (_i) ck_assert_double_gt(fabs(phases[k][0] - phases[k][1]), 1e-3);
    }
}

/* Behind a compliant transmission the encoders see the motors' side, and `motor` is where that puts the ring. */
TEST_LOOP(test_motor_side, 0, 2) {
  ethd_sim_def def = sim_def();
  ethd_sim_tap tap = sim_tap();
  def.arm.mechanism = (ethd_mechanism)_i;
  def.plant.stiffness = 3500;
  def.plant.motor_mass = 0.01;
  ethd_sim *sim = sim_open(&def, &tap);
  double apart = 0;
  for (int k = 0; k < 40; k++) {
    sim_push(sim, k & 8 ? 0.4 : -0.4, k & 4 ? 0.3 : -0.3);
    ethd_sense s = sim_sense(sim);
    ethd_truth t = sim_truth(sim);
    ethd_pose pose;
    ethd_arm_pose(&def.arm, s.q, &pose);
    ck_assert_double_eq_tol(pose.x.x, t.motor[0], 1e-14);
    ck_assert_double_eq_tol(pose.x.y, t.motor[1], 1e-14);
    apart = fmax(apart, hypot(t.motor[0] - t.ring[0], t.motor[1] - t.ring[1]));
  }
  ck_assert_double_gt(apart, 1e-4);
  ethd_sim_destroy(sim);
}

/* ---- readings ---- */

/* Reading k is taken at phase + k / rate and comes at the first tick that isn't before sample + latency; of
   two in one tick the newer. */
static void arrivals(double rate, double latency, double phase, int ticks) {
  ethd_sim_def def = sim_def();
  ethd_sim_tap tap = sim_tap();
  def.plant.rate = rate;
  def.plant.latency = latency;
  tap.phase = phase;
  ethd_sim *sim = sim_open(&def, &tap);
  int64_t late = (int64_t)floor(1e9 * latency + 0.5);
  for (int k = 0; k < ticks; k++) {
    ethd_sense s = sim_sense(sim);
    int64_t now = 1000000 * (int64_t)k, newest = -1;
    for (int i = 0; i < 1000; i++) {
      int64_t sample = (int64_t)floor(1e9 * (phase + i / rate) + 0.5);
      if (sample + late <= now && sample + late > now - 1000000) newest = sample;
      if (sample > now) break;
    }
    ck_assert_int_eq((s.have & ETHD_HAVE_CENTRE) != 0, newest >= 0);
    ck_assert_int_eq((s.have & ETHD_HAVE_RING) != 0, newest >= 0);
    ck_assert_int_eq(s.have & ETHD_HAVE_RAYS, 0);
    if (newest >= 0) ck_assert_int_eq(s.sample_ns, newest);
    sim_push(sim, 0, 0);
  }
  ethd_sim_destroy(sim);
}

TEST(test_arrivals) {
  arrivals(300, 1.93e-3, 0, 100);
  arrivals(300, 1.93e-3, 3.1e-3, 100);
  arrivals(300, 0, 0, 100);     /* the first comes with the start */
  arrivals(1000, 2e-3, 0, 100); /* on the tick itself */
  arrivals(2500, 0.3e-3, 0.1e-3, 100);
  arrivals(300, 0.2, 1e-3, 300); /* sixty on their way */
}

/* Where ring and finger were at the sample's instant, worked out with ticks as short as that takes. */
TEST_LOOP(test_pose_at_the_sample, 0, 2) {
  ethd_sim_def def = sim_def(), fine = sim_def();
  ethd_sim_tap tap = sim_tap();
  def.plant.reference = _i;
  if (_i) {
    def.plant.stiffness = fine.plant.stiffness = 3500;
    def.plant.motor_mass = fine.plant.motor_mass = 0.01;
  }
  def.plant.delay = fine.plant.delay = 0;
  def.plant.rate = 400;
  tap.phase = 0.3e-3; /* samples at 0.3, 2.8, 5.3 ... ms: whole tenths */
  fine.period = 0.1e-3;
  ethd_sim *sim = sim_open(&def, &tap), *truth = sim_open(&fine, &tap);
  static ethd_truth tenths[1200];
  for (int k = 0; k < 1200; k++) {
    tenths[k] = sim_truth(truth);
    double torque = k / 10 & 8 ? 0.3 : -0.35;
    sim_push(truth, torque, 0.1);
  }
  int readings = 0;
  for (int k = 0; k < 110; k++) {
    ethd_sense s = sim_sense(sim);
    if (s.have & ETHD_HAVE_CENTRE) {
      const ethd_truth *t = &tenths[s.sample_ns / 100000];
      ck_assert_int_eq(s.sample_ns % 100000, 0);
      for (int i = 0; i < 2; i++) {
        ck_assert_double_eq_tol(s.ring[i], _i ? t->motor[i] : t->ring[i], 2e-9);
        ck_assert_double_eq_tol(s.centre[i], t->finger[i] - t->ring[i], 2e-9);
      }
      readings++;
    }
    sim_push(sim, k & 8 ? 0.3 : -0.35, 0.1);
  }
  ck_assert_int_ge(readings, 42);
  ethd_sim_destroy(sim);
  ethd_sim_destroy(truth);
}

/* Mean 0, the plant's sd, not cut; x and y and neighbours have nothing to do with each other. */
TEST(test_noise) {
  ethd_sim_def def = sim_def();
  ethd_sim_tap tap = sim_tap();
  def.plant.noise = 1e-4;
  def.plant.rate = 1000;
  def.plant.latency = 0;
  sim_hold(&def);
  def.step = 1e-3;
  tap.phase = 0;
  tap.path.speed = 1e-9;
  ethd_sim *sim = sim_open(&def, &tap);
  enum { MANY = 20000 };
  double sum[2] = {0}, square[2] = {0}, cross = 0, next = 0, last = 0, most = 0;
  for (int k = 0; k < MANY; k++) {
    ethd_sense s = sim_sense(sim);
    ethd_truth t = sim_truth(sim);
    double e[2];
    for (int i = 0; i < 2; i++) {
      e[i] = (s.centre[i] - (t.finger[i] - t.ring[i])) / 1e-4;
      sum[i] += e[i] / MANY;
      square[i] += e[i] * e[i] / MANY;
      most = fmax(most, fabs(e[i]));
    }
    cross += e[0] * e[1] / MANY;
    next += e[0] * last / MANY;
    last = e[0];
    sim_push(sim, 0, 0);
  }
  double unit = sqrt(1.0 / MANY);
  for (int i = 0; i < 2; i++) {
    ck_assert_double_eq_tol(sum[i], 0, 4 * unit);
    ck_assert_double_eq_tol(square[i], 1, 4 * sqrt(2) * unit);
  }
  ck_assert_double_eq_tol(cross, 0, 4 * unit);
  ck_assert_double_eq_tol(next, 0, 4 * unit);
  ck_assert_double_gt(most, 3);
  ethd_sim_destroy(sim);
}

/* ---- rays ---- */

/* The free way along ray k to a disc of radius r at c: the near end of the chord. NaN: it misses. */
static double free_way(double ring, double r, const double c[2], int k) {
  double a = 2 * 3.14159265358979323846 * k / 16, u[2] = {cos(a), sin(a)};
  double along = c[0] * u[0] + c[1] * u[1], across = c[0] * u[1] - c[1] * u[0];
  return ring - (along + sqrt(r * r - across * across));
}

/* A ring that stands still and a finger on a known path: each ray sees it at its own instant, and the frame
   is of the middle. */
TEST_LOOP(test_rays, 0, 2) {
  ethd_sim_def def = sim_def();
  ethd_sim_tap tap = sim_tap();
  def.plant.reading = 1;
  def.plant.ray_noise = 0;
  def.plant.ray_skew = _i * 1.1e-3;
  sim_hold(&def);
  tap.path.speed = 0.03;
  ethd_sim *sim = sim_open(&def, &tap);
  int frames = 0;
  for (int k = 0; k < 130; k++) {
    ethd_sense s = sim_sense(sim);
    ck_assert_int_eq(s.have & ETHD_HAVE_CENTRE, 0);
    if (s.have & ETHD_HAVE_RAYS) {
      double begin = 0.7e-3 + frames / 300.0;
      ck_assert_int_eq(s.sample_ns, (int64_t)floor(1e9 * (begin + def.plant.ray_skew / 2) + 0.5));
      ck_assert_int_ge(1000000 * (int64_t)k, s.sample_ns + (int64_t)(1e9 * (def.plant.ray_skew / 2 + 1.93e-3)) - 1);
      ck_assert_double_eq_tol(s.ring[0], 0.29, 1e-12);
      for (int j = 0; j < 16; j++) {
        ethd_vec x, v;
        ethd_path_at(&tap.path, begin + def.plant.ray_skew * j / 15, &x, &v);
        const double c[2] = {x.x - 0.29, x.y - 0.25};
        ck_assert_double_eq_tol(s.rays[j], free_way(0.012, 0.0073, c, j), 1e-11);
      }
      frames++;
    }
    sim_push(sim, 0, 0);
  }
  ck_assert_int_ge(frames, 37);
  ethd_sim_destroy(sim);
}

TEST(test_ray_noise) {
  ethd_sim_def def = sim_def();
  ethd_sim_tap tap = sim_tap();
  def.plant.reading = 1;
  def.plant.ray_noise = 3e-4;
  sim_hold(&def);
  def.step = 1e-3;
  tap.path.speed = 1e-9;
  ethd_sim *sim = sim_open(&def, &tap);
  double square[16] = {0}, pairs = 0;
  int frames = 0;
  for (int k = 0; k < 9000; k++) {
    ethd_sense s = sim_sense(sim);
    if (s.have & ETHD_HAVE_RAYS) {
      for (int j = 0; j < 16; j++) {
        double e = (s.rays[j] - (0.012 - 0.0073)) / 3e-4, before = (s.rays[(j + 15) % 16] - (0.012 - 0.0073)) / 3e-4;
        square[j] += e * e;
        pairs += e * before / 16;
      }
      frames++;
    }
    sim_push(sim, 0, 0);
  }
  for (int j = 0; j < 16; j++) ck_assert_double_eq_tol(square[j] / frames, 1, 4.5 * sqrt(2.0 / frames));
  ck_assert_double_eq_tol(pairs / frames, 0, 4 * sqrt(1.0 / frames / 16));
  ethd_sim_destroy(sim);
}
