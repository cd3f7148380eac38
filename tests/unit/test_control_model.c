/* The controller's equations: a second derivation of the laws for flat walls, beside the library on
   random ticks. */
#include <math.h>
#include <string.h>

#include "unit/draw.h"
#include "unit/rig.h"

/* ---- second derivation ---- */

typedef struct wall {
  double nx, ny, c; /* object = {p : n.p > c} */
  int state;        /* of VO-B */
  double eps, braked;
  int leaving;
} wall;

typedef struct model {
  wall walls[4];
  int count;
  const ethd_setup *setup;
} model;

typedef struct answer {
  double tau[2], beta, fe[2], fd[2], eps, d_re, d_fe, v_n, x[2], v[2], eps_q[2], eps_q_dot[2];
  int state, contacts, object;
} answer;

/* R_0 from absolute link angles a, b, and back to the joints: tau = (dX/dq)^T F. */
static void to_joints(const ethd_arm *arm, const double q[2], double fx, double fy, double tau[2]) {
  int serial = arm->mechanism == ETHD_ARM_SERIAL;
  double a = q[0], b = serial ? q[0] + q[1] : q[1];
  double t1 = arm->link1 * (-sin(a) * fx + cos(a) * fy), t2 = arm->link2 * (-sin(b) * fx + cos(b) * fy);
  tau[0] = serial ? t1 + t2 : t1;
  tau[1] = t2;
}

static void to_plane(const ethd_arm *arm, const double q[2], const double dq[2], double x[2], double v[2]) {
  int serial = arm->mechanism == ETHD_ARM_SERIAL;
  double a = q[0], b = serial ? q[0] + q[1] : q[1], da = dq[0], db = serial ? dq[0] + dq[1] : dq[1];
  x[0] = arm->link1 * cos(a) + arm->link2 * cos(b);
  x[1] = arm->link1 * sin(a) + arm->link2 * sin(b);
  v[0] = -arm->link1 * sin(a) * da - arm->link2 * sin(b) * db;
  v[1] = arm->link1 * cos(a) * da + arm->link2 * cos(b) * db;
}

/* J e = d, by Cramer's rule on the columns of J. */
static void solve(const ethd_arm *arm, const double q[2], double dx, double dy, double e[2]) {
  double zero[2], c1[2], c2[2], one[2] = {1, 0}, two[2] = {0, 1};
  to_plane(arm, q, one, zero, c1);
  to_plane(arm, q, two, zero, c2);
  double det = c1[0] * c2[1] - c2[0] * c1[1];
  e[0] = (dx * c2[1] - c2[0] * dy) / det;
  e[1] = (c1[0] * dy - dx * c1[1]) / det;
}

static double slope(double beta_min, double d_beta, double d) {
  if (d > d_beta) return 1;
  return d > 0 ? beta_min + (1 - beta_min) * (d / d_beta) : beta_min;
}

static void machine(wall *w, const double *p, double d_re, double v, double d_beta, double period) {
  if (w->state == 0) {
    if (d_re < 0) w->state = 1, w->braked = 0;
  } else if (w->state == 1) {
    w->braked += period;
    if (fabs(v) < p[1] || (d_re <= d_beta && (-d_re >= p[3] || w->braked > p[4] - period / 2))) {
      w->state = 2;
      w->eps = -d_re;
    } else if (d_re > d_beta) {
      w->state = 0;
    }
  } else if (d_re > d_beta) {
    w->state = 0;
  }
  if (w->state != 2) w->eps = 0;
}

