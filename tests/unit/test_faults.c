/* Faults: what causes each, what it says, which command it leads to, and the way back. */
#include <math.h>
#include <string.h>

#include "unit/rig.h"

/* ---- laws that misbehave when told to ---- */

enum { WELL, FAIL, POSITIVE, BAD };
static struct {
  int tracking, contact, transition;
  double value; /* of what is bad */
  size_t field; /* of the ruling */
} mood;

static ethd_status status_of(int m) { return m == FAIL ? ETHD_E_LAW : m == POSITIVE ? ETHD_STALE : ETHD_OK; }

static ethd_status track(const double *p, void *state, const ethd_tracking_in *in, double tau[2]) ETHD_RT {
  (void)p, (void)state;
  tau[0] = 40 * in->eps_q[0] + in->eps_q_dot[0];
  tau[1] = mood.tracking == BAD ? mood.value : 40 * in->eps_q[1] + in->eps_q_dot[1];
  return status_of(mood.tracking);
}

static ethd_status touch(const double *p, void *state, double gap, double speed, int entering, double *force) ETHD_RT {
  (void)p, (void)state, (void)speed, (void)entering;
  *force = mood.contact == BAD ? mood.value : gap < 0 ? 2500 * gap : 0;
  return status_of(mood.contact);
}

static ethd_status rule(const double *p, void *state, const ethd_contact *c, ethd_ruling *out) ETHD_RT {
  (void)p, (void)state;
  out->state = c->d_re < 0 ? ETHD_VO : ETHD_TRANSPARENT;
  out->share = 1;
  if (mood.transition == BAD) memcpy((char *)out + mood.field, &mood.value, sizeof mood.value);
  return status_of(mood.transition);
}

#define LAW(type, kind) {sizeof(type), ETHD_ABI, kind, 0, "moody", "as it is told", NULL, 0, NULL, NULL}
static const ethd_tracking_law moody_tracking = {LAW(ethd_tracking_law, ETHD_TRACKING), track};
static const ethd_contact_law moody_contact = {LAW(ethd_contact_law, ETHD_CONTACT), touch};
static const ethd_transition_law moody_transition = {LAW(ethd_transition_law, ETHD_TRANSITION), rule};

static void open_moody(rig *r, int latch) {
  memset(&mood, 0, sizeof mood);
  rig_open(r, RIG_WALL);
  ethd_setup_tracking(&r->setup, &moody_tracking);
  ethd_setup_contact(&r->setup, &moody_contact);
  ethd_setup_transition(&r->setup, &moody_transition);
  r->setup.limits.latch = latch;
  rig_start(r);
}

/* 1 mm inside at 10 mm/s, finger 1 mm deeper. */
static ethd_sense ordinary(const rig *r) {
  motion m = rig_at(-0.001, 0.010, 0.001);
  ethd_sense s = rig_sense(&r->setup.arm, &m);
  s.time_ns = r->sense.time_ns + 1000000;
  return s;
}

static void expect_safe(const rig *r, ethd_status status, ethd_fault fault) {
  if (r->status != status || r->trace.fault != (int64_t)fault)
    ck_abort_msg("%s, fault %d", ethd_status_sentence(r->status), (int)r->trace.fault);
  ck_assert(r->command.safe == 1 && r->command.torque[0] == 0 && r->command.torque[1] == 0);
  ck_assert(r->trace.tau[0] == 0 && r->trace.tau[1] == 0);
}

static void expect_event(rig *r, int kind, int code, double value) {
  ethd_event e = rig_poll(r);
  if ((int)e.kind != kind || e.code != code || !(e.value == value || isnan(value)))
    ck_abort_msg("event %d, %d, %g; not %d, %d, %g", (int)e.kind, e.code, e.value, kind, code, value);
}

/* ---- causes ---- */

typedef struct bad_input {
  size_t field;
  int64_t have, value;
} bad_input;

