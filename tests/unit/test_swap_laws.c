/* What a law finds when it takes over, and what of its own it finds again: state, contact, estimators, the
   side of a wall it is on. */
#include <math.h>
#include <string.h>

#include "unit/rig.h"

static const ethd_trace *swap_to(rig *r, const ethd_transition_law *law, const motion *m) {
  ethd_setup_transition(&r->setup, law);
  rig_post(r);
  return rig_step(r, m);
}

/* Into VO-B inside the wall: a ring at rest keeps the wall that it stands in, a moving one is braked; then one arrow a
   tick as ever. Out of it eps is forgotten and doesn't come back. */
TEST(test_into_offset_and_out) {
  rig r;
  rig_begin(&r, RIG_WALL, &ethd_transition_smooth);
  motion m = rig_at(-0.002, 0, 0);
  ck_assert_int_eq(rig_step(&r, &m)->state, ETHD_VO);
  const ethd_trace *t = swap_to(&r, &ethd_transition_offset, &m);
  ck_assert(t->state == ETHD_VO && t->eps == 0 && fabs(t->fe[0] - 5) < 1e-10);
  swap_to(&r, &ethd_transition_smooth, &m);
  m = rig_at(-0.002, 0.1, 0);
  rig_step(&r, &m);
  t = swap_to(&r, &ethd_transition_offset, &m);
  ck_assert(t->state == ETHD_BRAKING && t->eps == 0 && fabs(t->fd[0] - 10) < 1e-10);
  m = rig_at(-0.002, 0, 0);
  t = rig_step(&r, &m);
  ck_assert(t->state == ETHD_VO && fabs(t->eps - 0.002) < 1e-15);
  t = swap_to(&r, &ethd_transition_smooth, &m);
  ck_assert(t->state == ETHD_VO && t->eps == 0 && fabs(t->fe[0] - 5) < 1e-10);
  t = swap_to(&r, &ethd_transition_offset, &m);
  ck_assert(t->state == ETHD_VO && t->eps == 0);
  /* outside of the wall it starts transparent */
  t = swap_to(&r, &ethd_transition_abrupt, &m);
  m = rig_at(0.001, 0.1, 0);
  ck_assert_int_eq(swap_to(&r, &ethd_transition_offset, &m)->state, ETHD_TRANSPARENT);
  rig_close(&r);
}

static ethd_past past;

static void look_back(const double *p, void *state, const ethd_past *was) ETHD_RT {
  (void)p, (void)state;
  past = *was;
}

/* What a law is told of the contact that it takes over. */
TEST(test_past) {
  static ethd_transition_law looking;
  looking = ethd_transition_smooth;
  looking.law.id = "looking";
  looking.adopt = look_back;
  rig r;
  rig_begin(&r, RIG_WALL, &ethd_transition_abrupt);
  motion m = rig_at(0.001, 0.2, 0);
  for (int i = 0; i < 4; i++) rig_step(&r, &m);
  ck_assert_int_eq(r.trace.state, ETHD_TRANSPARENT);
  m = rig_at(-0.002, 0.1, 0);
  for (int i = 0; i < 3; i++) rig_step(&r, &m);
  ck_assert_int_eq(r.trace.state, ETHD_VO);
  swap_to(&r, &looking, &m);
  ck_assert_int_eq(past.state, ETHD_VO);
  ck_assert_double_eq_tol(past.age, 0.008, 1e-12);
  ck_assert_double_eq_tol(past.since, 0.004, 1e-12);
  ck_assert_double_eq_tol(past.d_re, -0.002, 1e-12);
  ck_assert_double_eq_tol(past.v, 0.1, 1e-12);
  ck_assert(past.offset == 0);
  rig_close(&r);
}

/* Other gains for the same law: its state stays. */
TEST(test_same_law_keeps_its_state) {
  rig r;
  rig_begin(&r, RIG_WALL, NULL);
  motion m = rig_at(-0.002, 0.3, 0);
  rig_step(&r, &m);
  r.setup.transition_p[0] = 50;
  rig_post(&r);
  const ethd_trace *t = rig_step(&r, &m);
  ck_assert(t->state == ETHD_BRAKING && fabs(t->fd[0] - 15) < 1e-10);
  m = rig_at(-0.002, 0, 0);
  rig_step(&r, &m);
  r.setup.contact_p[0] = 1000;
  rig_post(&r);
  m = rig_at(-0.003, 0, 0);
  t = rig_step(&r, &m);
  ck_assert(t->state == ETHD_VO && fabs(t->eps - 0.002) < 1e-15 && fabs(t->fe[0] - 1) < 1e-10);
  rig_close(&r);
}

/* A force that grows with every step of the contact, to see whose state is whose. */
static ethd_status growing_step(const double *p, void *state, double gap, double speed, int entering,
                                double *force) ETHD_RT {
  (void)p, (void)gap, (void)speed, (void)entering;
  *force = -++*(double *)state;
  return ETHD_OK;
}

#define GROWING                                                                                            \
  {.law = {sizeof(ethd_contact_law), ETHD_ABI, ETHD_CONTACT, 8, "growing", "counts", NULL, 0, NULL, NULL}, \
   .step = growing_step}
