/* The finger's readings: too old, lost, implausible. */
#include <math.h>
#include <string.h>

#include "unit/moody.h"

#define PERIOD 1000000 /* ns */

/* A tap's parts: a reading every 3 ms, 2 ms late, while `seen`. */
typedef struct finger {
  rig r;
  int tick;
  int64_t sampled; /* tick of the last one that was used */
  double relative; /* m along x */
  int bad;         /* readings that are to be outside of the ring */
} finger;

static void open_finger(finger *f, double age, double lost) {
  memset(f, 0, sizeof *f);
  f->relative = -0.002;
  moody_open(&f->r, 1);
  f->r.setup.limits.finger_age = age;
  f->r.setup.limits.finger_lost = lost;
  rig_post(&f->r);
}

static void step(finger *f, int seen, double x) {
  motion m = rig_at(x, 0, 0);
  ethd_sense s = rig_sense(&f->r.setup.arm, &m);
  s.have = ETHD_HAVE_DQ;
  s.time_ns = (int64_t)++f->tick * PERIOD;
  if (seen && f->tick % 3 == 0) {
    s.have |= ETHD_HAVE_CENTRE;
    s.sample_ns = s.time_ns - 2 * PERIOD;
    s.centre[0] = f->bad > 0 ? 0.013 : f->relative;
    if (f->bad-- <= 0) f->sampled = f->tick - 2;
  }
  rig_try(&f->r, &s);
}

static int64_t age(const finger *f) { return f->tick - f->sampled; }

static uint64_t counted(const finger *f, int row) {
  ethd_counters c;
  ethd_control_counters(f->r.control, &c);
  return c.faults[row];
}

/* Over 10 ms tracking fades in 20 ms, the wall stays; readings again: it comes back as softly. */
TEST(test_old) {
  finger f;
  open_finger(&f, 0.010, INFINITY);
  for (int i = 0; i < 60; i++) step(&f, 1, 0.01);
  double before = f.r.command.torque[0], beta = f.r.trace.beta;
  ck_assert(fabs(before) > 0.01 && beta == 1);
  for (int i = 0, old = 0; i < 60; i++) {
    step(&f, 0, 0.01);
    old += age(&f) > 10;
    double share = 1 - fmin(old / 20.0, 1);
    ck_assert_double_eq_tol(f.r.trace.beta, share, 1e-12);
    ck_assert_double_eq_tol(f.r.command.torque[0], before * share, 1e-9);
    ck_assert(f.r.status == ETHD_OK && counted(&f, ETHD_FAULT_FINGER_OLD) == (old > 0));
  }
  step(&f, 0, -0.001); /* into the wall */
  ck_assert_double_gt(fabs(f.r.command.torque[0]), 0.5);
  for (int i = 0; i < 3; i++) step(&f, 0, 0.01);
  for (int i = 0; i < 60; i++) {
    double last = f.r.trace.beta;
    step(&f, 1, 0.01);
    ck_assert_msg(f.r.trace.beta - last <= 0.05 + 1e-12, "%d %g %g", i, last, f.r.trace.beta);
  }
  ck_assert_double_eq(f.r.trace.beta, 1);
  moody_expect_event(&f.r, ETHD_EVENT_TAKEN, 0, 0);
  moody_expect_event(&f.r, ETHD_EVENT_FAULT, ETHD_FAULT_FINGER_OLD, 0);
  ck_assert_int_eq(rig_poll(&f.r).kind, 0);
  rig_close(&f.r);
}

/* Over 30 ms from the sample's instant: a stop, at the first tick, whether or not tracking fades before. */
TEST_LOOP(test_lost, 0, 2) {
  finger f;
  open_finger(&f, _i ? INFINITY : 0.010, 0.030);
  for (int i = 0; i < 60; i++) step(&f, 1, 0.01);
  while (age(&f) < 30) {
    step(&f, 0, 0.01);
    ck_assert_int_eq(f.r.status, ETHD_OK);
    if (_i) ck_assert(f.r.trace.beta == 1 && counted(&f, ETHD_FAULT_FINGER_OLD) == 0);
  }
  step(&f, 0, 0.01);
  moody_expect_safe(&f.r, ETHD_E_DEVICE, ETHD_FAULT_FINGER_LOST); /* at rest: nothing to damp */
  rig_close(&f.r);
}

/* A finger that was never seen isn't missed, nor one that is known without readings, nor any without limit. */
TEST(test_not_missed) {
  finger f;
  open_finger(&f, 0.010, 0.030);
  for (int i = 0; i < 100; i++) step(&f, 0, 0.01);
  ck_assert_int_eq(f.r.status, ETHD_OK);
  for (int i = 0; i < 30; i++) step(&f, 1, 0.01);
  for (int i = 0; i < 100; i++) {
    ethd_sense s = moody_sense(&f.r);
    ck_assert_int_eq(rig_try(&f.r, &s), ETHD_OK);
  }
  rig_close(&f.r);
  open_finger(&f, INFINITY, INFINITY);
  for (int i = 0; i < 30; i++) step(&f, 1, 0.01);
  for (int i = 0; i < 100; i++) step(&f, 0, 0.01);
  ck_assert(f.r.status == ETHD_OK && f.r.trace.beta == 1);
  rig_close(&f.r);
}

/* Outside of the ring: dropped and counted, five in a row stop. */
TEST(test_outside) {
  finger f;
  open_finger(&f, 0.010, 0.030);
  for (int i = 0; i < 60; i++) step(&f, 1, 0.01);
  f.bad = 2;
  for (int i = 0; i < 12; i++) step(&f, 1, 0.01);
  ck_assert(f.r.status == ETHD_OK && counted(&f, ETHD_FAULT_ESTIMATE) == 2);
  ck_assert_double_eq_tol(f.r.trace.xf[0], 0.258, 1e-4);
  f.r.setup.limits.finger_age = f.r.setup.limits.finger_lost = 1;
  rig_post(&f.r);
  f.bad = 5;
  for (int i = 0; i < 14; i++) step(&f, 1, 0.01);
  ck_assert(f.r.status == ETHD_OK && f.bad == 1);
  for (int i = 0; i < 3; i++) step(&f, 1, 0.01);
  ck_assert(f.r.trace.fault == ETHD_FAULT_ESTIMATE && f.r.command.safe == 1);
  rig_close(&f.r);
}

/* Within the ring, but no finger jumps so: the filter's gate. */
TEST(test_gated) {
  finger f;
  open_finger(&f, 1, 1);
  step(&f, 0, 0.01);
  const ethd_method *method = &ethd_filter_methods[f.r.setup.filter];
  f.r.setup.filter_p[ethd_params_find(method->params, method->param_count, "gate")] = 4;
  rig_post(&f.r);
  for (int i = 0; i < 300; i++) step(&f, 1, 0.01);
  f.relative = 0.009;
  for (int i = 0; i < 12; i++) step(&f, 1, 0.01);
  ck_assert(f.r.status == ETHD_OK && counted(&f, ETHD_FAULT_ESTIMATE) == 4);
  for (int i = 0; i < 3; i++) step(&f, 1, 0.01);
  ck_assert_int_eq(f.r.trace.fault, ETHD_FAULT_ESTIMATE);
  rig_close(&f.r);
}
