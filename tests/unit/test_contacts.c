/* Several contacts, thin walls, materials: what counts, for how long, and what its state is. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "unit/rig.h"

static void close_to(double got, double want) { ck_assert_double_eq_tol(got, want, 1e-10); }

/* Ring and finger together at x, moving with v. */
static motion at(double x, double y, double vx, double vy) { return (motion){{x, y}, {vx, vy}, {x, y}, {vx, vy}}; }

/* ---- several ---- */

/* A concave corner of one object: two contacts, each with a machine of its own. */
static const char corner[] = "polygon 0 0 0.6 0 0.6 0.238 0.238 0.238 0.238 0.6 0 0.6\n";

TEST(test_corner) {
  rig r;
  rig_begin(&r, corner, &ethd_transition_smooth);
  motion m = at(0.249, 0.248, -0.1, 0.2);
  const ethd_trace *t = rig_step(&r, &m);
  ck_assert_int_eq(t->contacts, 2);
  close_to(t->fe[0], 2500 * 0.001 + 45 * 0.1);
  close_to(t->fe[1], 2500 * 0.002); /* on its way out */
  close_to(t->d_re, -0.002);
  close_to(t->beta, 0.1 + 0.9 * 2.5 / 2.5);
  rig_close(&r);
}

TEST(test_corner_has_two_machines) {
  rig r;
  rig_begin(&r, corner, &ethd_transition_offset);
  motion m = at(0.249, 0.2505, -0.3, 0);
  rig_step(&r, &m); /* left wall: braking */
  m = at(0.2485, 0.2505, 0, 0);
  const ethd_trace *t = rig_step(&r, &m); /* at rest: vo with eps = 1.5 mm */
  ck_assert_int_eq(t->state, ETHD_VO);
  m = at(0.248, 0.247, -0.1, -0.3);
  t = rig_step(&r, &m); /* floor: braking, the deepest; left wall: 0.5 mm behind its x_eps */
  ck_assert(t->state == ETHD_BRAKING && t->eps == 0 && t->contacts == 2);
  close_to(t->d_re, -0.003);
  close_to(t->fe[0], 2500 * 0.0005 + 45 * 0.1);
  close_to(t->fd[0], 0);
  close_to(t->fe[1], 0);
  close_to(t->fd[1], 100 * 0.3);
  rig_close(&r);
}

/* A channel of one object, a little wider than the ring and d_beta on both sides: when one wall is left
   and the other met at the same tick, the second begins anew. */
TEST(test_state_stays_with_its_wall) {
  rig r;
  rig_begin(&r, "polygon 0.1 0.1 0.4 0.1 0.4 0.5 0.26705 0.5 0.26705 0.15 0.238 0.15 0.238 0.5 0.1 0.5\n",
            &ethd_transition_offset);
  motion m = at(0.249, 0.25, -0.3, 0);
  ck_assert_int_eq(rig_step(&r, &m)->state, ETHD_BRAKING);
  m = at(0.2495, 0.25, 0, 0);
  ck_assert_int_eq(rig_step(&r, &m)->state, ETHD_VO);
  m = at(0.2527, 0.25, 0.3, 0);
  const ethd_trace *t = rig_step(&r, &m);
  close_to(t->d_re, 0.26705 - 0.2527 - 0.012);
  ck_assert(t->state == ETHD_TRANSPARENT && t->eps == 0 && t->contacts == 1);
  m = at(0.2552, 0.25, 0.3, 0);
  ck_assert_int_eq(rig_step(&r, &m)->state, ETHD_BRAKING);
  rig_close(&r);
}

/* What two contacts say, together: forces add, the smaller beta and its lead count. */
static ethd_status saying_step(const double *p, void *state, const ethd_contact *c, ethd_ruling *out) ETHD_RT {
  (void)p, (void)state;
  out->state = ETHD_VO;
  out->beta = c->object ? 0.25 : 0.5;
  out->lead = c->object ? -0.002 : 0.001;
  out->share = c->object ? 0.5 : 1;
  out->offset = c->object ? 0 : 0.0005;
  out->damping = c->object ? 10 : 0;
  out->feed = c->object ? 0 : -2;
  return ETHD_OK;
}

