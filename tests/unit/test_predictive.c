/* The law that brakes before the wall: closed forms of its curve, what it does without facts, what it never does. */
#include <math.h>
#include <string.h>

#include "unit/rig.h"

static double p[ETHD_PARAMS_MAX];

static int param(const char *name) {
  const ethd_law *law = &ethd_transition_predictive.law;
  int i = ethd_params_find(law->params, law->param_count, name);
  ck_assert_msg(i >= 0, "no parameter %s", name);
  return i;
}

static void set_up(void) {
  ethd_params_default(ethd_transition_predictive.law.params, ethd_transition_predictive.law.param_count, p);
}

static double memory[ETHD_MEMORY];

static ethd_facts facts_of(double mass, double force, double friction) {
  memset(memory, 0, sizeof memory);
  return (ethd_facts){.mass = mass,
                      .force = force,
                      .friction = friction,
                      .viscous = 0,
                      .delay = 0,
                      .lag = 0,
                      .ring_radius = 0.012,
                      .finger_radius = 0.0075,
                      .finger_age = 0,
                      .finger_a = NAN,
                      .memory = memory};
}

static ethd_ruling rule(double *state, const ethd_contact *c) {
  ethd_ruling r = {.beta = 1, .argument = c->d_fe};
  ck_assert_int_eq(ethd_transition_predictive.step(p, state, c, &r), ETHD_OK);
  ck_assert(r.beta >= 0 && r.beta <= 1 && r.share >= 0 && r.share <= 1 && isfinite(r.feed) && isfinite(r.offset));
  return r;
}

/* A ring without friction under the law's force alone, exactly: moves, then measures. The finger is `lag` ahead and
   goes on at `speed`. */
typedef struct ride {
  double d, v, finger, mass, force;
  double state[ETHD_STATE_MAX / sizeof(double)];
  ethd_facts facts;
} ride;

static ethd_contact contact_of(ride *x, double speed) {
  return (ethd_contact){.point = {0.238, 0.25, 0},
                        .n = {-1, 0, 0},
                        .d_re = x->d,
                        .d_fe = x->finger + 0.0045,
                        .d_fr = x->finger,
                        .v = x->v,
                        .v_f = speed,
                        .d_beta = 0.0025,
                        .period = 1e-3,
                        .facts = &x->facts};
}

static ethd_ruling tick(ride *x, double speed, double real_mass) {
  ethd_contact c = contact_of(x, speed);
  ethd_ruling r = rule(x->state, &c);
  double force = r.feed - r.damping * x->v, a = force / real_mass;
  x->facts.applied = force;
  x->d -= x->v * 1e-3 + a * 1e-6 / 2;
  x->v += a * 1e-3;
  x->finger -= speed * 1e-3;
  return r;
}

static ride ride_at(double speed, double mass, double force) {
  ride x = {.d = 0.014, .v = speed, .finger = 0.013, .mass = mass, .force = force};
  x.facts = facts_of(mass, force, 0);
  return x;
}

/* Braking begins v^2/(2a) + d_l/2 before the place aimed at, a = effort F/m and d_l = a/rate^2, within a tick's way;
   and the ring stands at that place. */
TEST_LOOP(test_curve, 0, 4) {
  const double speeds[] = {0.1, 0.2, 0.4, 0.6};
  double v = speeds[_i], mass = 0.12, force = 5, a = p[param("effort")] * force / mass, rate = p[param("rate")];
  ride x = ride_at(v, mass, force);
  double began = NAN;
  for (int i = 0; i < 400 && !(fabs(x.v) < 1e-4); i++) {
    double d = x.d;
    if (tick(&x, isnan(began) ? v : 1e-3, mass).state == ETHD_BRAKING && isnan(began)) began = d;
  }
  double closed = v * v / (2 * a) + a / (rate * rate) / 2 - p[param("aim")];
  if (rate * a / (rate * rate) > v) closed = v / rate - p[param("aim")]; /* within the linear end */
  ck_assert_msg(began > closed - v * 1e-3 && began < closed + 1.5 * v * 1e-3, "begins at %g m, %g +- a tick", began,
                closed);
  ck_assert_double_eq_tol(x.d, -p[param("aim")], 3e-5);
}

/* The approach begins where the ring can still be led by l, at a quarter of its acceleration, and then be braked. */
TEST_LOOP(test_approach, 0, 8) {
  const double v = 0.1 * (1 + _i), mass = 0.12, force = 5, delay = 2e-3;
  const double a = p[param("effort")] * force / mass, stop = v * (delay + 1e-3) + v * v / (2 * a) + p[param("margin")];
  const double lead = fmin(fmax(stop - 0.0045, 0), 0.0045 / 2), most = stop + 2 * v * 2 * sqrt(lead / a);
  for (double d = 0.1; d > stop; d -= 1e-4) {
    ride x = {.d = d, .v = v, .finger = d - 0.0045, .mass = mass, .force = force};
    x.facts = facts_of(mass, force, 0);
    x.facts.viscous = 0.1; /* is made up for by a feed */
    x.facts.delay = delay;
    const ethd_contact c = contact_of(&x, v);
    const ethd_ruling r = rule(x.state, &c);
    if (r.state != ETHD_TRANSPARENT || fabs(d - most) < 1e-9) continue;
    ck_assert_double_eq_tol(r.feed, d < most ? 0.1 * v : 0, 1e-12);
    ck_assert_double_eq_tol(r.lead, d < most ? lead : 0, 1e-12);
  }
}

