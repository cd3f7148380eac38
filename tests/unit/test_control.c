/* Single ticks of the controller: stiffness felt, no wall that pulls, unknown fingers, missed ticks, late readings. The laws'
   equations: tests/replay.py. */
#include <math.h>
#include <string.h>

#include "unit/draw.h"
#include "unit/rig.h"

/* ---- by hand ---- */

/* Parallel arm at link angles 90 and 0 deg: J = ((-0.25, 0), (0, 0.25)), so F_x gives tau1 = -F_x / 4. */
TEST(test_stiffness_felt_in_x) {
  rig r;
  rig_begin(&r, NULL, NULL);
  motion m = {{0.25, 0.25}, {0, 0}, {0.251, 0.25}, {0, 0}};
  const ethd_trace *t = rig_step(&r, &m);
  /* K_t eps_q = 40 * -0.004: 640 N/m * 1 mm at the ring */
  ck_assert_double_eq_tol(t->tau[0], -0.16, 1e-12);
  ck_assert_double_eq_tol(t->tau[1], 0, 1e-12);
  rig_close(&r);
  /* serial, q2 = -90 deg: 1280 N/m */
  rig_open(&r, NULL);
  r.setup.arm.mechanism = ETHD_ARM_SERIAL;
  rig_start(&r);
  t = rig_step(&r, &m);
  ck_assert_double_eq_tol(t->eps_q[0], -0.004, 1e-12);
  ck_assert_double_eq_tol(t->eps_q[1], 0.004, 1e-12);
  /* F_x = -1.28 N presses with tau = J^T F, J = ((-0.25, 0), (0.25, 0.25)), and F_y = 0.64 N */
  ck_assert_double_eq_tol(t->tau[0], -0.16, 1e-12);
  ck_assert_double_eq_tol(t->tau[1], 0.16, 1e-12);
  rig_close(&r);
}

/* Whatever law, depth, speed: no wall pulls. */
TEST(test_never_attractive) {
  const ethd_contact_law *const laws[] = {&ethd_contact_kelvin_voigt, &ethd_contact_spring,
                                          &ethd_contact_hunt_crossley};
  int resting = 0;
  for (int law = 0; law < 3; law++) {
    rig r;
    rig_open(&r, RIG_WALL);
    ethd_setup_transition(&r.setup, &ethd_transition_smooth);
    ethd_setup_contact(&r.setup, laws[law]);
    r.setup.contact_p[1] = law == 2 ? 50 : 45;
    r.setup.v_hysteresis = 0.5;
    rig_start(&r);
    for (int tick = 0; tick < 2000; tick++) {
      uint64_t n = (uint64_t)(law * 4000 + tick);
      motion m = rig_at(draw(2 * n, -1e-3, 1e-3), draw(2 * n + 1, -0.6, 0.6), 0);
      const ethd_trace *t = rig_step(&r, &m);
      ck_assert(t->fe[0] >= 0); /* out is +x */
      resting += t->d_re < 0 && t->fe[0] == 0;
    }
    rig_close(&r);
  }
  ck_assert_int_gt(resting, 50); /* the cut was needed */
}

/* ---- where the finger is unknown, and time ---- */

TEST(test_no_finger_seen) {
  rig r;
  rig_begin(&r, RIG_WALL, NULL);
  motion m = rig_at(0.001, 0.2, 0.004);
  ethd_sense s = rig_sense(&r.setup.arm, &m);
  s.have = ETHD_HAVE_DQ;
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  const ethd_trace *t = &r.trace;
  ck_assert(t->tau[0] == 0 && t->tau[1] == 0 && isnan(t->rf));
  ck_assert_mem_eq(t->xf, t->x, sizeof t->x);
  ck_assert_mem_eq(t->vf, t->v, sizeof t->v);
  ck_assert_double_eq_tol(t->d_fe, 0.001, 1e-14); /* with R_r and the finger at the ring's centre */
  rig_close(&r);
}

/* A gap of whole periods is one longer step: speed, braking time, fade. */
TEST(test_missed_ticks) {
  rig r;
  rig_open(&r, RIG_WALL);
  ethd_setup_velocity(&r.setup, ETHD_VELOCITY_DIFFERENCE);
  rig_start(&r);
  motion m = rig_at(0, 0, 0);
  ethd_sense s = rig_sense(&r.setup.arm, &m);
  s.have = ETHD_HAVE_FINGER;
  rig_try(&r, &s);
  ck_assert(r.trace.v[0] == 0 && r.trace.v[1] == 0);
  double q = s.q[0];
  s.q[0] = q + 0.004; /* J = diag(-0.25, 0.25): 1 mm into the wall in 5 ms */
  s.missed = 4;
  rig_try(&r, &s);
  ck_assert_double_eq_tol(r.trace.qd[0], 0.8, 1e-9);
  ck_assert_double_eq_tol(r.trace.v_n, 0.2, 1e-5);
  ck_assert_int_eq(r.trace.state, ETHD_BRAKING);
  s.missed = 48;
  s.q[0] += 0.049 * 0.2;
  rig_try(&r, &s);
  ck_assert_int_eq(r.trace.state, ETHD_BRAKING);
  s.missed = 0;
  s.q[0] = q + 0.008; /* 50 ms after braking began, short of eps_max */
  rig_try(&r, &s);
  ck_assert_int_eq(r.trace.state, ETHD_VO);
  s.missed = -7;
  s.q[0] += 0.0004;
  rig_try(&r, &s);
  ck_assert_double_eq_tol(r.trace.qd[0], 0.4, 1e-9);
  rig_close(&r);
}

/* ---- readings of the finger ---- */

/* A reading is relative to where the ring stood when it was taken: between ticks linear, and a tick
   without measurement in between changes nothing. */
TEST(test_reading_in_the_past) {
  for (int with_gap = 0; with_gap < 2; with_gap++) {
    rig r;
    rig_open(&r, NULL);
    ethd_setup_filter(&r.setup, ETHD_FILTER_HOLD);
    r.setup.limits.latch = 0;
    rig_start(&r);
    ethd_sense s;
    for (int tick = 0; tick < 60; tick++) {
      motion m = {{0.2 + 1e-5 * tick * tick, 0.25}, {1, 0}, {0, 0}, {0, 0}};
      s = rig_sense(&r.setup.arm, &m);
      s.time_ns = 1000000 * (int64_t)tick;
      s.have = ETHD_HAVE_DQ;
      if (with_gap && tick == 56) s.q[0] = NAN;
      if (tick == 10 || tick == 59) s.have |= ETHD_HAVE_CENTRE;
      s.sample_ns = tick == 10 ? s.time_ns + 1 : 55250000; /* from the future: not used */
      s.centre[0] = 0.002;
      ck_assert_int_eq(rig_try(&r, &s), with_gap && tick == 56 ? ETHD_E_NOT_FINITE : ETHD_OK);
      if (tick == 10) ck_assert(r.trace.xf[0] == r.trace.x[0]);
    }
    double after = with_gap ? 57 : 56, share = 0.25 / (after - 55);
    double ring = 0.2 + 1e-5 * (55 * 55 + share * (after * after - 55 * 55));
    ck_assert_double_eq_tol(r.trace.xf[0], ring + 0.002, 1e-12);
    s.sample_ns = INT64_MIN; /* instants that can't be */
    s.time_ns = INT64_MAX;
    rig_try(&r, &s);
    ethd_counters c;
    ethd_control_counters(r.control, &c);
    ck_assert_uint_eq(c.readings_dropped, 2);
    rig_close(&r);
  }
}