#define IN(field) offsetof(ethd_sense, field)
static const bad_input bad_inputs[] = {
    {IN(q[0]), 0, 0},
    {IN(q[1]), 0, 0},
    {IN(dq[0]), ETHD_HAVE_DQ, ETHD_HAVE_DQ},
    {IN(dq[1]), ETHD_HAVE_DQ, ETHD_HAVE_DQ},
    {IN(finger[0]), ETHD_HAVE_FINGER, ETHD_HAVE_FINGER},
    {IN(finger[1]), ETHD_HAVE_START, ETHD_HAVE_FINGER},
    {IN(finger_v[1]), ETHD_HAVE_FINGER, ETHD_HAVE_FINGER},
    {IN(ring[0]), ETHD_HAVE_RING, ETHD_HAVE_RING},
};

START_TEST(test_input) {
  const bad_input *c = &bad_inputs[_i];
  const double values[] = {NAN, INFINITY, -INFINITY};
  for (int k = 0; k < 3; k++) {
    rig r;
    open_moody(&r, 1);
    ethd_sense s = ordinary(&r);
    rig_try(&r, &s);
    memcpy((char *)&s + c->field, &values[k], sizeof(double));
    s.have |= c->have;
    rig_try(&r, &s);
    expect_safe(&r, ETHD_E_NOT_FINITE, ETHD_FAULT_INPUT);
    expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_INPUT, (double)c->value);
    rig_close(&r);
  }
}
END_TEST

/* What the sense doesn't claim to have isn't looked at. */
START_TEST(test_fields_that_are_not_there) {
  rig r;
  open_moody(&r, 1);
  ethd_sense s = ordinary(&r);
  s.have = 0;
  s.dq[0] = s.finger[0] = s.finger_v[1] = s.ring[0] = s.centre[0] = s.rays[3] = NAN;
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  s.have = ETHD_HAVE_CENTRE; /* a reading that isn't a number is dropped, as a lost one */
  s.sample_ns = s.time_ns;
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  ethd_counters c;
  ethd_control_counters(r.control, &c);
  ck_assert_uint_eq(c.readings_dropped, 1);
  rig_close(&r);
}
END_TEST

START_TEST(test_law_fails) {
  int *const moods[] = {&mood.tracking, &mood.contact, &mood.transition};
  rig r;
  open_moody(&r, 1);
  ethd_sense s = ordinary(&r);
  *moods[_i] = POSITIVE;
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  *moods[_i] = FAIL;
  rig_try(&r, &s);
  expect_safe(&r, ETHD_E_LAW, ETHD_FAULT_LAW);
  expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_LAW, 100 * _i + 16);
  rig_close(&r);
}
END_TEST

static const struct {
  int kind;
  size_t field;
  double value;
} bad_outputs[] = {
    {ETHD_TRACKING, 0, NAN},
    {ETHD_TRACKING, 0, INFINITY},
    {ETHD_CONTACT, 0, NAN},
    {ETHD_CONTACT, 0, -INFINITY},
    {ETHD_CONTACT, 0, INFINITY},
    {ETHD_TRANSITION, offsetof(ethd_ruling, beta), NAN},
    {ETHD_TRANSITION, offsetof(ethd_ruling, beta), 1.001},
    {ETHD_TRANSITION, offsetof(ethd_ruling, beta), -0.001},
    {ETHD_TRANSITION, offsetof(ethd_ruling, share), NAN},
    {ETHD_TRANSITION, offsetof(ethd_ruling, share), 1.001},
    {ETHD_TRANSITION, offsetof(ethd_ruling, share), -0.001},
    {ETHD_TRANSITION, offsetof(ethd_ruling, offset), NAN},
    {ETHD_TRANSITION, offsetof(ethd_ruling, offset), INFINITY},
    {ETHD_TRANSITION, offsetof(ethd_ruling, damping), NAN},
    {ETHD_TRANSITION, offsetof(ethd_ruling, damping), -1},
    {ETHD_TRANSITION, offsetof(ethd_ruling, damping), INFINITY},
    {ETHD_TRANSITION, offsetof(ethd_ruling, feed), NAN},
    {ETHD_TRANSITION, offsetof(ethd_ruling, feed), -INFINITY},
    {ETHD_TRANSITION, offsetof(ethd_ruling, shift.x), NAN},
    {ETHD_TRANSITION, offsetof(ethd_ruling, shift.y), INFINITY},
    {ETHD_TRANSITION, offsetof(ethd_ruling, argument), NAN},
};

