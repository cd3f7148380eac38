/* What a reading says of itself: its noise, and whether it stands in the world; how old it may get at its own rate. */
#include <math.h>

#include "ethd/control.h"
#include "finger/limits.h"
#include "unit/rig.h"

#define RING (ethd_vec){0.25, 0.25}

static ethd_sense sense_at(int64_t time_ns, int64_t have) {
  ethd_sense s = {.time_ns = time_ns, .sample_ns = time_ns, .have = have};
  const ethd_arm arm = {ETHD_ARM_PARALLEL, 0.25, 0.25};
  ck_assert_int_eq(ethd_arm_angles(&arm, RING, -1, s.q), ETHD_OK);
  return s;
}

static void put(ethd_vec a, double out[2]) { out[0] = a.x, out[1] = a.y; }

static ethd_control *control_of(double finger_age) {
  ethd_setup setup = ethd_setup_default();
  ethd_control *control;
  ethd_error error;
  setup.limits.finger_age = finger_age;
  setup.limits.finger_lost = 3 * finger_age;
  ck_assert_int_eq(ethd_control_create(&setup, &control, &error), ETHD_OK);
  return control;
}

static ethd_trace step(ethd_control *control, const ethd_sense *s) {
  ethd_command command;
  ethd_trace trace;
  (void)!ethd_control_step(control, s, &command, &trace);
  return trace;
}

/* Two readings, 1 ms apart: their mean, weighted by 1 / variance as every textbook has it. In between the finger, seen
   once, may have moved at 1 m/s and 10 m/s^2 (sd). */
TEST_LOOP(test_weights, 0, 4) {
  const double sd[][2] = {{1e-4, 1e-4}, {1e-4, 1e-3}, {2e-3, 1e-4}, {1e-3, 5e-4}};
  ethd_control *control = control_of((double)INFINITY);
  ethd_sense first = sense_at(1000000, ETHD_HAVE_CENTRE | ETHD_HAVE_RING), second;
  put(RING, first.ring);
  put((ethd_vec){1e-4, 0}, first.centre);
  first.finger_noise = sd[_i][0];
  second = first;
  second.time_ns = second.sample_ns = first.time_ns + 1000000;
  put((ethd_vec){3e-4, 2e-4}, second.centre);
  second.finger_noise = sd[_i][1];
  step(control, &first);
  ethd_trace t = step(control, &second);
  double moved = 1e-3 * 1e-3 + 10 * 0.5e-6 * 10 * 0.5e-6;
  double a = 1 / (sd[_i][0] * sd[_i][0] + moved), b = 1 / (sd[_i][1] * sd[_i][1]);
  ck_assert_double_eq_tol(t.xf[0], 0.25 + (a * 1e-4 + b * 3e-4) / (a + b), 2e-8);
  ck_assert_double_eq_tol(t.xf[1], 0.25 + b * 2e-4 / (a + b), 2e-8);
  ethd_control_destroy(control);
}

/* 0 is the configuration's noise, to the bit. */
TEST(test_default) {
  ethd_control *own = control_of((double)INFINITY), *told = control_of((double)INFINITY);
  for (int k = 0; k < 30; k++) {
    ethd_sense s = sense_at(1000000 * (k + 1), k % 3 ? 0 : ETHD_HAVE_CENTRE);
    put((ethd_vec){1e-4 * (k % 5), -1e-5 * k}, s.centre);
    ethd_trace a = step(own, &s);
    s.finger_noise = 0.1e-3; /* the default of [finger_filter] noise */
    ethd_trace b = step(told, &s);
    ck_assert_mem_eq(a.xf, b.xf, sizeof a.xf);
    ck_assert_mem_eq(a.vf, b.vf, sizeof a.vf);
  }
  ethd_control_destroy(own);
  ethd_control_destroy(told);
}

/* What is no noise makes no reading. */
TEST_LOOP(test_no_noise, 0, 4) {
  const double bad[] = {-1e-4, (double)NAN, (double)INFINITY, 1e7};
  ethd_control *control = control_of((double)INFINITY);
  ethd_sense s = sense_at(1000000, ETHD_HAVE_CENTRE);
  s.finger_noise = bad[_i];
  step(control, &s);
  ethd_counters counters;
  ethd_control_counters(control, &counters);
  ck_assert_uint_eq(counters.readings_dropped, 1);
  ethd_control_destroy(control);
}

