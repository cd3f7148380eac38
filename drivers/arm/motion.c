#include "arm/motion.h"

#include <math.h>
#include <string.h>

#define LEVER 0.2   /* m: weight of a plate's rotation, rad, against its point's motion, m */
#define TURN_MOST 1 /* rad/s: limit of a plate's rotation, so that the joints can still move its point */
#define DRAWN 0.1   /* of a joint's speed: limit of the motion towards the posture */
#define NEAR 1e-14  /* m */
#define CORRECTIONS 4
#define HALVINGS 14      /* in the search for a largest share, so that joints of small acceleration move, too */
#define ALMOST_NONE 1e-9 /* rad or m for each m along n: a smaller motion limits nothing */

static uint32_t rows_of(const ethd__arm_table *table) { return table->turn > 0 ? 5 : 3; }

/* Fills two unit vectors at right angles to `f` and to each other. */
static void across_of(ethd_vec3 f, double out[2][3]) {
  const double x = fabs(f.x), y = fabs(f.y), z = fabs(f.z);
  const ethd_vec3 other = {x <= y && x <= z, y < x && y <= z, z < x && z < y};
  const ethd_vec3 one = ethd_vec3_cross(f, other), first = ethd_vec3_scale(1 / ethd_vec3_norm(one), one);
  ethd_vec3_put(first, out[0]);
  ethd_vec3_put(ethd_vec3_cross(f, first), out[1]);
}

/* Computes all values that depend only on q. */
static void arrive(ethd__arm_motion *m) {
  const uint32_t count = m->table->limits.count;
  double j[ETHD__TASK_MAX][ETHD_JOINTS_MAX];
  ethd__linkage_place(&m->table->linkage, m->q, &m->tool);
  across_of(m->tool.facing, m->across);
  for (uint32_t i = 0; i < count; i++) {
    j[0][i] = m->tool.j[i].x;
    j[1][i] = m->tool.j[i].y;
    j[2][i] = m->tool.j[i].z;
    for (int k = 0; k < 2; k++) j[3 + k][i] = LEVER * ethd_vec3_dot(ethd_vec3_of(m->across[k]), m->tool.axis[i]);
  }
  ethd__inverse_make(j, rows_of(m->table), count, m->table->singular, &m->inverse);
}

void ethd__arm_motion_start(const ethd__arm_table *table, const double *q, ethd__arm_motion *out) {
  memset(out, 0, sizeof *out);
  out->table = table;
  memcpy(out->q, q ? q : table->posture, table->limits.count * sizeof *out->q);
  arrive(out);
}

/* Moves to q + T dq. */
static void go(ethd__arm_motion *m, const double *dq) {
  const double T = m->table->limits.period;
  const ethd_vec3 was = m->tool.x;
  for (uint32_t i = 0; i < m->table->limits.count; i++) {
    m->dq[i] = dq[i];
    m->q[i] += T * dq[i];
  }
  arrive(m);
  m->v = ethd_vec3_scale(1 / T, ethd_vec3_sub(m->tool.x, was));
}

/* Fills the task: v, and the plate's shortest rotation to `normal`. */
static void task_of(const ethd__arm_motion *m, ethd_vec3 v, const double *normal, double task[ETHD__TASK_MAX]) {
  ethd_vec3 turn = {0, 0, 0};
  ethd_vec3_put(v, task);
  if (normal) {
    const ethd_vec3 n = ethd_vec3_of(normal), axis = ethd_vec3_cross(m->tool.facing, n);
    const double sine = ethd_vec3_norm(axis), far = ethd_vec3_dot(m->tool.facing, n) < 0 ? 1 : sine;
    if (sine > NEAR) turn = ethd_vec3_scale(fmin(m->table->turn * far, TURN_MOST) / sine, axis);
  }
  for (int k = 0; k < 2; k++) task[3 + k] = LEVER * ethd_vec3_dot(ethd_vec3_of(m->across[k]), turn);
}

static void draw_to_posture(const ethd__arm_motion *m, double *dq) {
  const ethd__arm_table *t = m->table;
  double pull[ETHD_JOINTS_MAX];
  for (uint32_t i = 0; i < t->limits.count; i++) {
    const double most = DRAWN * t->limits.joint[i].speed;
    pull[i] = fmax(-most, fmin(most, t->pull * (t->posture[i] - m->q[i])));
  }
  ethd__inverse_free(&m->inverse, pull);
  for (uint32_t i = 0; i < t->limits.count; i++) dq[i] += pull[i];
}

