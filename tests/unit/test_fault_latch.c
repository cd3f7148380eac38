/* A latched fault: until it is acknowledged, what goes on meanwhile, the way back; and without latch. */
#include <math.h>
#include <string.h>

#include "unit/moody.h"

TEST(test_latched_until_cleared) {
  rig r;
  ethd_counters c;
  moody_open(&r, 1);
  ethd_sense s = moody_sense(&r);
  rig_try(&r, &s);
  double before[2] = {r.command.torque[0], r.command.torque[1]};
  ethd_control_acknowledge(r.control); /* nothing to acknowledge: means nothing */
  rig_try(&r, &s);
  ck_assert_mem_eq(r.command.torque, before, sizeof before);
  mood.tracking = MOODY_FAIL;
  rig_try(&r, &s);
  mood.tracking = MOODY_WELL;
  for (int tick = 0; tick < 10; tick++) {
    rig_try(&r, &s);
    moody_expect_safe(&r, ETHD_E_LAW, ETHD_FAULT_LAW);
    ck_assert(r.trace.x[0] == 0.249 || fabs(r.trace.x[0] - 0.249) < 1e-12); /* the estimators go on */
  }
  moody_expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_LAW, 16);
  ck_assert_int_eq(rig_poll(&r).kind, 0); /* said once */
  ethd_control_counters(r.control, &c);
  ck_assert_uint_eq(c.faults[ETHD_FAULT_LAW], 1);
  /* softly from zero, in swap_time */
  ethd_control_acknowledge(r.control);
  for (int tick = 0; tick <= 22; tick++) {
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    double share = tick < 20 ? tick / 20.0 : 1;
    ck_assert_double_eq_tol(r.command.torque[0], share * before[0], 1e-12);
    ck_assert_double_eq_tol(r.command.torque[1], share * before[1], 1e-12);
    ck_assert(r.command.safe == 0 && r.trace.fault == 0);
  }
  moody_expect_event(&r, ETHD_EVENT_CLEARED, 0, 0);
  ck_assert_int_eq(rig_poll(&r).kind, 0);
  rig_close(&r);
}

/* Cleared while it lasts: it comes back at once. */
TEST(test_cleared_too_early) {
  rig r;
  moody_open(&r, 1);
  ethd_sense s = moody_sense(&r);
  mood.contact = MOODY_FAIL;
  for (int i = 0; i < 2; i++) {
    rig_try(&r, &s);
    moody_expect_safe(&r, ETHD_E_LAW, ETHD_FAULT_LAW);
    moody_expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_LAW, 116);
    ethd_control_acknowledge(r.control);
    rig_try(&r, &s);
    moody_expect_safe(&r, ETHD_E_LAW, ETHD_FAULT_LAW);
    moody_expect_event(&r, ETHD_EVENT_CLEARED, 0, 0);
    moody_expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_LAW, 116);
    ethd_control_acknowledge(r.control);
    mood.contact = MOODY_WELL;
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    moody_expect_event(&r, ETHD_EVENT_CLEARED, 0, 0);
    mood.contact = MOODY_FAIL;
  }
  rig_close(&r);
}

/* A setup posted while a fault is latched is taken; the fault stays until it is cleared. */
TEST(test_post_during_a_fault) {
  rig r;
  moody_open(&r, 1);
  ethd_sense s = moody_sense(&r);
  mood.transition = MOODY_FAIL;
  rig_try(&r, &s);
  (void)rig_poll(&r);
  ethd_setup_transition(&r.setup, &ethd_transition_smooth);
  rig_post(&r);
  rig_try(&r, &s);
  moody_expect_safe(&r, ETHD_E_LAW, ETHD_FAULT_LAW);
  ck_assert_int_eq(r.trace.swap, 1);
  moody_expect_event(&r, ETHD_EVENT_TAKEN, 0, 0);
  ethd_setup_tracking(&r.setup, &ethd_tracking_pd);
  rig_post(&r);
  ethd_control_acknowledge(r.control); /* both at one tick: softly into the new one */
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  ck_assert(r.trace.swap == 1 && r.command.torque[0] == 0);
  moody_expect_event(&r, ETHD_EVENT_CLEARED, 0, 0);
  moody_expect_event(&r, ETHD_EVENT_TAKEN, 0, 0);
  for (int i = 0; i < 20; i++) ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  rig fresh;
  rig_open(&fresh, RIG_WALL);
  fresh.setup = r.setup;
  rig_start(&fresh);
  rig_try(&fresh, &s);
  ck_assert_mem_eq(r.command.torque, fresh.command.torque, sizeof r.command.torque);
  rig_close(&fresh);
  rig_close(&r);
}