START_TEST(test_law_says_nonsense) {
  rig r;
  open_moody(&r, 1);
  ethd_sense s = ordinary(&r);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  mood.field = bad_outputs[_i].field;
  mood.value = bad_outputs[_i].value;
  *(bad_outputs[_i].kind == ETHD_TRACKING  ? &mood.tracking
    : bad_outputs[_i].kind == ETHD_CONTACT ? &mood.contact
                                           : &mood.transition) = BAD;
  rig_try(&r, &s);
  expect_safe(&r, ETHD_E_NOT_FINITE, ETHD_FAULT_FINITE);
  expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_FINITE, bad_outputs[_i].kind);
  rig_close(&r);
}
END_TEST

/* Each number finite, their sum not: the guard's matter. */
START_TEST(test_sum_overflows) {
  rig r;
  open_moody(&r, 1);
  ethd_scene *old = r.scene;
  r.setup.scene = r.scene = rig_scene("halfplane -1 0 -0.5\n");
  rig_post(&r);
  ethd_sense s = ordinary(&r);
  s.q[0] = 0.8, s.q[1] = -0.6; /* dx/dq2 = 0.141 m: the force has a share in joint 2 */
  mood.tracking = BAD;
  mood.value = 1.7e308;
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  mood.transition = BAD;
  mood.field = offsetof(ethd_ruling, feed);
  mood.tracking = WELL;
  mood.value = -1.7e308;
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  mood.tracking = BAD; /* both at once */
  s.q[1] = 0.6;        /* dx/dq2 = -0.141 m and F = +1.79e308 N: two negative torques */
  mood.value = -1.79e308;
  rig_try(&r, &s);
  expect_safe(&r, ETHD_E_NOT_FINITE, ETHD_FAULT_FINITE);
  ck_assert_int_eq(r.trace.guard, ETHD_GUARD_FINITE);
  ethd_scene_destroy(old);
  rig_close(&r);
}
END_TEST

START_TEST(test_budget) {
  rig r;
  open_moody(&r, 1);
  r.setup.limits.step_time = 100e-6;
  rig_post(&r);
  ethd_sense s = ordinary(&r);
  s.step_ns = 99999;
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  expect_event(&r, ETHD_EVENT_TAKEN, 0, 0);
  s.step_ns = 100001;
  rig_try(&r, &s);
  expect_safe(&r, ETHD_E_BUDGET, ETHD_FAULT_BUDGET);
  expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_BUDGET, 100001);
  rig_close(&r);
}
END_TEST

/* The rate limit holds back no fault's zero. */
START_TEST(test_fault_is_quicker_than_the_rate_limit) {
  rig r;
  open_moody(&r, 1);
  ethd_sense s = ordinary(&r);
  r.setup.limits.torque_rate = 1;
  rig_post(&r);
  for (int i = 0; i < 100; i++) rig_try(&r, &s);
  ck_assert_double_gt(fabs(r.command.torque[0]), 0.05);
  mood.contact = FAIL;
  rig_try(&r, &s);
  expect_safe(&r, ETHD_E_LAW, ETHD_FAULT_LAW);
  mood.contact = WELL;
  rig_try(&r, &s);
  expect_safe(&r, ETHD_E_LAW, ETHD_FAULT_LAW);
  rig_close(&r);
}
END_TEST

/* ---- latched ---- */

