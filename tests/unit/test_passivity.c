/* Passivity observer and controller: gains over the sampled loop's bound, on an exact mass that is pressed
   against a wall; and walls that are passive enough, which it leaves alone. */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bounds/stability.h"
#include "stress/mass.h"
#include "unit/rig.h"

#define MASS 0.25
#define BOUND 0.002 /* J */

typedef struct run {
  double early, late; /* m: swing of the depth in the first and the last 0.25 s */
  ethd_fault fault;
  int64_t seen;      /* rows told, as bits */
  double most_force; /* N, along n: positive would pull */
} run;

static double swing(double *lo, double *hi, double x) {
  *lo = fmin(*lo, x);
  *hi = fmax(*hi, x);
  return *hi - *lo;
}

static void poll(ethd_control *control, run *out) {
  ethd_event e;
  while (ethd_control_poll(control, &e) == ETHD_OK)
    if (e.kind == ETHD_EVENT_FAULT) out->seen |= ETHD_FAULT_BIT(e.code);
}

/* 3 s pressed with 4 N against a wall of stiffness K, damping B on the way in. */
static run press(double K, double B, int delay, double energy) {
  enum { TICKS = 3000 };
  static mass_rig ring;
  run out = {.most_force = -INFINITY};
  double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
  mass_open(&ring, MASS, -0.001);
  ring.delay = delay;
  ring.measured = 1;
  ring.push = (ethd_vec){-4, 0};
  ring.on.setup.limits.energy = energy;
  ring.on.setup.dynamics = (ethd_dynamics){{MASS, MASS}, NAN, NAN, 1e-3 * delay};
  ethd_setup_transition(&ring.on.setup, &ethd_transition_smooth);
  ethd_setup_contact(&ring.on.setup, &ethd_contact_kelvin_voigt);
  const ethd_law *law = &ethd_contact_kelvin_voigt.law;
  ring.on.setup.contact_p[ethd_params_find(law->params, law->param_count, "k_e")] = K;
  ring.on.setup.contact_p[ethd_params_find(law->params, law->param_count, "b_e")] = B;
  mass_start(&ring, 0);
  for (int i = 0; i < TICKS; i++) {
    const ethd_trace *t = mass_tick(&ring);
    if (t->fault) {
      out.fault = (ethd_fault)t->fault;
      break;
    }
    if (i < 250) out.early = swing(&lo[0], &hi[0], mass_depth(&ring));
    if (i >= TICKS - 250) out.late = swing(&lo[1], &hi[1], mass_depth(&ring));
    out.most_force = fmax(out.most_force, -t->fe[0]); /* n = (-1, 0) */
  }
  poll(ring.on.control, &out);
  mass_close(&ring);
  return out;
}

static bool is_stable(double K, double B, int delay) {
  ethd__sampled_loop loop = {.mass = MASS, .period = 1e-3, .stiffness = K, .damping = B, .delay = delay, .link = 0.25};
  loop.method = ETHD_VELOCITY_DIFFERENCE;
  return ethd__sampled_stable(&loop);
}

/* A spring is over the bound at any stiffness: it swings up without, and comes to rest with. */
static const struct {
  double K;
  int delay;
} springs[] = {{1000, 0}, {3000, 0}, {10000, 0}, {1000, 1}, {3000, 1}};

TEST_LOOP(test_oscillation, 0, sizeof springs / sizeof *springs) {
  double K = springs[_i].K;
  int delay = springs[_i].delay;
  ck_assert(!is_stable(K, 0, delay));
  run without = press(K, 0, delay, INFINITY), with = press(K, 0, delay, BOUND);
  printf("K %g, %d ticks: swing %.3g -> %.3g mm without, %.3g -> %.3g mm with\n", K, delay, 1e3 * without.early,
         1e3 * without.late, 1e3 * with.early, 1e3 * with.late);
  ck_assert_double_gt(without.late, without.early);
  ck_assert_double_lt(with.late, 0.1 * without.late);
  ck_assert(with.fault == ETHD_FAULT_NONE && with.seen & ETHD_FAULT_BIT(ETHD_FAULT_ENERGY));
  ck_assert_double_le(with.most_force, 0);
}

/* Far over the bound damping doesn't help: the ring is stopped. */
TEST(test_beyond_help) {
  run with = press(60000, 0, 1, BOUND);
  ck_assert(with.fault == ETHD_FAULT_ENERGY);
}