static const ethd_transition_law saying = {
    .law = {sizeof(ethd_transition_law), ETHD_ABI, ETHD_TRANSITION, 0, "saying", "says it all", NULL, 0, NULL, NULL},
    .step = saying_step,
};

TEST(test_rulings_together) {
  for (int swapped = 0; swapped < 2; swapped++) { /* whichever is the deeper */
    rig r;
    rig_begin(&r, RIG_WALL "halfplane 0 -1 -0.238\n", &saying);
    double dx = swapped ? -0.001 : -0.003, dy = swapped ? -0.003 : -0.001;
    motion m = {{0.25 + dx, 0.25 + dy}, {0.1, -0.2}, {0.25 + dx, 0.25 + dy}, {0.1, -0.2}};
    const ethd_trace *t = rig_step(&r, &m);
    ck_assert_int_eq(t->object, swapped);
    close_to(t->fe[0], 2500 * (-dx - 0.0005) + 2);
    close_to(t->fe[1], 0.5 * (2500 * -dy + 45 * 0.2));
    close_to(t->fd[0], 0);
    close_to(t->fd[1], 10 * 0.2);
    close_to(t->beta, 0.25);
    /* the finger stands at the ring, so eps_q is the lead's alone: J eps_q = (0, 2 mm) */
    double a = t->sense.q[0], b = t->sense.q[1];
    close_to(-0.25 * (sin(a) * t->eps_q[0] + sin(b) * t->eps_q[1]), 0);
    close_to(0.25 * (cos(a) * t->eps_q[0] + cos(b) * t->eps_q[1]), 0.002);
    rig_close(&r);
  }
}

/* Equal depths: the lower object is shown. */
TEST(test_order_of_equals) {
  rig r;
  rig_begin(&r, "halfplane 0 1 0.9\n" RIG_WALL RIG_WALL, &ethd_transition_smooth);
  motion m = at(0.249, 0.25, 0, 0);
  const ethd_trace *t = rig_step(&r, &m);
  ck_assert(t->object == 1 && t->contacts == 2 && t->overflow == 0);
  close_to(t->fe[0], 5);
  rig_close(&r);
}

/* ---- too many ---- */

/* `count` walls on the left, each 0.1 mm behind the one before. */
static const char *stack_of(int count, const char *more) {
  static char text[4096];
  size_t n = 0;
  for (int i = 0; i < count; i++)
    n += (size_t)snprintf(text + n, sizeof text - n, "halfplane -1 0 %.17g\n", -0.238 + 1e-4 * i);
  snprintf(text + n, sizeof text - n, "%s", more);
  return text;
}

TEST_LOOP(test_overflow_keeps_the_deepest, 0, 6) {
  const int counts[] = {8, 9, 10, 16, 17, 30};
  int walls = counts[_i];
  rig r;
  rig_begin(&r, stack_of(walls, ""), &ethd_transition_smooth);
  for (int tick = 1; tick <= 3; tick++) {
    motion m = at(0.247, 0.25, 0.01, 0);
    const ethd_trace *t = rig_step(&r, &m);
    ck_assert_int_eq(t->contacts, 8);
    ck_assert_int_eq(t->overflow, walls - 8);
    close_to(t->fe[0], 2500 * (8 * 0.003 - 1e-4 * (7 * 8 / 2)));
    ethd_counters c;
    ethd_control_counters(r.control, &c);
    ck_assert_uint_eq(c.contacts_lost, (uint64_t)(tick * (walls - 8)));
  }
  rig_close(&r);
}

/* Eight are there when a ninth becomes the deepest: it takes the shallowest one's place. */
TEST(test_newcomer_that_is_deeper) {
  rig r;
  rig_begin(&r, stack_of(8, "halfplane 0 -1 -0.238\n"), &ethd_transition_smooth);
  motion m = at(0.249, 0.256, 0, 0);
  ck_assert_int_eq(rig_step(&r, &m)->overflow, 0);
  m = at(0.249, 0.246, 0, 0);
  for (int tick = 0; tick < 2; tick++) {
    const ethd_trace *t = rig_step(&r, &m);
    ck_assert(t->contacts == 8 && t->overflow == 1 && t->object == 8);
    close_to(t->d_re, -0.004);
    close_to(t->fe[1], 10);
    close_to(t->fe[0], 2500 * (7 * 0.001 - 1e-4 * (6 * 7 / 2)));
  }
  m = at(0.249, 0.256, 0, 0); /* gone again: all eight are back */
  close_to(rig_step(&r, &m)->fe[0], 2500 * (8 * 0.001 - 1e-4 * (7 * 8 / 2)));
  rig_close(&r);
}

