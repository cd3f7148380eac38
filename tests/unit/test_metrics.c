/* Metrics of taps made by hand: every expected value is read off the construction. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tap/metrics.h"
#include "unit/suite.h"

enum { COUNT = 300 };
static ethd_trace trace[COUNT];
static ethd_truth truth[COUNT];
static const ethd__tap_rows rows = {trace, truth, COUNT, COUNT};
static ethd__rule rule;

/* A ring that comes from the right at 0.2 m/s, meets x = 0.25 at tick 50 and stops at tick 60. */
static void setup(void) {
  memset(trace, 0, sizeof trace);
  memset(truth, 0, sizeof truth);
  rule = (ethd__rule){.n = {-1, 0}, .period = 1e-3, .speed = 0.2, .band = 0.06, .meet = -0.25, .d_beta = 1.5e-3};
  double x = 0.26;
  for (int i = 0; i < COUNT; i++) {
    double v = i < 60 ? 0.2 : 0;
    truth[i].t = i * 1e-3;
    truth[i].ring[0] = x;
    truth[i].ring_v[0] = -v;
    truth[i].motor_v[0] = -2 * v;
    truth[i].hand[0] = x;
    truth[i].pad = -1e-3;
    trace[i].d_re = i < 40 ? NAN : i < 50 ? 1e-3 : -1e-3;
    trace[i].state = ETHD_TRANSPARENT;
    x -= 1e-3 * v;
  }
}

static ethd__metrics measure(void) {
  ethd__metrics m;
  ethd__metrics_of(&rows, &rule, &m);
  return m;
}

static void touch_at(int tick) {
  for (int i = tick; i < COUNT; i++) truth[i].pad = 1e-4;
}

FIXTURE(setup, NULL)

TEST(test_meeting_and_touch) {
  touch_at(70);
  truth[70].ring_v[0] = 0.03; /* leaving */
  truth[75].ring_v[0] = 0.11;
  ethd__metrics m = measure();
  ck_assert_int_eq(m.reason, ETHD_TAP_OK);
  ck_assert_double_eq(m.t_rvo, 50 * 1e-3);
  ck_assert_double_eq(m.t_of, 70 * 1e-3);
  ck_assert_double_eq(m.v_rvo, 0.2);
  ck_assert_double_eq_tol(m.v_of, -0.03 * 10 / 11, 1e-15); /* the pad was 1 mm off, and is 0.1 mm in */
  ck_assert_double_eq(m.v_of_tick, -0.03);
  ck_assert_double_eq(m.v_rmin, -0.11);
  ck_assert(isnan(m.delta_s) && isnan(m.eps));
}

/* The pad comes to the ring a quarter of the way from tick 69 to 70. */
TEST(test_touch_between_ticks) {
  touch_at(70);
  truth[69].pad = -1e-4, truth[70].pad = 3e-4;
  truth[69].ring_v[0] = -0.08, truth[70].ring_v[0] = 0.04;
  ethd__metrics m = measure();
  ck_assert_double_eq_tol(m.v_of, 0.05, 1e-15);
  ck_assert_double_eq(m.v_of_tick, -0.04);
  truth[69].pad = NAN; /* nothing is known of the tick before */
  ck_assert_double_eq(measure().v_of, -0.04);
}

/* v_rmin is looked for after the touch, up to 0.1 s after it. */
TEST(test_window_of_the_smallest_speed) {
  touch_at(70);
  truth[70].ring_v[0] = 0.9;
  truth[171].ring_v[0] = 0.8;
  truth[170].ring_v[0] = 0.5;
  ck_assert_double_eq(measure().v_rmin, -0.5);
  truth[170].ring_v[0] = -0.1;
  ck_assert_double_eq(measure().v_rmin, -0.0);
}

/* Up to 1 mm deep, 0.08 mm of ripple, back by 0.4 mm, forth by 0.12 mm, further back; the motor twice as far. */
TEST(test_first_rebound) {
  const double depth[] = {0.2, 0.6, 0.52, 1.0, 0.99, 0.8, 0.6, 0.68, 0.6, 0.72, 0.1, 0.1};
  enum { N = sizeof depth / sizeof *depth };
  for (int i = 50; i < COUNT; i++) {
    truth[i].ring[0] = 0.25 - 1e-3 * depth[i - 50 < N ? i - 50 : N - 1];
    truth[i].motor[0] = 0.25 - 2e-3 * depth[i - 50 < N ? i - 50 : N - 1];
  }
  ck_assert_double_eq_tol(measure().d_max, 0.4e-3, 1e-12);
  ck_assert_double_eq(measure().d_max, measure().d_max_ring);
  rule.side = 1; /* forth by 0.16 mm is a rebound's end already */
  ck_assert_double_eq_tol(measure().d_max, 0.16e-3, 1e-12);
  ck_assert_double_eq_tol(measure().d_max_ring, 0.4e-3, 1e-12);
}