/* Walls under the bound are left alone, to the bit. */
TEST(test_passive) {
  const double walls[][2] = {{500, 45}, {1000, 45}, {2500, 45}, {2500, 20}};
  for (size_t i = 0; i < sizeof walls / sizeof *walls; i++) {
    run without = press(walls[i][0], walls[i][1], 0, INFINITY), with = press(walls[i][0], walls[i][1], 0, BOUND);
    ck_assert(with.seen == 0 && with.early == without.early && with.late == without.late);
  }
}

/* ---- from within the wall ---- */

/* A tick at this distance, moving away at v, m/s; returns the rows of energy that it told. */
static int tick_at(rig *r, double d, double v) {
  motion m = rig_at(d, -v, 0);
  ethd_sense s = rig_sense(&r->setup.arm, &m);
  int rows = 0;
  ethd_event e;
  s.time_ns = r->sense.time_ns + 1000000;
  (void)rig_try(r, &s);
  while ((e = rig_poll(r)).kind) rows += e.kind == ETHD_EVENT_FAULT && e.code == ETHD_FAULT_ENERGY;
  return rows;
}

/* Rows of energy that were told while the ring moves from one distance to another at `speed`. */
static int told_at(rig *r, double from, double to, double speed) {
  const double v = from < to ? speed : -speed;
  int rows = 0;
  for (double d = from; (to - d) * v > 0; d += v * 1e-3) rows += tick_at(r, d, v);
  return rows;
}

static int told(rig *r, double from, double to) { return told_at(r, from, to, 0.02); }

/* 4 mm deep, slowly: the paper's wall has stored 20 mJ, ten times the bound. */
static void go_in(rig *r, double energy) {
  rig_open(r, RIG_WALL);
  ethd_setup_transition(&r->setup, &ethd_transition_smooth);
  r->setup.limits.energy = energy;
  rig_start(r);
  ck_assert_int_eq(told(r, 0.004, -0.004), 0);
}

/* The watch is switched on there; off and on again. */
TEST_LOOP(test_watched_from_within, 0, 2) {
  rig r;
  go_in(&r, _i ? BOUND : INFINITY);
  for (int swap = 0; swap <= _i; swap++) {
    r.setup.limits.energy = _i && !swap ? INFINITY : BOUND;
    rig_post(&r);
    ck_assert_int_eq(told(&r, -0.004, -0.0039), 0);
  }
  ck_assert_int_eq(told(&r, -0.0039, 0.004), 0);
  ck_assert_int_eq(r.trace.fault, 0);
  rig_close(&r);
}

/* The contact begins anew in the wall after an acknowledged fault. */
TEST(test_acknowledged_within) {
  rig r;
  go_in(&r, BOUND);
  motion m = rig_at(-0.004, 0, 0);
  ethd_sense s = rig_sense(&r.setup.arm, &m);
  s.faults = s.grave = ETHD_FAULT_BIT(ETHD_FAULT_FINGER_LOST);
  ck_assert_int_lt(rig_try(&r, &s), 0);
  s.faults = s.grave = 0;
  for (int i = 0; i < 300; i++) (void)rig_try(&r, &s);
  ethd_control_acknowledge(r.control);
  while (rig_poll(&r).kind) continue;
  ck_assert_int_eq(told(&r, -0.004, 0.004), 0);
  ck_assert_int_eq(r.trace.fault, 0);
  rig_close(&r);
}

/* A spring that is bounced on, 0.6 mm deep at 0.2 m/s, gives away what the hold adds, at most
   2 x 2500 N/m x 0.6 mm x 0.2 mm = 0.6 mJ each time. */
static int told_while_bouncing(int bounces, int pause) {
  rig r;
  int rows = 0;
  rig_open(&r, RIG_WALL);
  ethd_setup_transition(&r.setup, &ethd_transition_smooth);
  ethd_setup_contact(&r.setup, &ethd_contact_spring);
  r.setup.contact_p[0] = 2500;
  r.setup.limits.energy = BOUND;
  rig_start(&r);
  for (int i = 0; i < bounces; i++) {
    rows += told_at(&r, 0.015, -0.0006, 0.2);
    rows += told_at(&r, -0.0006, 0.015, 0.2);
    for (int k = 0; k < pause; k++) rows += tick_at(&r, 0.015, 0);
  }
  rig_close(&r);
  return rows;
}