static double youngest, oldest;

static ethd_status aging_step(const double *p, void *state, const ethd_contact *c, ethd_ruling *out) ETHD_RT {
  if (c->object != 8 && c->age < youngest) youngest = c->age;
  if (c->age > oldest) oldest = c->age;
  return ethd_transition_smooth.step(p, state, c, out);
}

/* The newcomer ends the shallowest contact, and no other begins anew for it. */
TEST(test_newcomer_leaves_the_others) {
  ethd_transition_law aging = ethd_transition_smooth;
  aging.step = aging_step;
  rig r;
  rig_begin(&r, stack_of(8, "halfplane 0 -1 -0.238\n"), &aging);
  motion m = at(0.249, 0.256, 0, 0);
  for (int tick = 0; tick < 5; tick++) rig_step(&r, &m);
  m = at(0.249, 0.246, 0, 0);
  for (int tick = 0; tick < 3; tick++) {
    youngest = INFINITY;
    ck_assert_int_eq(rig_step(&r, &m)->object, 8);
    close_to(youngest, 1e-3 * (5 + tick));
  }
  rig_close(&r);
}

/* In a new scene that has the same walls each contact goes on, the second one as well, and so it does when the first
   one's wall is gone. */
TEST(test_new_scene_continues_each) {
  const char *const scenes[] = {"halfplane -1 0 -0.238\nhalfplane 0 -1 -0.238\n", "halfplane 0 -1 -0.238\n"};
  for (int k = 0; k < 2; k++) {
    ethd_transition_law aging = ethd_transition_smooth;
    aging.step = aging_step;
    rig r;
    rig_begin(&r, scenes[0], &aging);
    motion m = at(0.248, 0.249, 0, 0);
    for (int tick = 0; tick < 5; tick++) ck_assert_int_eq(rig_step(&r, &m)->contacts, 2);
    ethd_scene *other = rig_scene(scenes[k]);
    r.setup.scene = other;
    r.setup.swap_time = 0;
    rig_post(&r);
    for (int tick = 0; tick < 3; tick++) {
      youngest = INFINITY, oldest = -INFINITY;
      ck_assert_int_eq(rig_step(&r, &m)->contacts, 2 - k);
      close_to(youngest, 1e-3 * (5 + tick));
      close_to(oldest, 1e-3 * (5 + tick));
    }
    rig_close(&r);
    ethd_scene_destroy(other);
  }
}

/* ---- what counts ---- */

/* Not before d_re < d_beta (2.5 mm), or d_fe <= d_beta however far the finger is ahead. */
TEST(test_within_reach) {
  rig r;
  rig_begin(&r, RIG_WALL, &ethd_transition_smooth);
  motion m = rig_at(0.002501, 0, 0);
  const ethd_trace *t = rig_step(&r, &m);
  ck_assert(t->contacts == 0 && t->object == -1 && t->state == 0 && t->beta == 1 && t->queried == 1);
  ck_assert(isnan(t->d_re) && isnan(t->d_fe) && isnan(t->v_n) && t->eps == 0);
  m = rig_at(0.002499, 0, 0);
  t = rig_step(&r, &m);
  ck_assert(t->contacts == 1 && t->object == 0);
  close_to(t->d_re, 0.002499);
  m = rig_at(0.050, 0, 0.0519); /* d_fe = 50 - 51.9 + 4.5 mm */
  ck_assert_int_eq(rig_step(&r, &m)->contacts, 0);
  m = rig_at(0.050, 0, 0.0530);
  t = rig_step(&r, &m);
  ck_assert_int_eq(t->contacts, 1);
  close_to(t->d_fe, 0.0015);
  close_to(t->beta, 0.1 + 0.9 * 0.6);
  rig_close(&r);
}

/* The tangent line stands for the surface, for the finger too. */
TEST(test_circle) {
  rig r;
  rig_begin(&r, "circle 0.2 0.25 0.03\n", &ethd_transition_smooth);
  motion m = {{0.244, 0.25}, {-0.2, 0.7}, {0.245, 0.258}, {0, 0}};
  const ethd_trace *t = rig_step(&r, &m);
  close_to(t->d_re, 0.044 - 0.03 - 0.012);
  close_to(t->d_fe, 0.245 - 0.23 - 0.0075);
  close_to(t->v_n, 0.2);
  rig_close(&r);
}