/* After it, contacts begin anew: braking, not the wall of before. */
TEST(test_contacts_begin_anew) {
  rig r;
  moody_open(&r, 1);
  ethd_setup_transition(&r.setup, &ethd_transition_offset);
  rig_post(&r);
  ethd_sense s = moody_sense(&r);
  for (int i = 0; i < 3; i++) rig_try(&r, &s);
  ck_assert_int_eq(r.trace.state, ETHD_VO);
  mood.contact = MOODY_FAIL;
  rig_try(&r, &s);
  mood.contact = MOODY_WELL;
  ethd_control_acknowledge(r.control);
  rig_try(&r, &s);
  ck_assert_int_eq(r.trace.state, ETHD_BRAKING);
  rig_close(&r);
}

/* Speeds are right when the fault is over, because the estimator never stopped. */
TEST(test_estimators_go_on) {
  rig r, healthy;
  moody_open(&r, 1);
  moody_open(&healthy, 1);
  for (int tick = 0; tick < 60; tick++) {
    motion m = rig_at(0.010 + 1e-6 * tick * tick, 0, 0.001);
    ethd_sense s = rig_sense(&r.setup.arm, &m);
    s.have = ETHD_HAVE_FINGER;
    mood.tracking = tick == 20 ? MOODY_FAIL : MOODY_WELL;
    if (tick == 50) ethd_control_acknowledge(r.control);
    rig_try(&r, &s);
    mood.tracking = MOODY_WELL;
    rig_try(&healthy, &s);
    ck_assert_mem_eq(r.trace.v, healthy.trace.v, sizeof r.trace.v);
  }
  ck_assert_int_eq(r.status, ETHD_OK);
  rig_close(&healthy);
  rig_close(&r);
}

/* Ticks without a measurement are missed ones for whatever comes next: no speed is too high after them. */
TEST(test_gap_of_measurements) {
  rig r, missing;
  moody_open(&r, 0);
  moody_open(&missing, 0);
  ethd_setup_velocity(&r.setup, ETHD_VELOCITY_DIFFERENCE);
  rig_post(&r);
  ethd_setup_velocity(&missing.setup, ETHD_VELOCITY_DIFFERENCE);
  rig_post(&missing);
  for (int tick = 0; tick < 60; tick++) {
    motion m = rig_at(0.010 - 2e-4 * tick, 0.2, 0.001);
    ethd_sense s = rig_sense(&r.setup.arm, &m), bad = s;
    s.have = bad.have = ETHD_HAVE_FINGER;
    bad.q[1] = NAN;
    int gap = tick >= 20 && tick < 27;
    if (gap || tick == 30) {
      rig_try(&r, &bad);
      moody_expect_safe(&r, ETHD_E_NOT_FINITE, ETHD_FAULT_INPUT);
      continue;
    }
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    s.missed = tick == 27 ? 7 : tick == 31;
    ck_assert_int_eq(rig_try(&missing, &s), ETHD_OK);
    ck_assert_mem_eq(r.trace.qd, missing.trace.qd, sizeof r.trace.qd);
    ck_assert_mem_eq(r.trace.tau, missing.trace.tau, sizeof r.trace.tau);
    if (tick > 0) ck_assert_double_eq_tol(r.trace.v[0], -0.2, 1e-3);
  }
  rig_close(&missing);
  rig_close(&r);
}

/* A law that fails just when it is to be replaced costs the estimators no sample either. */
TEST(test_failure_at_a_swap) {
  rig r;
  moody_open(&r, 0);
  ethd_setup_velocity(&r.setup, ETHD_VELOCITY_DIFFERENCE);
  rig_post(&r);
  for (int tick = 0; tick < 30; tick++) {
    motion m = rig_at(-0.001 - 2e-4 * tick, 0.2, 0.001);
    ethd_sense s = rig_sense(&r.setup.arm, &m);
    s.have = ETHD_HAVE_FINGER;
    if (tick == 20) {
      mood.contact = MOODY_FAIL;
      ethd_setup_contact(&r.setup, &ethd_contact_spring);
      rig_post(&r);
    }
    rig_try(&r, &s);
    if (tick == 20)
      moody_expect_safe(&r, ETHD_E_LAW, ETHD_FAULT_LAW);
    else
      ck_assert_int_eq(r.status, ETHD_OK);
    if (tick > 0) ck_assert_double_eq_tol(r.trace.v[0], -0.2, 1e-3);
  }
  rig_close(&r);
}

/* What is no number, or beyond any mechanism, is refused, so that no estimator keeps it, also while a clear is waited
   for. */
