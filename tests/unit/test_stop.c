/* The guard's stop on devices of every kind, simulated here apart from the library's own device: two links without
   coupling, whose torques come late by any time, integrated in steps of a twentieth of a period. */
#include <math.h>
#include <string.h>

#include "unit/rig.h"

#define DEVICES 10000
#define LINK 0.25 /* m */
#define STEPS 20
#define TICKS_MAX 20000
#define LONGEST 3 /* s: enough for the slowest */

static uint64_t seed;

static double uniform(void) {
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return (double)(seed >> 11) * 0x1p-53;
}

static double between(double least, double most) { return least * pow(most / least, uniform()); }

typedef enum broken { HEALTHY, REVERSED, FROZEN, FROZEN_SPEED } broken;
typedef enum told { KNOWN, UNKNOWN, WRONG } told;

typedef struct device {
  double mass, period, delay, torque, viscous; /* kg, s, s, Nm, 1/s */
  double v[2];                                 /* m/s of the links when the fault comes */
  bool measured;                               /* dq comes with the sense */
  broken broken;
  told told;
  ethd_dynamics says;
} device;

/* The dynamics are told right, not at all, or each wrong by three. */
static device random_device(void) {
  device d = {.mass = between(0.02, 10), .period = between(2e-4, 1e-2), .measured = uniform() < 0.7};
  d.delay = uniform() < 0.3 ? 0 : 0.02 * uniform();
  d.torque = uniform() < 0.3 ? INFINITY : d.mass * LINK * between(1, 100);
  double speed = between(0.05, 1), angle = 2 * M_PI * uniform();
  d.v[0] = speed * cos(angle), d.v[1] = speed * sin(angle);
  d.broken = uniform() < 0.5 ? HEALTHY : (broken)(1 + (int)(3 * uniform()));
  d.told = (told)(3 * uniform());
  d.says = ethd_dynamics_unknown();
  double wrong[2] = {1, 1};
  for (int i = 0; i < 2; i++)
    if (d.told == WRONG) wrong[i] = uniform() < 0.5 ? 3 : 1.0 / 3;
  if (d.told == UNKNOWN) return d;
  d.says.mass[0] = d.says.mass[1] = wrong[0] * d.mass;
  d.says.delay = wrong[1] * d.delay;
  return d;
}

typedef struct ending {
  double arrived;  /* m/s when the stop's first torque arrives */
  double fastest;  /* m/s from then on */
  double time;     /* s from the stop's first tick to the last torque's end */
  double distance; /* m on the way until then, and 10 ms more */
  double left;     /* m/s at the end */
  bool safe;
} ending;

/* The fault comes once the estimate of the speed has settled. */
static long fault_tick(const device *d) { return 1 + (long)(0.015 / d->period); }

static double length(const double v[2]) { return hypot(v[0], v[1]); }

/* Moves the links by one period under the torques that arrive in it. */
static void move(const device *d, double torque[][2], long tick, double q[2], double v[2], ending *e) {
  const long fault = fault_tick(d);
  const double h = d->period / STEPS;
  for (int k = 0; k < STEPS; k++) {
    long i = (long)floor(((double)tick * d->period + (k + 0.5) * h - d->delay) / d->period);
    if (i >= fault && e->arrived < 0) e->arrived = length(v);
    for (int j = 0; j < 2; j++) {
      double force = i < 0 ? 0 : torque[i][j] / LINK;
      v[j] += (force / d->mass - d->viscous * v[j]) * h;
      q[j] += v[j] / LINK * h;
    }
    if (tick >= fault) e->distance += length(v) * h;
    if (e->arrived >= 0) e->fastest = fmax(e->fastest, length(v));
  }
}

static void look(const device *d, const double q[2], const double v[2], const double start[2], ethd_sense *s) {
  const double sign = d->broken == REVERSED ? -1 : 1;
  for (int j = 0; j < 2; j++) {
    s->q[j] = d->broken == FROZEN ? start[j] : start[j] + sign * (q[j] - start[j]);
    s->dq[j] = d->broken == FROZEN ? 0 : sign * (d->broken == FROZEN_SPEED ? d->v[j] : v[j]) / LINK;
  }
  s->have = d->measured ? ETHD_HAVE_DQ : 0;
}

static ethd_control *control_of(const device *d, double stop_time) {
  ethd_setup setup = ethd_setup_default();
  ethd_error error;
  ethd_control *control;
  setup.period = d->period;
  setup.dynamics = d->says;
  setup.limits.torque = d->torque;
  setup.limits.stop_time = stop_time;
  ck_assert_int_eq(ethd_control_create(&setup, &control, &error), ETHD_OK);
  return control;
}