TEST(test_no_rebound) {
  ck_assert_double_eq(measure().d_max, 0);
  truth[COUNT - 1].ring[0] += 99e-6;
  ck_assert_double_eq(measure().d_max, 0);
  truth[COUNT - 1].ring[0] += 6e-6; /* turned back, and the tap ends there */
  ck_assert_double_eq_tol(measure().d_max, 0.105e-3, 1e-12);
}

/* Nine ticks of braking; the offset is the one of the first vo tick. */
TEST(test_braking) {
  for (int i = 50; i < COUNT; i++) trace[i].state = i < 59 ? ETHD_BRAKING : ETHD_VO;
  for (int i = 59; i < COUNT; i++) trace[i].eps = 1e-3 + i * 1e-6;
  ethd__metrics m = measure();
  ck_assert_double_eq(m.delta_s, 9);
  ck_assert_double_eq(m.eps, 1e-3 + 59 * 1e-6);
  for (int i = 59; i < COUNT; i++) trace[i].state = ETHD_BRAKING;
  m = measure();
  ck_assert(isnan(m.delta_s) && isnan(m.eps));
}

/* A law that brakes before the wall has an offset, but no time of braking from the wall on. */
TEST(test_braking_before_the_wall) {
  for (int i = 49; i < COUNT; i++) trace[i].state = i < 59 ? ETHD_BRAKING : ETHD_VO, trace[i].eps = 1e-3;
  ethd__metrics m = measure();
  ck_assert(isnan(m.delta_s));
  ck_assert_double_eq(m.eps, 1e-3);
}

/* A law without braking has neither, whatever its vo means. */
TEST(test_vo_without_braking) {
  for (int i = 50; i < COUNT; i++) trace[i].state = ETHD_VO;
  ck_assert(isnan(measure().delta_s));
}

TEST(test_reasons) {
  ck_assert_int_eq(measure().reason, ETHD_TAP_NO_CONTACT);
  touch_at(70);
  ck_assert_int_eq(measure().reason, ETHD_TAP_OK);
  rule.speed = 0.261;
  ck_assert_int_eq(measure().reason, ETHD_TAP_TOO_SLOW);
  rule.speed = 0.139;
  ck_assert_int_eq(measure().reason, ETHD_TAP_TOO_FAST);
  rule.never_fast = true;
  ck_assert_int_eq(measure().reason, ETHD_TAP_TOO_SLOW);
  rule.never_fast = false;
  truth[20].pad = 1e-6; /* a touch on the way */
  ck_assert_int_eq(measure().reason, ETHD_TAP_EARLY_CONTACT);
  trace[10].fault = ETHD_FAULT_LAW;
  ck_assert_int_eq(measure().reason, ETHD_TAP_FAULT);
}

/* Both are looked for only where the rule says so. */
TEST(test_grazing) {
  for (int i = 70; i < 79; i++) truth[i].pad = 1e-4;
  ck_assert_int_eq(measure().reason, ETHD_TAP_OK);
  rule.graze = 9.5e-3;
  ck_assert_int_eq(measure().reason, ETHD_TAP_GRAZING);
  truth[200].pad = 1e-4; /* ten ticks in all */
  ck_assert_int_eq(measure().reason, ETHD_TAP_OK);
}

/* The finger behind the wall from 70 on, out of it by 4 mm at 120, back at 140. */
TEST(test_double) {
  touch_at(70);
  for (int i = 0; i < COUNT; i++) truth[i].finger[0] = i < 70 || (i >= 120 && i < 140) ? 0.249 : 0.244;
  rule.seen = -0.245;
  ck_assert_int_eq(measure().reason, ETHD_TAP_OK);
  ck_assert_double_eq(measure().t_seen, 0.07);
  rule.single = true;
  rule.lift = 5e-3;
  ck_assert_int_eq(measure().reason, ETHD_TAP_OK);
  rule.lift = 3e-3;
  ck_assert_int_eq(measure().reason, ETHD_TAP_DOUBLE);
  for (int i = 140; i < COUNT; i++) truth[i].finger[0] = 0.249; /* left for good */
  ck_assert_int_eq(measure().reason, ETHD_TAP_OK);
}

TEST(test_never_seen) {
  touch_at(70);
  for (int i = 0; i < COUNT; i++) truth[i].finger[0] = 0.249;
  rule.seen = -0.245;
  ck_assert(isnan(measure().t_seen));
}

/* Touching at the very tick is no early contact. */
TEST(test_touch_as_the_wall_is_met) {
  touch_at(50);
  ethd__metrics m = measure();
  ck_assert_int_eq(m.reason, ETHD_TAP_OK);
  ck_assert_double_eq(m.t_of, m.t_rvo);
}

TEST(test_never_met) {
  for (int i = 0; i < COUNT; i++) trace[i].d_re = NAN;
  ethd__metrics m = measure();
  ck_assert_int_eq(m.reason, ETHD_TAP_NO_CONTACT);
  ck_assert(isnan(m.t_rvo) && isnan(m.v_rvo) && isnan(m.d_max) && isnan(m.t_of) && isnan(m.v_of));
}