START_TEST(test_latched_until_cleared) {
  rig r;
  ethd_counters c;
  open_moody(&r, 1);
  ethd_sense s = ordinary(&r);
  rig_try(&r, &s);
  double before[2] = {r.command.torque[0], r.command.torque[1]};
  ethd_control_clear(r.control); /* nothing to acknowledge: means nothing */
  rig_try(&r, &s);
  ck_assert_mem_eq(r.command.torque, before, sizeof before);
  mood.tracking = FAIL;
  rig_try(&r, &s);
  mood.tracking = WELL;
  for (int tick = 0; tick < 10; tick++) {
    rig_try(&r, &s);
    expect_safe(&r, ETHD_E_LAW, ETHD_FAULT_LAW);
    ck_assert(r.trace.x[0] == 0.249 || fabs(r.trace.x[0] - 0.249) < 1e-12); /* the estimators go on */
  }
  expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_LAW, 16);
  ck_assert_int_eq(rig_poll(&r).kind, 0); /* said once */
  ethd_control_counters(r.control, &c);
  ck_assert_uint_eq(c.faults[ETHD_FAULT_LAW], 1);
  /* softly from zero, in swap_time */
  ethd_control_clear(r.control);
  for (int tick = 0; tick <= 22; tick++) {
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    double share = tick < 20 ? tick / 20.0 : 1;
    ck_assert_double_eq_tol(r.command.torque[0], share * before[0], 1e-12);
    ck_assert_double_eq_tol(r.command.torque[1], share * before[1], 1e-12);
    ck_assert(r.command.safe == 0 && r.trace.fault == 0);
  }
  expect_event(&r, ETHD_EVENT_CLEARED, 0, 0);
  ck_assert_int_eq(rig_poll(&r).kind, 0);
  rig_close(&r);
}
END_TEST

/* Cleared while it lasts: it comes back at once. */
START_TEST(test_cleared_too_early) {
  rig r;
  open_moody(&r, 1);
  ethd_sense s = ordinary(&r);
  mood.contact = FAIL;
  for (int i = 0; i < 2; i++) {
    rig_try(&r, &s);
    expect_safe(&r, ETHD_E_LAW, ETHD_FAULT_LAW);
    expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_LAW, 116);
    ethd_control_clear(r.control);
    rig_try(&r, &s);
    expect_safe(&r, ETHD_E_LAW, ETHD_FAULT_LAW);
    expect_event(&r, ETHD_EVENT_CLEARED, 0, 0);
    expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_LAW, 116);
    ethd_control_clear(r.control);
    mood.contact = WELL;
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    expect_event(&r, ETHD_EVENT_CLEARED, 0, 0);
    mood.contact = FAIL;
  }
  rig_close(&r);
}
END_TEST