/* v* = sqrt(2 a g): below it the ring stands before the finger is at the rim, above it it doesn't. */
TEST(test_limit_speed) {
  double mass = 0.12, force = 5, a = p[param("effort")] * force / mass, lag = 0.001, gap = 0.0045 - lag;
  double limit = sqrt(2 * a * gap);
  for (int above = 0; above < 2; above++) {
    double v = limit * (above ? 1.15 : 0.85);
    ride x = ride_at(v, mass, force);
    x.finger = x.d - lag;
    double rim = 0;
    for (int i = 0; i < 100 && x.v > 0.02; i++) {
      tick(&x, v, mass);
      rim = x.finger - x.d + 0.0045; /* way between finger and rim, m */
    }
    ck_assert_msg(above ? rim < 0 : rim > 0, "%g m/s, v* %g: %g m left as the ring stands", v, limit, rim);
  }
}

/* The hold: pushed aside by a millimetre the ring comes back to where it was held, while no finger is there. */
TEST(test_hold) {
  ride x = ride_at(0.2, 0.12, 5);
  for (int i = 0; i < 110; i++) tick(&x, i < 60 ? 0.2 : 1e-3, 0.12);
  ck_assert_double_eq_tol(x.d, -p[param("aim")], 3e-5);
  p[param("t_max")] = INFINITY;
  x.d += 1e-3;
  for (int i = 0; i < 40; i++) ck_assert_int_eq(tick(&x, 1e-3, 0.12).state, ETHD_BRAKING);
  ck_assert_double_eq_tol(x.d, -p[param("aim")], 1e-4);
}

/* A ring 30 % heavier than the facts say: after some brakings k = 1/1.3, and the facts are right after all. */
TEST(test_learning) {
  p[param("learn")] = 0.3;
  double kept[ETHD_MEMORY] = {0};
  for (int tap = 0; tap < 8; tap++) {
    ride x = ride_at(0.4, 0.12, 5);
    memcpy(memory, kept, sizeof kept);
    for (int i = 0; i < 120; i++) tick(&x, i < 34 ? 0.4 : 1e-3, 1.3 * 0.12);
    memcpy(kept, memory, sizeof kept);
  }
  ck_assert_double_eq_tol(kept[0] / kept[1], 1 / 1.3, 0.03);
  p[param("learn")] = 0;
  ride x = ride_at(0.4, 0.12, 5);
  for (int i = 0; i < 120; i++) tick(&x, i < 34 ? 0.4 : 1e-3, 0.12);
  for (size_t i = 0; i < ETHD_MEMORY; i++) ck_assert(memory[i] == 0); /* no learning unless it is asked for */
}

/* A finger that turns back while the ring still brakes ends the braking; what the ring did until then is learnt. */
TEST(test_learns_though_the_finger_leaves) {
  p[param("learn")] = 0.3;
  ride x = ride_at(0.4, 0.12, 5);
  int braked = 0;
  for (int i = 0; i < 100 && braked < 10; i++) braked += tick(&x, 0.4, 0.12).state == ETHD_BRAKING;
  ck_assert_msg(braked == 10 && x.v > 2 * p[param("v_th")] && memory[1] == 0, "%d ticks, %g m/s, %g", braked, x.v,
                memory[1]);
  ck_assert_int_ne(tick(&x, -0.1, 0.12).state, ETHD_BRAKING);
  ck_assert(memory[1] > 0);
  ck_assert_double_eq_tol(memory[0] / memory[1], 1, 0.05);
}

/* A ring that is much heavier or lighter than it was taken for isn't learnt from; nor one whose speed isn't halved. */
TEST_LOOP(test_learns_nothing_from_strangers, 0, 3) {
  p[param("learn")] = 0.3;
  const double masses[] = {9, 0.1};
  p[param("t_max")] = INFINITY;
  ride x = ride_at(0.4, 0.12, 5);
  for (int i = 0; i < 600; i++) {
    if (_i == 2) x.v = 0.4;              /* pushed on by more than it brakes with, and the finger is faster */
    if (_i == 0) x.finger = x.d - 0.001; /* it goes on for so long that the finger has to go along */
    tick(&x, _i == 2 ? 0.6 : _i == 0 ? fmax(x.v, 1e-3) : i < 34 ? 0.4 : 1e-3, (_i < 2 ? masses[_i] : 1) * 0.12);
  }
  ck_assert_msg(memory[0] == 0 && memory[1] == 0, "%g of %g", memory[0], memory[1]);
}

