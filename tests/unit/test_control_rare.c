/* What a controller meets rarely: two contacts that become one, more of them than there is room for, laws handed over
   in a tick that may not push, readings after gaps that no loop has, a stop that turns one joint alone. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "unit/rig.h"

static motion at(double x, double y) { return (motion){{x, y}, {0, 0}, {x, y}, {0, 0}}; }

static uint64_t lost(const rig *r) {
  ethd_counters c;
  ethd_control_counters(r->control, &c);
  return c.contacts_lost;
}

/* ---- contacts ---- */

/* In a concave corner of one polygon, two; from far beyond the corner's point both lead to the same touch. */
TEST(test_two_become_one) {
  rig r;
  rig_begin(&r, "polygon 0 0 0.6 0 0.6 0.238 0.238 0.238 0.238 0.6 0 0.6\n", &ethd_transition_smooth);
  motion m = at(0.249, 0.249);
  ck_assert_int_eq(rig_step(&r, &m)->contacts, 2);
  m = at(0.1, 0.1); /* inside a solid there is one contact */
  const ethd_trace *t = rig_step(&r, &m);
  ck_assert_int_eq(t->contacts, 1);
  m = at(0.249, 0.249);
  ck_assert_int_eq(rig_step(&r, &m)->contacts, 2);
  rig_close(&r);
}

/* Near but transparent, then far away: nothing is lost that pushed. */
TEST(test_ends_transparent) {
  rig r;
  rig_begin(&r, RIG_WALL, &ethd_transition_offset);
  motion m = rig_at(0.001, 0.01, 0);
  const ethd_trace *t = rig_step(&r, &m);
  ck_assert(t->contacts == 1 && t->state == ETHD_TRANSPARENT);
  m = rig_at(0.1, 0, 0);
  ck_assert_int_eq(rig_step(&r, &m)->contacts, 0);
  ck_assert_uint_eq(lost(&r), 0);
  rig_close(&r);
}

/* Eight walls are met; then two more that are deeper, and two that are shallower and new: the deepest eight stay. */
TEST(test_newcomers_on_both_sides) {
  char text[2048];
  size_t n = 0;
  for (int i = 0; i < 8; i++)
    n += (size_t)snprintf(text + n, sizeof text - n, "halfplane -1 0 %.17g\n", -0.238 + 1e-4 * i);
  snprintf(text + n, sizeof text - n,
           "halfplane 0 1 0.2592\nhalfplane 0 1 0.2591\nhalfplane 0 1 0.2606\nhalfplane 0 1 0.2607\n");
  rig r;
  rig_begin(&r, text, &ethd_transition_smooth);
  motion m = at(0.249, 0.24); /* 1 mm to 0.3 mm deep in eight, far from the others */
  const ethd_trace *t = rig_step(&r, &m);
  ck_assert(t->contacts == 8 && t->overflow == 0);
  m = at(0.249, 0.2486); /* 1.4 and 1.5 mm deep in two; on and 0.1 mm before the last two */
  t = rig_step(&r, &m);
  ck_assert(t->contacts == 8 && t->overflow == 4 && t->object == 9);
  ck_assert_double_eq_tol(t->fe[1], -2500 * (0.0014 + 0.0015), 1e-9);
  ck_assert_double_eq_tol(t->fe[0], 2500 * (6 * 0.001 - 1e-4 * (5 * 6 / 2)), 1e-9);
  rig_close(&r);
}

/* ---- swaps ---- */

/* In the wall, at a tick that can't be measured: the new law begins anew, and does its work at the next. */
TEST(test_swap_without_measurement) {
  rig r;
  rig_begin(&r, RIG_WALL, &ethd_transition_smooth);
  r.setup.limits.latch = 0;
  rig_post(&r);
  motion m = rig_at(-0.002, 0, 0);
  rig_step(&r, &m);
  ethd_setup_transition(&r.setup, &ethd_transition_offset);
  rig_post(&r);
  ethd_sense s = rig_sense(&r.setup.arm, &m);
  s.q[0] = NAN;
  ck_assert_int_lt(rig_try(&r, &s), 0);
  ck_assert(r.command.torque[0] == 0 && r.trace.swap == 1);
  const ethd_trace *t = rig_step(&r, &m);
  ck_assert(t->contacts == 1 && t->fault == 0);
  rig_close(&r);
}