/* There is no finger, so that the laws' torque is 0. */
static ending stop(const device *d, double stop_time) {
  const long fault = fault_tick(d);
  static double torque[TICKS_MAX][2];
  const double start[2] = {M_PI / 2, 0};
  double q[2] = {start[0], start[1]}, v[2] = {d->v[0], d->v[1]};
  ending e = {.arrived = -1};
  ethd_control *control = control_of(d, stop_time);
  long end = TICKS_MAX;
  for (long tick = 0; tick < end; tick++) {
    ethd_sense s = {.time_ns = (int64_t)llround((double)tick * d->period * 1e9)};
    ethd_command command;
    look(d, q, v, start, &s);
    if (tick == fault) s.faults = ETHD_FAULT_BIT(ETHD_FAULT_APPLICATION);
    (void)!ethd_control_step(control, &s, &command, NULL);
    memcpy(torque[tick], command.torque, sizeof torque[tick]);
    ck_assert(fabs(command.torque[0]) <= d->torque && fabs(command.torque[1]) <= d->torque);
    if (tick >= fault && command.safe && !e.safe) {
      e.safe = true;
      e.time = (double)(tick - fault) * d->period;
      end = tick + (long)((d->delay + 0.01) / d->period) + 2;
      ck_assert_int_le(end, TICKS_MAX);
    }
    move(d, torque, tick, q, v, &e);
    if (!e.safe || (double)(tick - fault) * d->period < e.time + d->delay) e.left = length(v);
  }
  ethd_control_destroy(control);
  return e;
}

/* lag of the default estimator, a low-pass */
static double lag_at(double period) {
  ethd_setup setup = ethd_setup_default();
  ethd_velocity velocity;
  ck_assert_int_eq(ethd_velocity_prepare(setup.velocity, setup.velocity_p, period, &velocity, NULL), ETHD_OK);
  return ethd_velocity_lag(&velocity);
}

static double lag_of(const device *d) { return d->measured ? 0 : lag_at(d->period); }

/* What a stop without overshoot and the torque limit need, and half as much again. */
static double way(const device *d) {
  double v = length(d->v), late = d->delay + d->period + lag_of(d);
  return 1.5 * (v * (1 + M_E) * late + d->mass * v * v * LINK / (2 * d->torque));
}

/* What a post asks of limits.stop_time for a stop from this speed, s. */
static double needed(const device *d) {
  const ethd_arm arm = {ETHD_ARM_PARALLEL, LINK, LINK};
  const ethd_guard_device g = ethd_guard_device_of(&arm, &d->says, INFINITY, d->period, lag_of(d));
  ethd_limits limits = ethd_limits_torque(d->torque);
  limits.speed = length(d->v);
  return ethd_guard_stop_time(&g, &limits);
}

static void check(const device *d, const ending *e) {
  ck_assert_msg(e->safe && e->time <= LONGEST, "m %g kg, T %g s, t_d %g s: %g s", d->mass, d->period, d->delay,
                e->time);
  ck_assert_msg(e->fastest <= 1.4 * e->arrived, "m %g kg, T %g s, t_d %g s, told %d, broken %d: %g times as fast",
                d->mass, d->period, d->delay, d->told, d->broken, e->fastest / e->arrived);
  if (d->broken != HEALTHY || d->told != KNOWN) return;
  double most = way(d) + 0.02 * (d->delay + 0.01); /* and how far it rolls until the simulation ends */
  ck_assert_msg(e->distance <= most, "m %g kg, T %g s, t_d %g s, %g Nm, %g m/s: %g m instead of %g", d->mass, d->period,
                d->delay, d->torque, length(d->v), e->distance, most);
  ck_assert_msg(e->time <= needed(d), "m %g kg, T %g s, t_d %g s, %g m/s: %g s instead of %g", d->mass, d->period,
                d->delay, length(d->v), e->time, needed(d));
  ck_assert_msg(e->left <= 0.021, "m %g kg, T %g s, t_d %g s, measured %d: let go at %g m/s", d->mass, d->period,
                d->delay, d->measured, e->left);
}

TEST(test_random_devices) {
  seed = 1;
  for (int i = 0; i < DEVICES; i++) {
    device d = random_device();
    ending e = stop(&d, LONGEST);
    check(&d, &e);
  }
}

/* ---- the deadline ---- */