/* A setup posted while a fault is latched is taken; the fault stays until it is cleared. */
START_TEST(test_post_during_a_fault) {
  rig r;
  open_moody(&r, 1);
  ethd_sense s = ordinary(&r);
  mood.transition = FAIL;
  rig_try(&r, &s);
  (void)rig_poll(&r);
  ethd_setup_transition(&r.setup, &ethd_transition_smooth);
  rig_post(&r);
  rig_try(&r, &s);
  expect_safe(&r, ETHD_E_LAW, ETHD_FAULT_LAW);
  ck_assert_int_eq(r.trace.swap, 1);
  expect_event(&r, ETHD_EVENT_TAKEN, 0, 0);
  ethd_setup_tracking(&r.setup, &ethd_tracking_pd);
  rig_post(&r);
  ethd_control_clear(r.control); /* both at one tick: softly into the new one */
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  ck_assert(r.trace.swap == 1 && r.command.torque[0] == 0);
  expect_event(&r, ETHD_EVENT_CLEARED, 0, 0);
  expect_event(&r, ETHD_EVENT_TAKEN, 0, 0);
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
END_TEST

/* After it, contacts begin anew: braking, not the wall of before. */
START_TEST(test_contacts_begin_anew) {
  rig r;
  open_moody(&r, 1);
  ethd_setup_transition(&r.setup, &ethd_transition_offset);
  rig_post(&r);
  ethd_sense s = ordinary(&r);
  for (int i = 0; i < 3; i++) rig_try(&r, &s);
  ck_assert_int_eq(r.trace.state, ETHD_VO);
  mood.contact = FAIL;
  rig_try(&r, &s);
  mood.contact = WELL;
  ethd_control_clear(r.control);
  rig_try(&r, &s);
  ck_assert_int_eq(r.trace.state, ETHD_BRAKING);
  rig_close(&r);
}
END_TEST

/* Speeds are right when the fault is over, because the estimator never stopped. */
START_TEST(test_estimators_go_on) {
  rig r, healthy;
  open_moody(&r, 1);
  open_moody(&healthy, 1);
  for (int tick = 0; tick < 60; tick++) {
    motion m = rig_at(0.010 + 1e-6 * tick * tick, 0, 0.001);
    ethd_sense s = rig_sense(&r.setup.arm, &m);
    s.have = ETHD_HAVE_FINGER;
    mood.tracking = tick == 20 ? FAIL : WELL;
    if (tick == 50) ethd_control_clear(r.control);
    rig_try(&r, &s);
    mood.tracking = WELL;
    rig_try(&healthy, &s);
    ck_assert_mem_eq(r.trace.v, healthy.trace.v, sizeof r.trace.v);
  }
  ck_assert_int_eq(r.status, ETHD_OK);
  rig_close(&healthy);
  rig_close(&r);
}
END_TEST

/* Ticks without a measurement are missed ones for whatever comes next: no speed is too high after them. */
START_TEST(test_gap_of_measurements) {
  rig r, missing;
  open_moody(&r, 0);
  open_moody(&missing, 0);
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
      expect_safe(&r, ETHD_E_NOT_FINITE, ETHD_FAULT_INPUT);
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
END_TEST

/* A law that fails just when it is to be replaced costs the estimators no sample either. */
START_TEST(test_failure_at_a_swap) {
  rig r;
  open_moody(&r, 0);
  ethd_setup_velocity(&r.setup, ETHD_VELOCITY_DIFFERENCE);
  rig_post(&r);
  for (int tick = 0; tick < 30; tick++) {
    motion m = rig_at(-0.001 - 2e-4 * tick, 0.2, 0.001);
    ethd_sense s = rig_sense(&r.setup.arm, &m);
    s.have = ETHD_HAVE_FINGER;
    if (tick == 20) {
      mood.contact = FAIL;
      ethd_setup_contact(&r.setup, &ethd_contact_spring);
      rig_post(&r);
    }
    rig_try(&r, &s);
    if (tick == 20) expect_safe(&r, ETHD_E_LAW, ETHD_FAULT_LAW);
    else ck_assert_int_eq(r.status, ETHD_OK);
    if (tick > 0) ck_assert_double_eq_tol(r.trace.v[0], -0.2, 1e-3);
  }
  rig_close(&r);
}
END_TEST

/* Angles out of all measure spoil a speed for ever, unless a clear heals it. */
START_TEST(test_absurd_angle) {
  rig r;
  open_moody(&r, 1);
  r.setup.limits.speed = 10;
  rig_post(&r);
  ethd_sense s = ordinary(&r), absurd;
  s.have = ETHD_HAVE_FINGER;
  rig_try(&r, &s);
  absurd = s;
  absurd.q[0] = 1e308;
  rig_try(&r, &absurd);
  ck_assert_int_lt(r.status, 0);
  rig_try(&r, &s);
  ck_assert(!isfinite(r.trace.qd[0]));
  ethd_control_clear(r.control);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  for (int i = 0; i < 3; i++) ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  ck_assert_double_eq(r.trace.qd[0], 0);
  rig_close(&r);
}
END_TEST

/* Without latch each tick is judged alone: the one after is as if nothing had been. */
START_TEST(test_without_latch) {
  rig r, healthy;
  open_moody(&r, 0);
  open_moody(&healthy, 0);
  ethd_sense s = ordinary(&r);
  ethd_counters c;
  for (int tick = 0; tick < 30; tick++) {
    mood.transition = tick % 3 == 2 ? FAIL : WELL;
    rig_try(&r, &s);
    if (tick % 3 == 2) {
      expect_safe(&r, ETHD_E_LAW, ETHD_FAULT_LAW);
      expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_LAW, 216);
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
END_TEST

/* ---- the guard's stops, through the controller ---- */

/* Too fast: damped by 20 Ns/m at once, whatever the rate limit; still: nothing, and only then safe. */
START_TEST(test_speed) {
  rig r;
  open_moody(&r, 1);
  r.setup.limits.speed = 0.5;
  r.setup.limits.torque_rate = 1e-3;
  rig_post(&r);
  motion m = rig_at(0.020, 0.4, 0);
  ethd_sense s = rig_sense(&r.setup.arm, &m);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  m = rig_at(0.020, 0.6, 0); /* F = +12 N in x */
  s = rig_sense(&r.setup.arm, &m);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_E_RANGE);
  ck_assert_double_eq_tol(r.command.torque[0], -12 * 0.25, 0.01); /* dx/dq1 = -y = -0.25 m */
  ck_assert(r.command.safe == 0 && r.trace.guard == ETHD_GUARD_SPEED && r.trace.fault == ETHD_FAULT_SPEED);
  double first = r.command.torque[0];
  m = rig_at(0.020, 0.3, 0); /* slower than the limit, and still stopping */
  s = rig_sense(&r.setup.arm, &m);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_E_RANGE);
  ck_assert_double_eq_tol(r.command.torque[0], first / 2, 1e-12);
  m = rig_at(0.020, 0.019, 0);
  s = rig_sense(&r.setup.arm, &m);
  rig_try(&r, &s);
  expect_safe(&r, ETHD_E_RANGE, ETHD_FAULT_SPEED);
  m = rig_at(0.020, 0.3, 0); /* moved by hand: nothing any more */
  s = rig_sense(&r.setup.arm, &m);
  rig_try(&r, &s);
  expect_safe(&r, ETHD_E_RANGE, ETHD_FAULT_SPEED);
  expect_event(&r, ETHD_EVENT_TAKEN, 0, 0);
  expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_SPEED, NAN);
  ethd_control_clear(r.control);
  m = rig_at(0.020, 0.3, 0.001);
  s = rig_sense(&r.setup.arm, &m);
  for (int i = 0; i < 300; i++) ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  ck_assert_double_eq_tol(r.command.torque[0], 299e-6, 1e-12); /* follows again, at the rate's pace */
  rig_close(&r);
}
END_TEST

START_TEST(test_workspace) {
  rig r;
  open_moody(&r, 0);
  r.setup.limits.workspace[0] = 0.24;
  rig_post(&r);
  motion m = rig_at(-0.009, 0.1, 0);
  ethd_sense s = rig_sense(&r.setup.arm, &m);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  m = rig_at(-0.0101, 0.1, 0);
  s = rig_sense(&r.setup.arm, &m);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_E_RANGE);
  ck_assert(r.trace.fault == ETHD_FAULT_WORKSPACE && r.trace.guard == ETHD_GUARD_WORKSPACE);
  ck_assert_double_lt(r.command.torque[0], 0); /* against the motion */
  m = rig_at(-0.009, 0.1, 0);
  s = rig_sense(&r.setup.arm, &m);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  rig_close(&r);
}
END_TEST