/* One contact goes on with what the last one gave away, unless that is half a second ago. */
TEST(test_bounces_add_up) {
  ck_assert_int_eq(told_while_bouncing(1, 0), 0);
  ck_assert_int_gt(told_while_bouncing(12, 10), 0);
  ck_assert_int_eq(told_while_bouncing(12, 600), 0);
}

/* What a wall has absorbed is no credit once it doesn't push: a slow way in and a fast one out are told after it,
   too. */
TEST(test_absorbed_is_no_credit) {
  for (int is_before = 0; is_before < 2; is_before++) {
    rig r;
    rig_open(&r, RIG_WALL);
    ethd_setup_transition(&r.setup, &ethd_transition_smooth);
    r.setup.limits.energy = BOUND;
    rig_start(&r);
    ck_assert_int_eq(told_at(&r, 0.001, 0.0005, 0.01), 0);
    if (is_before) ck_assert_int_eq(told_at(&r, 0.0005, -0.004, 0.3) + told_at(&r, -0.004, 0.0005, 0.01), 0);
    ck_assert_int_gt(told_at(&r, 0.0005, -0.004, 0.005) + told_at(&r, -0.004, 0.001, 0.6), 0);
    rig_close(&r);
  }
}

/* A brake takes energy away: it is never told, and no wall is added to it. */
TEST(test_brake_takes) {
  rig r;
  rig_open(&r, RIG_WALL);
  ethd_setup_transition(&r.setup, &ethd_transition_offset);
  r.setup.limits.energy = 1e-6;
  rig_start(&r);
  for (int i = 0; i < 8; i++) {
    motion m = rig_at(0.0005 - 0.0003 * i, 0.3, 0);
    const ethd_trace *t = rig_step(&r, &m);
    ck_assert_double_eq(t->fe[0], 0);
    for (ethd_event e; (e = rig_poll(&r)).kind;) ck_assert_msg(e.kind != ETHD_EVENT_FAULT, "%d at %d", e.code, i);
  }
  ck_assert_int_eq(r.trace.state, ETHD_BRAKING);
  rig_close(&r);
}

/* A body that was pressed and retreats from a ring that stands, with another law since. */
TEST(test_surface_retreats) {
  rig r;
  rig_open(&r, NULL);
  ethd_setup_transition(&r.setup, &ethd_transition_smooth);
  ethd_scene *body = rig_scene(RIG_WALL);
  r.setup.bodies[0] = body;
  rig_start(&r);
  motion m = rig_at(0, 0, 0);
  for (int i = 0; i < 800; i++) {
    ethd_sense s = rig_sense(&r.setup.arm, &m);
    double way = 2e-5 * (i < 300 ? i : i < 400 ? 300 : 700 - i);
    s.have |= ETHD_HAVE_BODY;
    s.bodies[0] = way - 0.002;
    s.bodies[3] = i < 300 ? 0.02 : i < 400 ? 0 : -0.02;
    s.time_ns = r.sense.time_ns + 1000000;
    if (i == 350) {
      r.setup.limits.energy = BOUND;
      ethd_setup_transition(&r.setup, &ethd_transition_abrupt);
      rig_post(&r);
    }
    ck_assert_int_eq(rig_try(&r, &s), ETHD_OK);
    if (i == 350) ck_assert_double_gt(r.trace.fe[0], 5);
    for (ethd_event e; (e = rig_poll(&r)).kind;) ck_assert(e.kind != ETHD_EVENT_FAULT);
  }
  ck_assert_double_eq(r.trace.fe[0], 0);
  ethd_scene_destroy(body);
  rig_close(&r);
}

/* A wall that comes to the ring with a new scene has stored nothing: what it gives is told. */
TEST(test_wall_that_comes) {
  rig r;
  rig_open(&r, "halfplane -1 0 0.5\n");
  ethd_setup_transition(&r.setup, &ethd_transition_smooth);
  r.setup.limits.energy = BOUND;
  rig_start(&r);
  ck_assert_int_eq(told(&r, -0.004, -0.0039), 0);
  ethd_scene *wall = rig_scene(RIG_WALL);
  r.setup.scene = wall;
  rig_post(&r);
  ck_assert_int_gt(told(&r, -0.0039, 0.004), 0);
  ethd_scene_destroy(wall);
  rig_close(&r);
}