TEST(test_no_scene_and_empty_scene) {
  for (int empty = 0; empty < 2; empty++) {
    rig r;
    rig_begin(&r, empty ? "# nothing\n" : NULL, &ethd_transition_offset);
    motion m = rig_at(-0.01, 0.3, 0.001);
    const ethd_trace *t = rig_step(&r, &m);
    ck_assert(t->contacts == 0 && t->beta == 1 && t->queried == empty);
    rig_close(&r);
  }
}

/* A contact lives until its state is transparent, however far away; its law is asked each tick. */
static ethd_status lingering_step(const double *p, void *state, const ethd_contact *c, ethd_ruling *out) ETHD_RT {
  double *ticks = state;
  (void)p;
  out->state = ++*ticks < 20 ? 5 : ETHD_TRANSPARENT;
  out->argument = c->age;
  out->feed = -1;
  return ETHD_OK;
}

static const ethd_transition_law lingering = {
    .law = {sizeof(ethd_transition_law), ETHD_ABI, ETHD_TRANSITION, sizeof(double), "lingering", "lives 20 ticks", NULL,
            0, NULL, NULL},
    .step = lingering_step,
};

TEST(test_contact_lives_out_of_reach) {
  rig r;
  rig_begin(&r, RIG_WALL "circle 0.25 0.35 0.01\n", &lingering);
  motion m = rig_at(0.001, 0, 0);
  for (int tick = 0; tick < 25; tick++) {
    const ethd_trace *t = rig_step(&r, &m);
    if (tick < 19) {
      ck_assert(t->contacts == 1 && t->state == 5 && t->object == 0);
      close_to(t->d_fe, 0.001 * tick); /* its age */
      close_to(t->fe[0], 1);           /* feed-forward, along n = (-1, 0) */
      close_to(t->d_re, m.x.x - 0.25);
    } else {
      ck_assert_int_eq(t->contacts, 0);
    }
    m = rig_at(0.1, 0, 0);
  }
  m = rig_at(0.001, 0, 0); /* a new one */
  ck_assert_int_eq(rig_step(&r, &m)->state, 5);
  rig_close(&r);
}

/* v_th goes first, far outside as well: eps < 0 for one tick. */
TEST(test_braking_that_ends_far_outside) {
  rig r;
  rig_begin(&r, RIG_WALL, &ethd_transition_offset);
  motion m = rig_at(-0.001, 0.4, 0);
  rig_step(&r, &m);
  m = rig_at(0.020, 0.01, 0);
  const ethd_trace *t = rig_step(&r, &m);
  ck_assert(t->state == ETHD_VO && t->contacts == 1);
  close_to(t->eps, -0.020);
  t = rig_step(&r, &m);
  ck_assert(t->state == ETHD_TRANSPARENT && t->contacts == 0 && t->eps == 0);
  rig_close(&r);
}

/* ---- thin walls ---- */

/* The default wall's place, but thin: from y = 0.1 to 0.4. */
static const char thin[] = "segment 0.238 0.1 0.238 0.4\n";

/* The side is the one on which the contact began, through the wall and out of reach behind it. */
TEST(test_thin_wall_remembers_its_side) {
  rig r;
  rig_begin(&r, thin, &ethd_transition_smooth);
  for (double d = 0.002; d > -0.1; d -= 0.004) {
    motion m = at(0.25 + d, 0.25, -4, 0);
    const ethd_trace *t = rig_step(&r, &m);
    close_to(t->d_re, d);
    close_to(t->v_n, 4);
    close_to(t->fe[0], d < 0 ? -2500 * d + 45 * 4 : 0);
  }
  motion m = at(0.25 - 0.1, 0.25, 4, 0); /* and back */
  close_to(rig_step(&r, &m)->fe[0], 250);
  m = at(0.25 + 0.001, 0.25, 4, 0);
  close_to(rig_step(&r, &m)->d_re, 0.001);
  rig_close(&r);
}