/* A ring of a quarter of its mass is learnt to be lighter; from one of a tenth, which would be fourfold, nothing is. */
TEST(test_learns_no_more_than_fourfold) {
  double kept[ETHD_MEMORY] = {0};
  int learnt = 0, refused = 0;
  p[param("learn")] = 0.3;
  for (int tap = 0; tap < 60; tap++) {
    ride x = ride_at(0.4, 0.12, 5);
    memcpy(memory, kept, sizeof kept);
    for (int i = 0; i < 120; i++) tick(&x, i < 34 ? 0.4 : 1e-3, (tap % 2 ? 0.1 : 0.25) * 0.12);
    if (memcmp(memory, kept, sizeof kept) == 0)
      refused++;
    else
      learnt++;
    memcpy(kept, memory, sizeof kept);
    ck_assert_double_lt(kept[0], 4 * (kept[1] + 1e-6));
  }
  ck_assert_msg(learnt > 0 && refused > 0, "%d learnt, %d refused", learnt, refused);
}

/* Without facts, with any one of those it needs unknown, or without a finger, it is offset to the bit. */
TEST_LOOP(test_is_offset_when_blind, 0, 8) {
  ethd_facts facts = facts_of(0.12, 5, 0.4);
  const ethd_facts *given = &facts;
  if (_i == 0) given = NULL;
  if (_i == 1) facts.mass = NAN;
  if (_i == 2) facts.force = INFINITY;
  if (_i == 3) facts.force = 0;
  if (_i == 4) facts.finger_age = NAN;
  if (_i == 5) facts.mass = INFINITY;
  if (_i == 6) facts.mass = 0;
  if (_i == 7) facts.finger_age = -1;
  double a[ETHD_STATE_MAX / sizeof(double)] = {0}, b[ETHD_STATE_MAX / sizeof(double)] = {0}, q[ETHD_PARAMS_MAX];
  ethd_params_default(ethd_transition_offset.law.params, ethd_transition_offset.law.param_count, q);
  for (int i = 0; i < 400; i++) {
    double w = 0.02 * i, d = 4e-3 * cos(w), v = 0.08 * sin(w);
    ethd_contact c = {{0, 0, 0}, {-1, 0, 0}, d, d + 1e-3, d - 3e-3, v, v, 2.5e-3, 1e-3, 0, 0, 0, given};
    ethd_ruling r = rule(a, &c), o = {.beta = 1, .argument = c.d_fe};
    ck_assert_int_eq(ethd_transition_offset.step(q, b, &c, &o), ETHD_OK);
    ck_assert(memcmp(&r, &o, sizeof r) == 0);
  }
}

/* Unknown friction and delay are none, not a reason to be blind. */
TEST(test_unknown_friction) {
  ride x = ride_at(0.3, 0.12, 5);
  x.facts.friction = x.facts.viscous = x.facts.delay = NAN;
  int braked = 0;
  for (int i = 0; i < 46; i++) braked |= tick(&x, 0.3, 0.12).state == ETHD_BRAKING && x.d > 5e-4;
  ck_assert(braked);
}

/* Numbers of any kind: what it rules stays possible, and its force within what the guard lets through. */
TEST_LOOP(test_any_input, 0, 4) {
  const double odd[] = {0, 1e-9, -1e-9, 1e-4, -1e-4, 3e-3, -3e-3, 0.05, -0.05, 1, -1, 1e3, -1e3};
  enum { ODD = sizeof odd / sizeof *odd };
  double state[ETHD_STATE_MAX / sizeof(double)] = {0};
  unsigned seed = 12345u + (unsigned)_i;
  for (int i = 0; i < 20000; i++) {
    double x[8];
    for (int k = 0; k < 8; k++)
      x[k] = odd[(seed = seed * 1664525u + 1013904223u) >> 8 & 0xffff ? (seed >> 8) % ODD : 0];
    ethd_facts facts = facts_of(fabs(x[0]) + 1e-3, fabs(x[1]) + 1e-3, fabs(x[2]));
    facts.applied = x[3];
    facts.finger_age = fabs(x[4]);
    ethd_contact c = {{0, 0, 0}, {-1, 0, 0}, x[5], x[5] + x[6],           x[6], x[7], x[4], 2.5e-3, i % 97 ? 1e-3 : 0.5,
                      0,         0,          0,    i % 13 ? &facts : NULL};
    ethd_ruling r = rule(state, &c);
    if (r.state == ETHD_BRAKING) ck_assert(fabs(r.feed) <= facts.force);
    if (i % 501 == 0) memset(state, 0, sizeof state);
  }
}

/* ---- in the controller ---- */

/* It is asked from the range on, and no other law before d_beta. */
TEST(test_range) {
  rig r;
  for (int looks = 0; looks < 2; looks++) {
    rig_open(&r, RIG_WALL);
    if (looks) ethd_setup_transition(&r.setup, &ethd_transition_predictive);
    rig_start(&r);
    motion m = rig_at(0.0299, 0.5, 0);
    ck_assert_int_eq(rig_step(&r, &m)->contacts, looks);
    m = rig_at(0.0301, 0.5, 0);
    ck_assert_int_eq(rig_step(&r, &m)->contacts, 0);
    rig_close(&r);
  }
}

FIXTURE(set_up, NULL)