START_TEST(test_sentences) {
  for (int i = 0; i < ETHD_FAULT_COUNT; i++)
    for (int j = 0; j < i; j++)
      ck_assert_str_ne(ethd_fault_sentence((ethd_fault)i), ethd_fault_sentence((ethd_fault)j));
  ck_assert_str_eq(ethd_fault_sentence((ethd_fault)-1), "an unknown fault");
  ck_assert_str_eq(ethd_fault_sentence(ETHD_FAULT_COUNT), "an unknown fault");
}
END_TEST

int main(void) {
  Suite *suite = suite_create("faults");
  TCase *t = tcase_create("faults");
  tcase_add_loop_test(t, test_input, 0, sizeof bad_inputs / sizeof *bad_inputs);
  tcase_add_test(t, test_fields_that_are_not_there);
  tcase_add_loop_test(t, test_law_fails, 0, 3);
  tcase_add_loop_test(t, test_law_says_nonsense, 0, sizeof bad_outputs / sizeof *bad_outputs);
  tcase_add_test(t, test_sum_overflows);
  tcase_add_test(t, test_budget);
  tcase_add_test(t, test_fault_is_quicker_than_the_rate_limit);
  tcase_add_test(t, test_latched_until_cleared);
  tcase_add_test(t, test_cleared_too_early);
  tcase_add_test(t, test_post_during_a_fault);
  tcase_add_test(t, test_contacts_begin_anew);
  tcase_add_test(t, test_estimators_go_on);
  tcase_add_test(t, test_gap_of_measurements);
  tcase_add_test(t, test_failure_at_a_swap);
  tcase_add_test(t, test_absurd_angle);
  tcase_add_test(t, test_without_latch);
  tcase_add_test(t, test_speed);
  tcase_add_test(t, test_workspace);
  tcase_add_test(t, test_sentences);
  suite_add_tcase(suite, t);
  return rig_run(suite);
}