/* A healthy device whose full torque brakes it for far longer than 0.1 to 0.5 s: its last torque ends at the deadline. */
TEST(test_deadline) {
  seed = 2;
  for (int i = 0; i < 200; i++) {
    device d = random_device();
    const double deadline = between(0.1, 0.5);
    d.broken = HEALTHY, d.told = KNOWN;
    d.says.mass[0] = d.says.mass[1] = d.mass;
    d.says.delay = d.delay;
    d.torque = d.mass * LINK * length(d.v) / (4 * deadline);
    ending e = stop(&d, deadline);
    ck_assert_msg(e.safe && e.time <= deadline && e.time > deadline - d.period * (1 + 1e-6),
                  "m %g kg, T %g s, t_d %g s: %g s instead of %g", d.mass, d.period, d.delay, e.time, deadline);
  }
}

TEST(test_no_speed_to_stop_from) {
  const device d = {.period = 1e-3, .torque = 1, .v = {INFINITY, 0}};
  ck_assert(needed(&d) == 0);
}

/* The least stop_time that is accepted is m v / F of a known mass, at create and post. */
TEST(test_least_stop_time) {
  seed = 3;
  for (int i = 0; i < 200; i++) {
    ethd_setup setup = ethd_setup_default();
    ethd_control *control;
    ethd_error error;
    const double mass = between(0.5, 10), speed = between(0.1, 1), torque = between(0.5, 5);
    const double least = mass * speed * setup.arm.link1 / torque;
    setup.dynamics.mass[0] = mass, setup.dynamics.mass[1] = mass * between(0.5, 0.99);
    setup.limits.speed = speed;
    setup.limits.torque = torque;
    for (int unknown = 0; unknown < 2; unknown++) {
      setup.limits.stop_time = least * 1.0001;
      ck_assert_int_eq(ethd_control_create(&setup, &control, &error), ETHD_OK);
      setup.limits.stop_time = least * 0.99;
      ck_assert_int_eq(ethd_control_post(control, &setup, &error), unknown ? ETHD_OK : ETHD_E_RANGE);
      ethd_control_destroy(control);
      if (!unknown) ck_assert_str_eq(error.name, "limits.stop_time");
      setup.dynamics.mass[1] = ethd_dynamics_unknown().mass[1];
    }
  }
}

/* ---- the wall of the margin ---- */

/* Link 1 carries the ring along -x into the wall and back out of it. */
static void bounce(const device *d, double v, double margin, double *deepest, double *rebound) {
  static double torque[TICKS_MAX][2];
  const double start[2] = {M_PI / 2, 0}, run_up = 0.02 * v;
  double q[2] = {start[0], start[1]}, speed[2] = {v, 0}, depth = 0;
  ethd_setup setup = ethd_setup_default();
  ethd_control *control;
  ending unused = {0};
  setup.period = d->period;
  setup.dynamics = d->says;
  setup.limits.margin = margin;
  setup.limits.workspace[0] = LINK - run_up - margin;
  ck_assert_int_eq(ethd_control_create(&setup, &control, NULL), ETHD_OK);
  *deepest = *rebound = 0;
  for (long tick = 0; tick < TICKS_MAX && (depth >= 0 || speed[0] > 0); tick++) {
    ethd_sense s = {.time_ns = (int64_t)llround((double)tick * d->period * 1e9)};
    ethd_command command;
    look(d, q, speed, start, &s);
    ck_assert_int_eq(ethd_control_step(control, &s, &command, NULL), ETHD_OK);
    memcpy(torque[tick], command.torque, sizeof torque[tick]);
    move(d, torque, tick, q, speed, &unused);
    depth = -LINK * cos(q[0]) - run_up;
    *deepest = fmax(*deepest, depth);
    *rebound = fmax(*rebound, -speed[0]);
  }
  ethd_control_destroy(control);
}

TEST(test_margin) {
  seed = 4;
  for (int i = 0; i < 1000; i++) {
    device d = random_device();
    double deepest, rebound;
    const double v = between(0.02, 0.3);
    d.broken = HEALTHY, d.told = KNOWN, d.torque = INFINITY;
    d.says.mass[0] = d.says.mass[1] = d.mass;
    d.says.delay = d.delay;
    bounce(&d, v, 0.15, &deepest, &rebound);
    const double most = 3.5 * v * (d.delay + d.period + lag_at(d.period));
    ck_assert_msg(deepest <= most && rebound <= 0.55 * v, "m %g kg, T %g s, t_d %g s, %g m/s: %g m deep, out at %g m/s",
                  d.mass, d.period, d.delay, v, deepest, rebound);
  }
}
