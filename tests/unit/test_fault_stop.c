/* The guard's stops, through the controller. */
#include <math.h>
#include <string.h>

#include "unit/draw.h"
#include "unit/moody.h"

/* Too fast: braked at once, whatever the rate limit; still: nothing, and only then safe. */
TEST(test_speed) {
  rig r;
  moody_open(&r, 1);
  r.setup.limits.speed = 0.5;
  r.setup.limits.torque_rate = 1e-3;
  rig_post(&r);
  motion m = rig_at(0.020, 0.4, 0);
  ethd_sense s = rig_sense(&r.setup.arm, &m);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  m = rig_at(0.020, 0.6, 0); /* F = 6 N in x */
  s = rig_sense(&r.setup.arm, &m);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_E_RANGE);
  ck_assert_double_eq_tol(r.command.torque[0], -0.6 * MOODY_PROBE * 0.25, 0.01); /* dx/dq1 = -y = -0.25 m */
  ck_assert(r.command.safe == 0 && r.trace.guard == ETHD_GUARD_SPEED && r.trace.fault == ETHD_FAULT_SPEED);
  m = rig_at(0.020, 0.3, 0); /* slower than the limit, and still stopping */
  s = rig_sense(&r.setup.arm, &m);
  ck_assert_int_eq(rig_try(&r, &s), ETHD_E_RANGE);
  ck_assert_double_eq_tol(r.command.torque[0], -0.3 * MOODY_DAMPING * 0.25, 0.05);
  m = rig_at(0.020, 0.019, 0);
  s = rig_sense(&r.setup.arm, &m);
  rig_try(&r, &s);
  moody_expect_safe(&r, ETHD_E_RANGE, ETHD_FAULT_SPEED);
  m = rig_at(0.020, 0.3, 0); /* moved by hand: nothing any more */
  s = rig_sense(&r.setup.arm, &m);
  rig_try(&r, &s);
  moody_expect_safe(&r, ETHD_E_RANGE, ETHD_FAULT_SPEED);
  moody_expect_event(&r, ETHD_EVENT_TAKEN, 0, 0);
  moody_expect_event(&r, ETHD_EVENT_FAULT, ETHD_FAULT_SPEED, NAN);
  ethd_control_acknowledge(r.control);
  m = rig_at(0.020, 0.3, 0.001);
  s = rig_sense(&r.setup.arm, &m);
  for (int i = 0; i < 300; i++) ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
  ck_assert_double_eq_tol(r.command.torque[0], 299e-6, 1e-12); /* follows again, at the rate's pace */
  rig_close(&r);
}

/* ---- a bus out of step with the ticks ---- */

/* Link 1 of 0.12 kg on a bus whose exchanges take `least` to `most` ms each, one after the other. A sample is of the
   beginning of its exchange, a torque acts from the end of its own on; each tick uses the newest sample. Exceeds its
   speed limit after 0.2 s, with speeds that are estimated. */
typedef struct bus {
  double least, most; /* ms */
  double sign;        /* of the encoder; -1: reversed */
  ethd_velocity_method method;
  uint64_t seed;
} bus;

/* Returns the highest speed, and *end the last one, as shares of the speed at which the stop's first torque comes. */
static double stop_on(const bus *b, double *end) {
  const double mass = 0.12, link = 0.25, step = 1e-5;
  rig r;
  rig_open(&r, NULL);
  ethd_setup_velocity(&r.setup, b->method);
  r.setup.tracking_p[0] = r.setup.tracking_p[1] = 0; /* no torque but the stop's */
  r.setup.limits = ethd_limits_device();
  r.setup.limits.gap = 0.05;
  r.setup.limits.finger_age = r.setup.limits.finger_lost = INFINITY;
  r.setup.limits.torque = 10;
  r.setup.limits.speed = 5;
  r.setup.limits.stop_time = 1;
  r.setup.dynamics = (ethd_dynamics){{mass, mass}, 0, 0, 3e-3 * b->most + 1e-3};
  rig_start(&r);
  double q = 0.3, w = 2, torque = 0, ordered = 0, first = 0, highest = 0, done = 0, began = 0, began_q = q, stamp = 0,
         sample = q;
  int64_t missed = 0;
  bool fresh = false;
  for (int i = 0; i < 60000; i++, w += step * torque / (mass * link * link), q += step * w) {
    if (i * step >= done) {
      stamp = began, sample = began_q, torque = ordered;
      fresh = true;
      began = i * step, began_q = q;
      done = began + 1e-3 * draw(b->seed << 32 | (uint64_t)i, b->least, b->most);
    }
    if (i == 20000) {
      r.setup.limits.speed = 0.45;
      rig_post(&r);
    }
    if (i % 100 == 0 && !fresh) missed++;
    if (i % 100 == 0 && fresh) {
      const ethd_sense s = {.q = {b->sign * sample, 0.9}, .time_ns = (int64_t)(1e9 * (1 + stamp)), .missed = missed};
      (void)ethd_control_step(r.control, &s, &r.command, &r.trace);
      ordered = r.command.torque[0];
      if (ordered != 0 && !first) first = fabs(w);
      missed = 0;
      fresh = false;
    }
    if (first) highest = fmax(highest, fabs(w));
  }
  rig_close(&r);
  ck_assert_double_eq_tol(first, 2, 1e-9);
  *end = fabs(w) / first;
  return highest / first;
}

/* Speeds by the ticks' time would seem to fall and rise by half, so that a stop with a reversed encoder would go on. */
TEST(test_irregular_samples) {
  static const double exchanges[][2] = {{1, 1}, {0.3, 1.5}, {0.9, 2.5}, {1.5, 1.7}, {3, 9}};
  double worst = 0, end;
  for (size_t k = 0; k < sizeof exchanges / sizeof *exchanges; k++)
    for (int method = 0; method < ETHD_VELOCITY_COUNT; method++)
      for (uint64_t seed = 1; seed <= 4; seed++) {
        bus b = {exchanges[k][0], exchanges[k][1], -1, (ethd_velocity_method)method, seed};
        worst = fmax(worst, stop_on(&b, &end));
        b.sign = 1;
        ck_assert_double_le(stop_on(&b, &end), 1 + 1e-9);
        ck_assert_double_lt(end, 0.5);
      }
  ck_assert_msg(worst <= 1.4, "%g", worst);
}