/* Behind it there is another wall; the thin one is the deeper. */
TEST(test_thin_wall_is_the_deepest) {
  rig r;
  rig_begin(&r, "segment 0.238 0.1 0.238 0.4\nhalfplane -1 0 -0.218\n", &ethd_transition_smooth);
  for (double x = 0.251; x > 0.22; x -= 0.005) {
    motion m = at(x, 0.25, 0, 0);
    const ethd_trace *t = rig_step(&r, &m);
    ck_assert_int_eq(t->object, 0);
    close_to(t->d_re, x - 0.25);
  }
  ck_assert_int_eq(r.trace.contacts, 2);
  rig_close(&r);
}

/* Begun on the left, it is a wall toward +x. */
TEST(test_thin_wall_from_behind) {
  rig r;
  rig_begin(&r, thin, &ethd_transition_smooth);
  motion m = at(0.226 - 0.001, 0.25, 0.1, 0);
  close_to(rig_step(&r, &m)->d_re, 0.001);
  m = at(0.226 + 0.020, 0.25, 0.1, 0);
  const ethd_trace *t = rig_step(&r, &m);
  close_to(t->d_re, -0.020);
  close_to(t->fe[0], -2500 * 0.020 - 45 * 0.1);
  rig_close(&r);
}

/* The finger is measured from the ring's side. */
TEST(test_thin_wall_and_a_finger_behind_it) {
  rig r;
  rig_begin(&r, thin, &ethd_transition_smooth);
  motion m = {{0.251, 0.25}, {0, 0}, {0.228, 0.25}, {0, 0}};
  const ethd_trace *t = rig_step(&r, &m);
  close_to(t->d_fe, 0.228 - 0.238 - 0.0075);
  ck_assert_double_eq(t->beta, 0.1);
  rig_close(&r);
}

/* Past an end the wall is a point; beyond it the other side is as good. */
TEST(test_thin_wall_round_an_end) {
  rig r;
  rig_begin(&r, thin, &ethd_transition_smooth);
  motion m = at(0.251, 0.395, 0, 0);
  close_to(rig_step(&r, &m)->d_re, 0.001);
  m = at(0.248, 0.4075, 0, 0); /* 10 and 7.5 mm from the end: 12.5 mm */
  const ethd_trace *t = rig_step(&r, &m);
  close_to(t->d_re, 0.0005);
  m = at(0.228, 0.4075, 0, 0);
  close_to(rig_step(&r, &m)->d_re, 0.0005);
  m = at(0.2265, 0.395, 0, 0);
  t = rig_step(&r, &m);
  close_to(t->d_re, -0.0005);
  close_to(t->fe[0], -2500 * 0.0005); /* pushed to the left */
  rig_close(&r);
}

/* ---- materials ---- */

TEST(test_materials) {
  rig r;
  rig_begin(&r,
            "material soft k_e=500 b_e=10\nmaterial hard k_e=9000\n" RIG_WALL
            "halfplane -1 0 -0.238 material=soft\nhalfplane 0 -1 -0.238 material=hard\n",
            &ethd_transition_smooth);
  motion m = at(0.248, 0.249, -0.1, -0.1);
  const ethd_trace *t = rig_step(&r, &m);
  close_to(t->fe[0], (2500 + 500) * 0.002 + (45 + 10) * 0.1);
  close_to(t->fe[1], 9000 * 0.001 + 45 * 0.1); /* b_e: the setup's */
  rig_close(&r);
}

TEST(test_materials_are_checked) {
  rig r;
  ethd_error error;
  rig_open(&r, "\nmaterial odd c_e=1\nhalfplane -1 0 -0.238\n");
  ck_assert_int_eq(ethd_control_create(&r.setup, &r.control, &error), ETHD_E_UNKNOWN);
  ck_assert_str_eq(error.name, "material.odd.c_e");
  ck_assert_int_eq(error.line, 2);
  ethd_setup_contact(&r.setup, &ethd_contact_hunt_crossley); /* it has a c_e */
  rig_start(&r);
  rig_close(&r);
  rig_open(&r, "material odd k_e=-1\n");
  ck_assert_int_eq(ethd_setup_check(&r.setup, &error), ETHD_E_RANGE);
  ck_assert_str_eq(error.name, "material.odd.k_e");
  ck_assert(error.found == -1 && error.min == 0);
  rig_close(&r);
}