static void one_wall(model *m, int i, const ethd_sense *s, answer *a) {
  const ethd_setup *u = m->setup;
  wall *w = &m->walls[i];
  int abrupt = u->transition == &ethd_transition_abrupt, offset = u->transition == &ethd_transition_offset;
  double d_beta = u->ring_radius - u->finger_radius_max;
  double d_re = w->c - (w->nx * a->x[0] + w->ny * a->x[1]) - u->ring_radius;
  double d_fe = w->c - (w->nx * s->finger[0] + w->ny * s->finger[1]) - (offset ? u->ring_radius : u->finger_radius);
  double v = w->nx * a->v[0] + w->ny * a->v[1], beta, k = 0, b = 0;
  if (v > u->v_hysteresis) w->leaving = 0;
  if (v < -u->v_hysteresis) w->leaving = 1;
  if (offset)
    machine(w, u->transition_p, d_re, v, d_beta, u->period);
  else
    w->state = d_re < 0 ? 2 : 0;
  d_fe += w->eps;
  if (!(d_re < d_beta || d_fe <= d_beta || w->state != 0)) {
    w->leaving = 0;
    return;
  }
  beta = abrupt ? (d_re < 0 ? 0 : 1) : slope(u->transition_p[offset ? 2 : 0], d_beta, d_fe);
  if (beta < a->beta) a->beta = beta;
  if ((offset ? w->state == 2 : 1) && d_re + w->eps < 0) k = u->contact_p[0] * (d_re + w->eps);
  if (k < 0 && !w->leaving) k -= u->contact_p[1] * v;
  if (k > 0) k = 0;
  if (offset && w->state == 1) b = -u->transition_p[0] * v;
  a->fe[0] += k * w->nx, a->fe[1] += k * w->ny;
  a->fd[0] += b * w->nx, a->fd[1] += b * w->ny;
  if (a->contacts++ && !(d_re < a->d_re)) return;
  a->object = i;
  a->state = w->state;
  a->eps = w->eps;
  a->d_re = d_re;
  a->d_fe = d_fe;
  a->v_n = v;
}

static answer model_step(model *m, const ethd_sense *s) {
  const ethd_setup *u = m->setup;
  answer a;
  memset(&a, 0, sizeof a);
  a.beta = 1;
  a.object = -1;
  a.d_re = a.d_fe = a.v_n = NAN;
  to_plane(&u->arm, s->q, s->dq, a.x, a.v);
  for (int i = 0; i < m->count; i++) one_wall(m, i, s, &a);
  solve(&u->arm, s->q, s->finger[0] - a.x[0], s->finger[1] - a.x[1], a.eps_q);
  solve(&u->arm, s->q, s->finger_v[0] - a.v[0], s->finger_v[1] - a.v[1], a.eps_q_dot);
  to_joints(&u->arm, s->q, a.fe[0] + a.fd[0], a.fe[1] + a.fd[1], a.tau);
  for (int i = 0; i < 2; i++) a.tau[i] += a.beta * (u->tracking_p[0] * a.eps_q[i] + u->tracking_p[1] * a.eps_q_dot[i]);
  return a;
}

/* ---- both beside each other ---- */

static void near(const char *what, int tick, double got, double want, double tolerance) {
  if (isnan(got) && isnan(want)) return;
  if (!(fabs(got - want) <= tolerance)) ck_abort_msg("tick %d: %s is %.17g, not %.17g", tick, what, got, want);
}

static void compare(int tick, const ethd_trace *t, const answer *a) {
  for (int i = 0; i < 2; i++) {
    near("tau", tick, t->tau[i], a->tau[i], 1e-9);
    near("tau_raw", tick, t->tau_raw[i], a->tau[i], 1e-9);
    near("fe", tick, t->fe[i], a->fe[i], 1e-9);
    near("fd", tick, t->fd[i], a->fd[i], 1e-9);
    near("x", tick, t->x[i], a->x[i], 1e-15);
    near("v", tick, t->v[i], a->v[i], 1e-14);
    near("eps_q", tick, t->eps_q[i], a->eps_q[i], 1e-14);
    near("eps_q_dot", tick, t->eps_q_dot[i], a->eps_q_dot[i], 1e-12);
  }
  near("beta", tick, t->beta, a->beta, 1e-10);
  near("eps", tick, t->eps, a->eps, 1e-14);
  near("d_re", tick, t->d_re, a->d_re, 1e-14);
  near("d_fe", tick, t->d_fe, a->d_fe, 1e-14);
  near("v_n", tick, t->v_n, a->v_n, 1e-13);
  near("state", tick, (double)t->state, a->state, 0);
  near("contacts", tick, (double)t->contacts, a->contacts, 0);
  near("object", tick, (double)t->object, (double)a->object, 0);
}

