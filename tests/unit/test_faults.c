/* Faults: what causes each, what it says, and that the torque is zero at once. */
#include <math.h>
#include <string.h>

#include "unit/moody.h"

/* What the sense doesn't claim to have isn't looked at. */
TEST(test_fields_that_are_not_there) {
  rig r;
  moody_open(&r, 1);
  ethd_sense s = moody_sense(&r);
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

TEST_LOOP(test_law_fails, 0, 3) {
  int *const moods[] = {&mood.tracking, &mood.contact, &mood.transition};
  rig r;
  moody_open(&r, 1);
  ethd_sense s = moody_sense(&r);
  *moods[_i] = MOODY_POSITIVE;
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  *moods[_i] = MOODY_FAIL;
  rig_try(&r, &s);
  moody_expect_safe(&r, ETHD_E_LAW, ETHD_FAULT_LAW);
  moody_expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_LAW, 100 * _i + 16);
  rig_close(&r);
}

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
    {ETHD_TRANSITION, offsetof(ethd_ruling, lead), NAN},
    {ETHD_TRANSITION, offsetof(ethd_ruling, lead), INFINITY},
    {ETHD_TRANSITION, offsetof(ethd_ruling, speed), NAN},
    {ETHD_TRANSITION, offsetof(ethd_ruling, speed), -INFINITY},
    {ETHD_TRANSITION, offsetof(ethd_ruling, argument), NAN},
};

TEST_LOOP(test_law_says_nonsense, 0, sizeof bad_outputs / sizeof *bad_outputs) {
  rig r;
  moody_open(&r, 1);
  ethd_sense s = moody_sense(&r);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  mood.field = bad_outputs[_i].field;
  mood.value = bad_outputs[_i].value;
  *(bad_outputs[_i].kind == ETHD_TRACKING  ? &mood.tracking
    : bad_outputs[_i].kind == ETHD_CONTACT ? &mood.contact
                                           : &mood.transition) = MOODY_BAD;
  rig_try(&r, &s);
  moody_expect_safe(&r, ETHD_E_NOT_FINITE, ETHD_FAULT_FINITE);
  moody_expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_FINITE, bad_outputs[_i].kind);
  rig_close(&r);
}

/* Each number finite, their sum not: the guard's matter. */
TEST(test_sum_overflows) {
  rig r;
  moody_open(&r, 1);
  ethd_scene *old = r.scene;
  r.setup.scene = r.scene = rig_scene("halfplane -1 0 -0.5\n");
  rig_post(&r);
  ethd_sense s = moody_sense(&r);
  s.q[0] = 0.8, s.q[1] = -0.6; /* dx/dq2 = 0.141 m: the force has a share in joint 2 */
  mood.tracking = MOODY_BAD;
  mood.value = 1.7e308;
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  mood.transition = MOODY_BAD;
  mood.field = offsetof(ethd_ruling, feed);
  mood.tracking = MOODY_WELL;
  mood.value = -1.7e308;
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  mood.tracking = MOODY_BAD; /* both at once */
  s.q[1] = 0.6;              /* dx/dq2 = -0.141 m and F = +1.79e308 N: two negative torques */
  mood.value = -1.79e308;
  rig_try(&r, &s);
  moody_expect_safe(&r, ETHD_E_NOT_FINITE, ETHD_FAULT_FINITE);
  ck_assert_int_eq(r.trace.guard, ETHD_GUARD_FINITE);
  ethd_scene_destroy(old);
  rig_close(&r);
}

TEST(test_budget) {
  rig r;
  moody_open(&r, 1);
  r.setup.limits.step_time = 1e-9 * 100000;
  rig_post(&r);
  ethd_sense s = moody_sense(&r);
  s.step_ns = 100000; /* the limit itself is in time */
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  moody_expect_event(&r, ETHD_EVENT_TAKEN, 0, 0);
  s.step_ns = 100001;
  rig_try(&r, &s);
  moody_expect_safe(&r, ETHD_E_BUDGET, ETHD_FAULT_BUDGET);
  moody_expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_BUDGET, 100001);
  rig_close(&r);
}

TEST(test_sentences) {
  for (int i = 0; i < ETHD_FAULT_COUNT; i++)
    for (int j = 0; j < i; j++)
      ck_assert_str_ne(ethd_fault_sentence((ethd_fault)i), ethd_fault_sentence((ethd_fault)j));
  ck_assert_str_eq(ethd_fault_sentence((ethd_fault)-1), "an unknown fault");
  ck_assert_str_eq(ethd_fault_sentence(ETHD_FAULT_COUNT), "an unknown fault");
}