/* Corrects dq until the point moves by exactly T J dq. */
static void straighten(const ethd__arm_motion *m, double *dq) {
  const ethd__arm_table *t = m->table;
  const double T = t->limits.period;
  const ethd_vec3 to = ethd_vec3_add(m->tool.x, ethd_vec3_scale(T, ethd__linkage_sum(m->tool.j, dq, t->limits.count)));
  for (int k = 0; k < CORRECTIONS; k++) {
    ethd__tool there;
    double q[ETHD_JOINTS_MAX], task[ETHD__TASK_MAX] = {0}, more[ETHD_JOINTS_MAX];
    for (uint32_t i = 0; i < t->limits.count; i++) q[i] = m->q[i] + T * dq[i];
    ethd__linkage_place(&t->linkage, q, &there);
    const ethd_vec3 off = ethd_vec3_sub(to, there.x);
    if (ethd_vec3_norm(off) <= NEAR) return;
    ethd_vec3_put(ethd_vec3_scale(1 / T, off), task);
    ethd__inverse_solve(&m->inverse, task, more);
    for (uint32_t i = 0; i < t->limits.count; i++) dq[i] += more[i];
  }
}

/* The point comes first: from the present speeds, those that change its velocity alone; then as much of the rest, the
   plate's rotation and the motion to the posture, as binds no joint. */
static void prefer_point(const ethd__arm_motion *m, ethd_vec3 v, double *dq) {
  const uint32_t count = m->table->limits.count;
  const ethd_joint_limits *limits = &m->table->limits;
  double task[ETHD__TASK_MAX] = {0}, base[ETHD_JOINTS_MAX], bounded[ETHD_JOINTS_MAX], share = 0;
  ethd_vec3_put(ethd_vec3_sub(v, ethd__linkage_sum(m->tool.j, m->dq, count)), task);
  ethd__inverse_solve(&m->inverse, task, base);
  for (uint32_t i = 0; i < count; i++) bounded[i] = base[i] += m->dq[i];
  const bool is_free = ethd_guard_joints(limits, m->q, m->dq, bounded).joint < 0;
  for (int k = 1; is_free && k <= HALVINGS; k++) {
    double more[ETHD_JOINTS_MAX];
    for (uint32_t i = 0; i < count; i++) more[i] = base[i] + (share + ldexp(1, -k)) * (dq[i] - base[i]);
    if (ethd_guard_joints(limits, m->q, m->dq, more).joint < 0) share += ldexp(1, -k);
  }
  for (uint32_t i = 0; i < count; i++) dq[i] = is_free ? base[i] + share * (dq[i] - base[i]) : bounded[i];
}

ethd_joints_ruling ethd__arm_motion_step(ethd__arm_motion *m, ethd_vec3 v, const double *normal) {
  double task[ETHD__TASK_MAX], dq[ETHD_JOINTS_MAX], bounded[ETHD_JOINTS_MAX];
  task_of(m, v, normal, task);
  ethd__inverse_solve(&m->inverse, task, dq);
  draw_to_posture(m, dq);
  memcpy(bounded, dq, sizeof bounded);
  ethd_joints_ruling ruling = ethd_guard_joints(&m->table->limits, m->q, m->dq, bounded);
  if (ruling.joint >= 0) prefer_point(m, v, dq);
  straighten(m, dq);
  const ethd_joints_ruling last = ethd_guard_joints(&m->table->limits, m->q, m->dq, dq);
  if (ruling.joint < 0) ruling = last;
  go(m, dq);
  return ruling;
}

void ethd__arm_motion_stop(ethd__arm_motion *m) {
  const ethd_joint_limits *l = &m->table->limits;
  double dq[ETHD_JOINTS_MAX], periods = 1;
  for (uint32_t i = 0; i < l->count; i++)
    periods = fmax(periods, fabs(m->dq[i]) / (l->joint[i].acceleration * l->period));
  for (uint32_t i = 0; i < l->count; i++) dq[i] = m->dq[i] * (1 - 1 / periods);
  (void)ethd_guard_joints(l, m->q, m->dq, dq);
  go(m, dq);
}

ethd_ability ethd__arm_motion_able(const ethd__arm_motion *m, ethd_vec3 n) {
  const ethd__arm_table *t = m->table;
  const double task[ETHD__TASK_MAX] = {n.x, n.y, n.z, 0, 0};
  double dq[ETHD_JOINTS_MAX];
  ethd_ability able = ethd_ability_unknown();
  able.force = (double)INFINITY;
  able.delay = t->servo.delay + 2 * t->servo.damping / t->servo.frequency;
  ethd__inverse_solve(&m->inverse, task, dq);
  /* near a singularity the point moves less than n */
  const double along = fmax(0, ethd_vec3_dot(n, ethd__linkage_sum(m->tool.j, dq, t->limits.count)));
  able.speed = able.acceleration = along > ALMOST_NONE ? (double)INFINITY : 0;
  for (uint32_t i = 0; i < t->limits.count; i++) {
    const ethd_joint_limit *j = &t->limits.joint[i];
    const double moves = fabs(dq[i]), lever = fabs(ethd_vec3_dot(n, m->tool.j[i]));
    if (moves > ALMOST_NONE) {
      able.speed = fmin(able.speed, along * j->speed / moves);
      able.acceleration = fmin(able.acceleration, along * j->acceleration / moves);
    }
    if (lever > ALMOST_NONE) able.force = fmin(able.force, j->torque / lever);
  }
  return able;
}