static const char four[] = RIG_WALL "halfplane 1 0 0.272\nhalfplane 0 -1 -0.236\nhalfplane 0.6 0.8 0.37\n";

static model model_of(const ethd_setup *setup, int walls) {
  model m = {.walls = {{-1, 0, -0.238, 0, 0, 0, 0},
                       {1, 0, 0.272, 0, 0, 0, 0},
                       {0, -1, -0.236, 0, 0, 0, 0},
                       {0.6, 0.8, 0.37, 0, 0, 0, 0}},
             .count = walls,
             .setup = setup};
  return m;
}

/* A wander of some mm about the corner, slow phases included so that braking ends every way it can. */
static motion wander(uint64_t seed, int tick) {
  double t = 0.001 * tick, slow = draw(seed * 64 + (uint64_t)(tick / 97), 0, 1);
  double w = 0.15 + slow * slow * 12, r = 0.002 + 0.006 * draw(seed * 64 + 40, 0, 1);
  uint64_t n = seed * 100000 + (uint64_t)tick;
  double speed = (draw(n, 0, 1) < 0.02 ? 0.6 : 0.15 * slow) * (sin(3 * w * t) < 0 ? -1 : 1);
  motion m;
  m.x = (ethd_vec){0.2525 + r * sin(w * t + (double)seed), 0.249 + r * cos(1.3 * w * t)};
  m.v = (ethd_vec){speed * draw(n + 50000, -0.1, 1), speed * draw(n + 51000, -0.1, 1)};
  m.xf = (ethd_vec){m.x.x + draw(n + 52000, -3e-3, 3e-3), m.x.y + draw(n + 53000, -3e-3, 3e-3)};
  m.vf = (ethd_vec){draw(n + 54000, -0.5, 0.5), draw(n + 55000, -0.5, 0.5)};
  return m;
}

static const ethd_transition_law *const strategies[] = {&ethd_transition_abrupt, &ethd_transition_smooth,
                                                        &ethd_transition_offset};

/* _i: mechanism, one wall or four, strategy, preset or the product's caps with a hysteresis. */
TEST_LOOP(test_against_second_derivation, 0, 24) {
  int serial = _i & 1, walls = _i & 2 ? 4 : 1, product = _i & 4, seen[3] = {0};
  rig r;
  rig_open(&r, walls == 4 ? four : RIG_WALL);
  r.setup.arm = (ethd_arm){serial ? ETHD_ARM_SERIAL : ETHD_ARM_PARALLEL, 0.25, serial ? 0.22 : 0.25};
  ethd_setup_transition(&r.setup, strategies[_i / 8]);
  if (product) r.setup.v_hysteresis = 0.01;
  if (!product && _i / 8 == 2) r.setup.transition_p[3] = r.setup.transition_p[4] = INFINITY;
  if (product && _i / 8 == 2) r.setup.transition_p[3] = 0.003, r.setup.transition_p[4] = 0.020;
  rig_start(&r);
  model m = model_of(&r.setup, walls);
  for (int tick = 0; tick < 20000; tick++) {
    motion w = wander((uint64_t)_i, tick);
    const ethd_trace *t = rig_step(&r, &w);
    answer a = model_step(&m, &r.sense);
    compare(tick, t, &a);
    ck_assert_mem_eq(t->tau, r.command.torque, sizeof t->tau);
    if (t->contacts) seen[t->state]++;
  }
  ck_assert_msg(seen[0] > 500 && (_i / 8 < 2 || seen[1] > 100) && seen[2] > 500, "ticks by state: %d %d %d", seen[0],
                seen[1], seen[2]);
  rig_close(&r);
}