TEST(test_absurd_numbers) {
  const struct {
    size_t offset;
    int64_t have;
    double value, most, refused;
  } cases[] = {{offsetof(ethd_sense, q), 0, 0, 6.2831853071795865e6, 1e306},
               {offsetof(ethd_sense, q[1]), 0, 0, 6.2831853071795865e6, -1e7},
               {offsetof(ethd_sense, dq), ETHD_HAVE_DQ, ETHD_HAVE_DQ, 1e6, -1e300},
               {offsetof(ethd_sense, dq[1]), ETHD_HAVE_DQ, ETHD_HAVE_DQ, 1e6, 1.0001e6},
               {offsetof(ethd_sense, finger), 0, ETHD_HAVE_FINGER, 1e6, 1e7},
               {offsetof(ethd_sense, finger[1]), 0, ETHD_HAVE_FINGER, 1e6, -1e300},
               {offsetof(ethd_sense, finger[1]), ETHD_HAVE_START, ETHD_HAVE_FINGER, 1e6, 1e7},
               {offsetof(ethd_sense, finger_v), 0, ETHD_HAVE_FINGER, 1e6, 1e7},
               {offsetof(ethd_sense, finger_v[1]), 0, ETHD_HAVE_FINGER, 1e6, -1e7},
               {offsetof(ethd_sense, ring), ETHD_HAVE_RING, ETHD_HAVE_RING, 1e6, -2e6},
               {offsetof(ethd_sense, bodies[0]), ETHD_HAVE_BODY, ETHD_HAVE_BODY, 1e6, -1e12},
               {offsetof(ethd_sense, bodies[1]), ETHD_HAVE_BODY, ETHD_HAVE_BODY, 1e6, 1e300},
               {offsetof(ethd_sense, bodies[2]), ETHD_HAVE_BODY, ETHD_HAVE_BODY, 6.2831853071795865e6, -1e8},
               {offsetof(ethd_sense, bodies[3]), ETHD_HAVE_BODY, ETHD_HAVE_BODY, 1e6, 1e12},
               {offsetof(ethd_sense, bodies[4]), ETHD_HAVE_BODY, ETHD_HAVE_BODY, 1e6, 1e12},
               {offsetof(ethd_sense, bodies[5]), ETHD_HAVE_BODY, ETHD_HAVE_BODY, 1e6, 1e6 + 1}};
  for (size_t i = 0; i < 4 * sizeof cases / sizeof *cases; i++) {
    const size_t k = i / 4;
    const double absurd_ones[] = {cases[k].refused, NAN, INFINITY, -INFINITY};
    rig r;
    moody_open(&r, 1);
    r.setup.limits.speed = 10;
    rig_post(&r);
    ethd_sense s = moody_sense(&r), absurd;
    s.have = ETHD_HAVE_FINGER;
    rig_try(&r, &s);
    while (rig_poll(&r).kind != ETHD_EVENT_TAKEN) continue;
    absurd = s;
    absurd.have = cases[k].have == ETHD_HAVE_START ? ETHD_HAVE_START : s.have | cases[k].have;
    *(double *)(void *)((char *)&absurd + cases[k].offset) = absurd_ones[i % 4];
    rig_try(&r, &absurd);
    moody_expect_safe(&r, ETHD_E_NOT_FINITE, ETHD_FAULT_INPUT);
    moody_expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_INPUT, (double)cases[k].value);
    rig_try(&r, &s);
    ck_assert_double_eq(r.trace.qd[0], 0);
    ethd_control_acknowledge(r.control);
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    *(double *)(void *)((char *)&absurd + cases[k].offset) = copysign(cases[k].most, cases[k].refused);
    rig_try(&r, &absurd);
    ck_assert_int_ne(r.trace.fault, ETHD_FAULT_INPUT);
    rig_close(&r);
  }
}

/* Without latch each tick is judged alone: the one after is as if nothing had been. */
TEST(test_without_latch) {
  rig r, healthy;
  moody_open(&r, 0);
  moody_open(&healthy, 0);
  ethd_sense s = moody_sense(&r);
  ethd_counters c;
  for (int tick = 0; tick < 30; tick++) {
    mood.transition = tick % 3 == 2 ? MOODY_FAIL : MOODY_WELL;
    rig_try(&r, &s);
    if (tick % 3 == 2) {
      moody_expect_safe(&r, ETHD_E_LAW, ETHD_FAULT_LAW);
      moody_expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_LAW, 216);
      continue;
    }
    rig_try(&healthy, &s);
    ck_assert_int_eq(r.status, ETHD_OK);
    ck_assert_mem_eq(r.command.torque, healthy.command.torque, sizeof r.command.torque);
  }
  ethd_control_counters(r.control, &c);
  ck_assert(c.faults[ETHD_FAULT_LAW] == 10 && c.ticks == 30);
  rig_close(&healthy);
  rig_close(&r);
}
