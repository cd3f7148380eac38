/* A controller under everything at once: laws that fail or answer nonsense, samples that can't be, any limits, latched
   or not, bodies without a scene, swaps in between. After every tick of every run: the command is finite and within
   the torque limit that rules; a negative status comes with the safe command or, where a stop damps the ring, with a
   torque; a row that takes the torque away has taken it at this very tick. ETHD_HOSTILE: runs, 300 by default. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "servo/feedback.h"
#include "unit/draw.h"
#include "unit/moody.h"

#define TICKS 80
#define HAVE_ALL (2 * (ETHD_HAVE_BODY << (ETHD_BODIES_MAX - 1)) - 1)

static uint64_t drawn;

static uint64_t any(uint64_t n) { return draw_bits(drawn++) % n; }
static double between(double a, double b) { return draw(drawn++, a, b); }
static double one_of(const double *values, size_t n) { return values[any(n)]; }
#define ONE_OF(...) one_of((const double[]){__VA_ARGS__}, sizeof((const double[]){__VA_ARGS__}) / sizeof(double))

static double absurd(void) {
  return ONE_OF(NAN, INFINITY, -INFINITY, 1e306, -1e306, 1e154, 6.3e6, -0.0, 5e-324, 1e-300, 0x1p63, 1e9);
}

static int64_t instant(int64_t now) {
  const int64_t extremes[] = {INT64_MIN, INT64_MAX, 0, INT64_MIN + 5000000, INT64_MAX - 5000000, -1};
  return any(12) ? now : extremes[any(6)];
}

/* ---- what is drawn ---- */

static void draw_limits(ethd_limits *l) {
  *l = ethd_limits_none();
  l->stop_time = 1e6; /* whatever mass, torque and speed are drawn */
  l->latch = (int32_t)any(2);
  l->torque = ONE_OF(INFINITY, 0, 0.1, 1.3);
  l->torque_rate = ONE_OF(INFINITY, 5, 500, 0);
  l->nominal_torque = ONE_OF(INFINITY, INFINITY, 0.02);
  l->heat_time = ONE_OF(INFINITY, 0.2);
  l->speed = ONE_OF(INFINITY, 0.3, 0);
  l->gap = ONE_OF(INFINITY, 0.005);
  l->energy = ONE_OF(INFINITY, 1e-6);
  l->step_time = ONE_OF(INFINITY, 1e-4);
  l->finger_age = ONE_OF(INFINITY, 0.01);
  l->finger_lost = ONE_OF(INFINITY, 0.03);
  if (!any(4)) l->workspace[0] = between(0.2, 0.3), l->margin = ONE_OF(0, 0.01);
  if (!any(4)) l->reach[1] = between(0.3, 0.4);
  if (!any(4)) l->joints[0] = -1, l->joints[1] = 2;
}

static void draw_setup(rig *r, ethd_scene *empty, ethd_scene *wall) {
  ethd_setup *s = &r->setup;
  draw_limits(&s->limits);
  ethd_setup_velocity(s, (ethd_velocity_method)any(ETHD_VELOCITY_COUNT));
  ethd_setup_fit(s, (ethd_fit_method)any(ETHD_FIT_COUNT));
  ethd_setup_filter(s, (ethd_filter_method)any(ETHD_FILTER_COUNT));
  for (int k = 0; k < ETHD_RAYS; k++) s->ray_lag[k] = any(2) ? between(-0.01, 0.01) : 0;
  s->scene = any(3) ? r->scene : NULL;
  for (int i = 0; i < ETHD_BODIES_MAX; i++) s->bodies[i] = any(3) ? NULL : any(2) ? empty : wall;
  s->v_hysteresis = ONE_OF(0, 0.01);
  s->swap_time = ONE_OF(0, 0.02);
}

static void draw_mood(void) {
  memset(&mood, 0, sizeof mood);
  if (any(5)) return;
  mood.tracking = any(2) ? MOODY_WELL : (int)any(4);
  mood.contact = any(2) ? MOODY_WELL : (int)any(4);
  mood.transition = any(2) ? MOODY_WELL : (int)any(4);
  mood.value = absurd();
  mood.field = sizeof(double) * any(8);
}

static void spoil(double *values, size_t n) { values[any(n)] = absurd(); }

static ethd_sense draw_sense(const rig *r, int tick) {
  motion m = rig_at(between(-0.004, 0.006), between(-0.4, 0.4), between(-0.002, 0.003));
  ethd_sense s = rig_sense(&r->setup.arm, &m);
  s.time_ns = instant(1000000 * (int64_t)(tick + 1));
  s.sample_ns = instant(s.time_ns == INT64_MIN ? s.time_ns : s.time_ns - 2000000 * (int64_t)any(2));
  if (any(2)) s.have = any(4) ? (int64_t)any(HAVE_ALL + 1) : (int64_t)draw_bits(drawn++);
  for (int k = 0; k < ETHD_RAYS; k++) s.rays[k] = between(0.001, 0.008);
  for (int i = 0; i < ETHD_BODIES_MAX; i++) s.bodies[6 * i] = between(-0.05, 0.3);
  s.centre[0] = between(-0.003, 0.003);
  s.missed = any(8) ? 0 : any(2) ? INT64_MAX : -(int64_t)any(3);
  s.step_ns = any(10) ? 1000 : any(2) ? INT64_MAX : INT64_MIN;
  if (!any(12)) s.faults = (int64_t)draw_bits(drawn++);
  if (!any(12)) s.grave = (int64_t)draw_bits(drawn++);
  double *const spoilt[] = {s.q, s.dq, s.finger, s.finger_v, s.centre, s.ring, s.rays, s.bodies};
  const size_t counts[] = {2, 2, 2, 2, 2, 2, ETHD_RAYS, 6 * ETHD_BODIES_MAX};
  size_t which = any(40);
  if (which < 8) spoil(spoilt[which], counts[which]);
  return s;
}