/* The world's finger is the ring's, whatever `ring` and [finger_filter] reference say. */
TEST_LOOP(test_world, 0, 2) {
  ethd_setup setup = ethd_setup_default();
  ethd_control *control;
  ethd_error error;
  ck_assert_int_eq(ethd_setup_set(&setup, "finger_filter.reference", _i, &error), ETHD_OK);
  ck_assert_int_eq(ethd_control_create(&setup, &control, &error), ETHD_OK);
  ethd_sense s = sense_at(1000000, ETHD_HAVE_CENTRE | ETHD_HAVE_WORLD | ETHD_HAVE_RING);
  put((ethd_vec){0.251, 0.249}, s.centre);
  put((ethd_vec){7, 7}, s.ring);
  ethd_trace t = step(control, &s);
  ck_assert_double_eq_tol(t.xf[0], 0.251, 1e-15);
  ck_assert_double_eq_tol(t.xf[1], 0.249, 1e-15);
  ethd_control_destroy(control);
}

/* A late reading belongs to where the ring was then. The controller remembers 32 ticks of it; what is older is taken
   for the oldest of them. */
TEST_LOOP(test_late, 0, 6) {
  const int ages[] = {0, 5, 31, 32, 40, 90};
  const double speed = 0.05; /* m/s */
  const ethd_arm arm = {ETHD_ARM_PARALLEL, 0.25, 0.25};
  ethd_setup setup = ethd_setup_default();
  ethd_control *control;
  ethd_error error;
  ethd_trace t;
  ck_assert_int_eq(ethd_setup_set(&setup, "finger_filter.reference", 0, &error), ETHD_OK);
  ck_assert_int_eq(ethd_control_create(&setup, &control, &error), ETHD_OK);
  for (int k = 1; k <= 100; k++) {
    ethd_sense s = sense_at(1000000 * k, k == 100 ? ETHD_HAVE_CENTRE : 0);
    ck_assert_int_eq(ethd_arm_angles(&arm, (ethd_vec){0.25 + 1e-3 * speed * k, 0.25}, -1, s.q), ETHD_OK);
    s.sample_ns = s.time_ns - 1000000 * ages[_i];
    put((ethd_vec){1e-4, 0}, s.centre);
    t = step(control, &s);
  }
  ck_assert_double_eq_tol(t.xf[0], 0.25 + 1e-3 * speed * (100 - fmin(ages[_i], 31)) + 1e-4, 1e-12);
  ethd_control_destroy(control);
}

/* A device's finger can't be outside of its ring: judged where the ring stood, not at the world's origin. */
TEST(test_world_outside) {
  ethd_control *control = control_of(0.01);
  ethd_sense s = sense_at(1000000, ETHD_HAVE_CENTRE | ETHD_HAVE_WORLD);
  put((ethd_vec){0.253, 0.25}, s.centre);
  ck_assert_double_eq_tol(step(control, &s).xf[0], 0.253, 1e-15);
  s.time_ns = s.sample_ns += 1000000;
  put((ethd_vec){0.002, 0.001}, s.centre); /* near the origin, where no ring is */
  ck_assert_double_gt(step(control, &s).xf[0], 0.25);
  ethd_counters counters;
  ethd_control_counters(control, &counters);
  ck_assert_uint_eq(counters.readings_dropped, 1);
  ethd_control_destroy(control);
}

/* How often within 3 s the finger was too old, with readings of 90 Hz. */
static uint64_t trips(double latency, double finger_age) {
  ethd_control *control = control_of(finger_age);
  ethd_counters counters;
  int sent = 0;
  for (int k = 1; k <= 3000; k++) {
    int newest = (int)floor((1e-3 * k - latency) * 90);
    ethd_sense s = sense_at((int64_t)k * 1000000, 0);
    if (newest >= sent) {
      s.have = ETHD_HAVE_CENTRE | ETHD_HAVE_WORLD;
      s.sample_ns = (int64_t)(1e9 * newest / 90);
      put(RING, s.centre);
      sent = newest + 1;
    }
    step(control, &s);
  }
  ethd_control_counters(control, &counters);
  ethd_control_destroy(control);
  ck_assert_int_gt(sent, 260);
  return counters.faults[ETHD_FAULT_FINGER_OLD];
}

/* A limit for 300 Hz trips at nearly every reading of 90 Hz; one that the rate gives never does. */
TEST(test_rate) {
  ethd_limits own = ethd_limits_none();
  ck_assert_uint_gt(trips(0, ethd_limits_device().finger_age), 200);
  ethd__finger_limits(90, 0, &own);
  ck_assert_uint_eq(trips(0, own.finger_age), 0);
  ethd__finger_limits(90, 11.1e-3, &own);
  ck_assert_uint_eq(trips(11.1e-3, own.finger_age), 0);
  ck_assert_double_eq_tol(own.finger_age, 44.4e-3, 1e-4);
  ck_assert_double_eq_tol(own.finger_lost, 111.1e-3, 1e-4);
}