/* A law that was built before laws could adopt: in the wall it begins as on a new contact. */
TEST(test_swap_to_an_older_law) {
  ethd_transition_law old = ethd_transition_offset;
  old.law.size = ETHD_TRANSITION_LAW_MIN;
  rig r, other;
  rig_begin(&r, RIG_WALL, &ethd_transition_smooth);
  rig_begin(&other, RIG_WALL, &ethd_transition_smooth);
  motion m = rig_at(-0.002, 0, 0);
  rig_step(&r, &m);
  rig_step(&other, &m);
  ethd_setup_transition(&r.setup, &old);
  ethd_setup_transition(&other.setup, &ethd_transition_offset);
  rig_post(&r);
  rig_post(&other);
  rig_step(&r, &m);
  rig_step(&other, &m);
  ck_assert(other.trace.state == ETHD_VO && other.trace.eps == 0); /* keeps the wall that it stands in */
  ck_assert(r.trace.state != ETHD_VO || r.trace.eps != 0);
  rig_close(&r);
  rig_close(&other);
}

/* ---- limits ---- */

TEST(test_reach) {
  rig r;
  rig_open(&r, NULL);
  r.setup.limits.reach[0] = 0.3;
  r.setup.limits.reach[1] = 0.4;
  r.setup.limits.margin = 0;
  rig_start(&r);
  for (int i = 0; i < 3; i++) {
    const double radius[] = {0.35, 0.29, 0.41};
    motion m = at(radius[i] * 0.8, radius[i] * 0.6);
    ethd_sense s = rig_sense(&r.setup.arm, &m);
    ethd_control_reset(r.control);
    ethd_status status = rig_try(&r, &s);
    ck_assert(i ? status < 0 && r.trace.fault == ETHD_FAULT_WORKSPACE : status == ETHD_OK);
  }
  rig_close(&r);
}

/* At the base itself a wall of the reach has no direction to push in. */
TEST(test_wall_at_the_base) {
  const ethd_pose pose = {{0, 0}, {0.25, 0, 0, 0.25}, {4, 0, 0, 4}};
  ethd_limits l = ethd_limits_none();
  ethd_guard_state s;
  memset(&s, 0, sizeof s);
  l.reach[0] = 0.1;
  l.margin = 0.05;
  double tau[2] = {0.1, -0.2};
  const ethd_guard_device device = {.link = {0.25, 0.25}, .stiffness = 500, .damping = 10, .period = 0.001};
  const ethd_guard_motion there = {.pose = &pose, .dt = 0.001};
  ethd_guard_step(&l, &device, &s, &there, tau);
  ck_assert(tau[0] == 0.1 && tau[1] == -0.2);
}

/* The stop needs no torque of joint 1 when that joint stands still: not safe while joint 2 brakes. */
TEST(test_stop_of_one_joint) {
  rig r;
  rig_open(&r, NULL);
  r.setup.arm = (ethd_arm){ETHD_ARM_PARALLEL, 0.25, 0.25};
  rig_start(&r);
  ethd_sense s = {.have = ETHD_HAVE_DQ, .q = {0, 1}, .dq = {0, 1}};
  s.faults = ETHD_FAULT_BIT(ETHD_FAULT_FINGER_LOST);
  s.grave = s.faults;
  ck_assert_int_lt(rig_try(&r, &s), 0);
  ck_assert_double_le(fabs(r.command.torque[0]), 1e-17);
  ck_assert(r.command.torque[1] != 0 && r.command.safe == 0);
  rig_close(&r);
}

/* ---- readings ---- */

/* Ticks that say that a million periods were missed, with a reading each: whatever the filter makes of it, ring and
   finger stay numbers, and the torque is one. */
TEST_LOOP(test_gaps_without_end, 0, ETHD_FILTER_COUNT) {
  rig r;
  rig_open(&r, RIG_WALL);
  ethd_setup_filter(&r.setup, (ethd_filter_method)_i);
  rig_start(&r);
  motion m = rig_at(0.02, 0, 0);
  for (int i = 0; i < 3000; i++) {
    ethd_sense s = rig_sense(&r.setup.arm, &m);
    s.have = (s.have & ETHD_HAVE_DQ) | ETHD_HAVE_CENTRE;
    s.centre[0] = i % 2 ? 0.004 : -0.004;
    s.centre[1] = 0;
    s.missed = i < 2900 ? 1000000 : 0;
    s.time_ns = s.sample_ns = 1000000 * (int64_t)(i + 1);
    rig_try(&r, &s);
    ck_assert(isfinite(r.trace.xf[0]) && isfinite(r.trace.vf[1]) && isfinite(r.command.torque[0]));
  }
  ck_assert_int_eq(r.trace.fault, 0);
  rig_close(&r);
}