/* ---- what holds ---- */

static void expect_kept(const rig *r, const ethd_limits *limits) {
  const ethd_command *c = &r->command;
  const ethd_trace *t = &r->trace;
  bool is_zero = c->torque[0] == 0 && c->torque[1] == 0;
  for (int i = 0; i < 2; i++) {
    ck_assert(isfinite(c->torque[i]) && c->torque[i] == t->tau[i]);
    ck_assert(fabs(c->torque[i]) <= limits->torque);
  }
  ck_assert(!c->safe || (t->fault != 0 && is_zero)); /* a stop may still brake after zero torque */
  ck_assert((r->status < 0) == (t->fault != 0));
  if (!t->fault) return;
  if (ethd_fault_reaction((ethd_fault)t->fault, 0) == ETHD_REACTION_ZERO && !(is_zero && c->safe))
    ck_abort_msg("row %d with %g %g Nm, latched %d", (int)t->fault, c->torque[0], c->torque[1], limits->latch);
}

static void run(int number) {
  rig r;
  ethd_scene *empty = rig_scene(""), *wall = rig_scene("box 0 0 0.02 0.02 0\n");
  ethd_limits ruling;
  ethd_event e;
  drawn = (uint64_t)number << 32;
  moody_open(&r, 1);
  ethd_control_destroy(r.control);
  draw_setup(&r, empty, wall);
  rig_start(&r);
  ruling = r.setup.limits;
  for (int tick = 0; tick < TICKS; tick++) {
    draw_mood();
    ethd_sense s = draw_sense(&r, tick);
    if (!any(10)) {
      draw_setup(&r, empty, wall);
      const double before = ruling.torque; /* may still fade */
      rig_post(&r);
      ruling = r.setup.limits;
      ruling.torque = fmax(ruling.torque, before);
    }
    if (!any(6)) ethd_control_acknowledge(r.control);
    if (!any(30)) ethd_control_reset(r.control);
    rig_try(&r, &s);
    expect_kept(&r, &ruling);
    while (ethd_control_poll(r.control, &e) == ETHD_OK) continue;
  }
  rig_close(&r);
  ethd_scene_destroy(empty);
  ethd_scene_destroy(wall);
}

TEST(test_everything_at_once) {
  const char *given = getenv("ETHD_HOSTILE");
  int runs = given ? atoi(given) : 300;
  for (int i = 0; i < runs; i++) run(i);
  printf("%d runs of %d ticks\n", runs, TICKS);
}

/* ---- numbers at their ends ---- */

/* Rays that lag, with stamps at both ends of time: the sanitizers see no overflow, and the ring no bad number. */
TEST(test_stamps_at_the_ends) {
  const int64_t ends[] = {INT64_MIN, INT64_MIN + 1, INT64_MIN + 9000000, -1, 0, INT64_MAX - 9000000, INT64_MAX};
  rig r;
  rig_open(&r, RIG_WALL);
  for (int k = 0; k < ETHD_RAYS; k++) r.setup.ray_lag[k] = k % 2 ? 0.01 : -0.01;
  rig_start(&r);
  for (size_t i = 0; i < 7 * 7 * 4; i++) {
    motion m = rig_at(0.005, 0.1, 0.001);
    ethd_sense s = rig_sense(&r.setup.arm, &m);
    s.have = ETHD_HAVE_DQ | ETHD_HAVE_RAYS | (i == 0 ? ETHD_HAVE_START : 0);
    s.time_ns = ends[i / 4 % 7];
    s.sample_ns = ends[i / 4 / 7];
    for (int k = 0; k < ETHD_RAYS; k++) s.rays[k] = 0.0045;
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    ck_assert(isfinite(r.command.torque[0]) && isfinite(r.trace.xf[0]));
  }
  rig_close(&r);
}

/* The age that a drive says of its reading: what can't be isn't one, and no reading comes of it. */
TEST(test_age_of_a_reading) {
  static const double ages[] = {0, 0.004, 10, NAN, -0.001, 10.1, 1e300, INFINITY, -INFINITY};
  for (size_t i = 0; i < sizeof ages / sizeof *ages; i++) {
    static ethd__servo_map map;
    static ethd__servo_link link;
    static ethd__servo_feedback f;
    const int given[] = {ETHD__SERVO_READING_X, ETHD__SERVO_READING_Y, ETHD__SERVO_READING_COUNT,
                         ETHD__SERVO_READING_AGE};
    memset(&map, 0, sizeof map), memset(&link, 0, sizeof link), memset(&f, 0, sizeof f);
    for (int k = 0; k < ETHD__SERVO_ROLES; k++) map.roles[k] = -1;
    for (int k = 0; k < 4; k++) {
      map.roles[given[k]] = k;
      map.registers[k] = (ethd__servo_register){.ratio = 1, .scale = 1};
    }
    link.map = &map;
    const double raw[] = {0.001, 0.002, 7, ages[i]};
    memcpy(link.raw, raw, sizeof raw);
    ethd__servo_feedback_take(&f, &link, 50000000);
    bool is_good = ages[i] >= 0 && ages[i] <= 10;
    ck_assert_int_eq((f.sample.has & ETHD__SERVO_HAS_READING) != 0, is_good);
    if (is_good) ck_assert_int_eq(f.sample.reading_ns, 50000000 - (int64_t)(1e9 * ages[i]));
  }
}