TEST(test_motor_side) {
  rule.side = 1;
  rule.speed = 0.4;
  touch_at(55);
  ethd__metrics m = measure();
  ck_assert_int_eq(m.reason, ETHD_TAP_OK);
  ck_assert_double_eq(m.v_rvo, 0.4);
  ck_assert_double_eq_tol(m.v_of, 0.4, 1e-15);
}

TEST(test_peak_force) {
  trace[3].fe[0] = 3;
  trace[3].fe[1] = -4;
  trace[90].fe[0] = 4.9;
  ck_assert_double_eq(measure().peak_force, 5);
}

/* The ring starts in the wall with the finger resting there, bounces, and is taken away before the tap:
   what happens until ring and hand are both clear is not part of it. */
TEST(test_start_in_the_wall) {
  touch_at(70);
  for (int i = 0; i < 30; i++) {
    trace[i].d_re = i == 9 ? 2e-3 : i == 10 ? -1e-3 : i < 20 ? -4e-3 : 1e-3;
    truth[i].hand[0] = 0.245;
    truth[i].pad = 1e-4;
  }
  ethd__metrics m = measure();
  ck_assert_double_eq(m.t_rvo, 50 * 1e-3);
  ck_assert_int_eq(m.reason, ETHD_TAP_OK);
}

/* Outside, if only just: that is where the tap begins. */
TEST(test_start_close_to_the_wall) {
  for (int i = 0; i < COUNT; i++) {
    trace[i].d_re = i < 5 ? 0.5e-3 : -1e-3;
    truth[i].hand[0] = 0.2505;
  }
  ck_assert_double_eq(measure().t_rvo, 5 * 1e-3);
  truth[2].pad = 1e-6;
  ck_assert_int_eq(measure().reason, ETHD_TAP_EARLY_CONTACT);
}

/* ---- by the finger ---- */

/* The hand goes at 0.4 m/s through the touch plane at tick 50; the finger touches at `touch`, when the ring is `depth`
   behind the wall at `v`. The ring never meets the wall by the controller. */
static ethd__metrics by_finger(int touch, double depth, double v, double eps) {
  for (int i = 0; i < COUNT; i++) {
    double s = rule.seen + 0.4 * 1e-3 * (i - 49.5);
    truth[i].hand[0] = truth[i].finger[0] = -s;
    truth[i].ring[0] = -(rule.meet + (i < touch ? -0.02 : depth));
    truth[i].ring_v[0] = i < touch ? -0.4 : -v;
    truth[i].pad = i >= touch ? 1e-5 : -1e-3;
    trace[i].state = i >= touch + 5 ? ETHD_VO : ETHD_TRANSPARENT;
    trace[i].eps = i == touch + 60 ? eps : 1;
    trace[i].d_re = 0.001;
  }
  return measure();
}

TEST(test_by_finger) {
  rule.validity = ETHD_TAP_BY_FINGER;
  rule.speed = 0.4, rule.band = 0.08, rule.seen = -0.245;
  ethd__metrics m = by_finger(60, -0.2e-3, 0.01, 0.0012);
  ck_assert_int_eq(m.reason, ETHD_TAP_OK);
  ck_assert_double_eq_tol(m.v_hand, 0.4, 1e-9);
  ck_assert_double_eq_tol(m.touch_depth, -0.2e-3, 1e-12);
  ck_assert(m.eps_felt == 0.0012 && fabs(m.v_of_tick - 0.01) < 1e-12 && isnan(m.v_rvo));
  ck_assert_int_eq(by_finger(60, -0.2e-3, 0.03, 0).reason, ETHD_TAP_EARLY_CONTACT); /* near, but it moves */
  ck_assert_int_eq(by_finger(60, -0.4e-3, 0.01, 0).reason, ETHD_TAP_EARLY_CONTACT); /* it stands too far off */
  ck_assert_int_eq(by_finger(60, 0.1e-3, 0.3, 0).reason, ETHD_TAP_OK);              /* behind the wall */
  rule.speed = 0.5;
  ck_assert_int_eq(by_finger(60, 0, 0, 0).reason, ETHD_TAP_TOO_SLOW);
  rule.speed = 0.3;
  ck_assert_int_eq(by_finger(60, 0, 0, 0).reason, ETHD_TAP_TOO_FAST);
  rule.speed = 0.4;
  ck_assert_int_eq(by_finger(1000, 0, 0, 0).reason, ETHD_TAP_NO_CONTACT);
  rule.validity = ETHD_TAP_BY_PAPER; /* for the paper, that ring never met the wall */
  m = by_finger(60, 0.1e-3, 0.3, 0);
  ck_assert(m.reason == ETHD_TAP_NO_CONTACT && m.by_ring == ETHD_TAP_NO_CONTACT && m.by_finger == ETHD_TAP_OK);
  m = by_finger(60, -0.4e-3, 0.01, 0);
  ck_assert(m.by_ring == ETHD_TAP_NO_CONTACT && m.by_finger == ETHD_TAP_EARLY_CONTACT);
  rule.validity = ETHD_TAP_BY_FINGER, rule.carried = true; /* a device: the finger's own speed before the touch */
  ck_assert_double_eq_tol(by_finger(60, 0, 0, 0).v_hand, 0.4, 1e-9);
}