static const ethd_contact_law growing = GROWING, growing_too = GROWING;

TEST(test_state_of_other_laws) {
  rig r;
  rig_open(&r, RIG_WALL);
  ethd_setup_transition(&r.setup, &ethd_transition_smooth);
  ethd_setup_contact(&r.setup, &growing);
  const double difference[] = {0, 1, 1}; /* b_t alone, on the difference of eps_q */
  memcpy(r.setup.tracking_p, difference, sizeof difference);
  rig_start(&r);
  motion m = rig_at(-0.001, 0, 0.001);
  for (int i = 1; i <= 5; i++) ck_assert_double_eq_tol(rig_step(&r, &m)->fe[0], i, 1e-12);
  rig_post(&r); /* neither law changes: counting goes on, and eps_q of the last tick is known */
  m = rig_at(-0.001, 0, 0.002);
  const ethd_trace *t = rig_step(&r, &m);
  ck_assert_double_eq_tol(t->fe[0], 6, 1e-12);
  ck_assert_double_eq_tol(t->tau[0], 0.64 * 4 - 0.25 * 6, 1e-3);
  ck_assert_double_eq_tol(rig_step(&r, &m)->tau[0], -0.25 * 7, 1e-4); /* nothing fades */
  r.setup.contact = &growing_too;
  rig_post(&r);
  ck_assert_double_eq_tol(rig_step(&r, &m)->fe[0], 1, 1e-12);
  rig_close(&r);
}

/* A new estimator goes on from where the old one was: at a steady speed nothing is to be seen. */
TEST(test_estimators_go_on) {
  rig r;
  rig_open(&r, NULL);
  r.setup.tracking_p[0] = r.setup.tracking_p[1] = 0; /* no torque: the motion is scripted */
  rig_start(&r);
  for (int tick = 0; tick < 2000; tick++) {
    ethd_sense s;
    memset(&s, 0, sizeof s);
    double t = 0.001 * tick;
    s.time_ns = s.sample_ns = 1000000 * (int64_t)tick;
    s.q[0] = 1.2 + 0.25 * t;
    s.q[1] = -0.1 + 0.25 * t;
    s.have = ETHD_HAVE_CENTRE | ETHD_HAVE_RING; /* the finger in R_0: 0.2 m/s along x */
    s.ring[0] = 0.1 + 0.2 * t;
    s.centre[1] = 0.2;
    if (tick >= 500 && tick % 25 == 0) {
      ethd_setup_velocity(&r.setup, (ethd_velocity_method)(tick / 25 % ETHD_VELOCITY_COUNT));
      ethd_setup_filter(&r.setup, (ethd_filter_method)(tick / 25 % 2 ? ETHD_FILTER_CV : ETHD_FILTER_CA));
      rig_post(&r);
    }
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    if (tick >= 499) {
      for (int i = 0; i < 2; i++) ck_assert_double_eq_tol(r.trace.qd[i], 0.25, 2e-3);
      ck_assert_double_eq_tol(r.trace.vf[0], 0.2, 2e-3);
      ck_assert_double_eq_tol(r.trace.xf[0], 0.1 + 0.2 * t, 1e-5);
    }
    (void)rig_poll(&r);
  }
  rig_close(&r);
}

/* A thin wall that the ring has pulled itself through keeps its side, out of reach as well. */
TEST(test_thin_wall_keeps_its_side) {
  rig r;
  rig_begin(&r, "segment 0.238 0.1 0.238 0.4\n", &ethd_transition_smooth);
  motion m = rig_at(0.001, 0.1, 0);
  for (double d = 0.001; d > -0.05; d -= 0.005) {
    m = rig_at(d, 0.1, 0);
    rig_step(&r, &m);
  }
  const ethd_trace *t = swap_to(&r, &ethd_transition_offset, &m);
  ck_assert(t->contacts == 1 && t->state == ETHD_BRAKING && fabs(t->d_re - (m.x.x - 0.25)) < 1e-12);
  ck_assert_double_eq_tol(t->fd[0], 10, 1e-10); /* back to where it came from */
  rig_close(&r);
}

/* A soft start is a fade like any other. */
TEST(test_swap_in_a_soft_start) {
  rig r;
  rig_begin(&r, RIG_WALL, NULL);
  motion m = rig_at(-0.002, 0.01, 0.001);
  ethd_sense bad = rig_sense(&r.setup.arm, &m), s = bad;
  bad.q[0] = NAN;
  rig_step(&r, &m);
  rig_try(&r, &bad);
  ethd_control_acknowledge(r.control);
  for (int i = 0; i < 5; i++) rig_step(&r, &m);
  ethd_setup_transition(&r.setup, &ethd_transition_abrupt);
  rig_post(&r);
  ethd_command told;
  ck_assert_int_eq(ethd_control_rehearse(r.control, &s, &told), ETHD_OK);
  rig_step(&r, &m);
  ck_assert_mem_eq(told.torque, r.trace.tau, sizeof told.torque);
  rig_close(&r);
}
