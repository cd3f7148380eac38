/* From a tool's velocity to joint speeds: the point goes straight, what it leaves free doesn't move it, no joint goes
   beyond its limits, and near a singularity nothing grows. */
#include "arm/motion.h"

#include <math.h>

#include "draw.h"
#include "unit/arm_tables.h"

static ethd__arm_table table;
static ethd__arm_motion m;

static double apart(ethd_vec3 a, ethd_vec3 b) { return ethd_vec3_norm(ethd_vec3_sub(a, b)); }

static void begin(const char *name, const double *q) {
  arm_table(name, "", &table);
  ethd__arm_motion_start(&table, q, &m);
}

/* Ten periods of any motion within what the limits allow, of which the guard takes nothing. */
TEST_LOOP(test_straight, 0, ARMS) {
  begin(arm_names[_i], NULL);
  const ethd_vec3 from = m.tool.x, v = {0.06, _i == 3 ? 0.05 : -0.03, _i == 3 ? 0 : 0.05};
  double normal[3], time = 0;
  ethd_vec3_put(m.tool.facing, normal);
  for (int k = 0; time < 1; k++) {
    const double rise = fmin(1, 0.002 * k); /* gently: the joints' accelerations bound nothing */
    const ethd_vec3 was = m.tool.x;
    const ethd_joints_ruling r = ethd__arm_motion_step(&m, ethd_vec3_scale(rise, v), normal);
    ck_assert_int_eq(r.bound, ETHD_JOINTS_FREE);
    const ethd_vec3 went = ethd_vec3_sub(m.tool.x, was);
    if (!(apart(went, ethd_vec3_scale(table.limits.period * rise, v)) <= 1e-13)) ck_abort_msg("a tick leaves the line");
    ck_assert(apart(m.v, ethd_vec3_scale(1 / table.limits.period, went)) == 0);
    time += table.limits.period;
  }
  const ethd_vec3 way = ethd_vec3_sub(m.tool.x, from);
  ck_assert_double_le(ethd_vec3_norm(ethd_vec3_cross(way, v)) / ethd_vec3_norm(v), 1e-12);
  ck_assert_double_ge(ethd_vec3_norm(way), 0.02);
  if (table.turn > 0) ck_assert_double_ge(ethd_vec3_dot(ethd_vec3_of(normal), m.tool.facing), 1 - 1e-6);
}

/* An arm that is drawn to its posture moves its joints, and the plate stays. */
TEST_LOOP(test_null_space, 0, 3) {
  begin(arm_names[_i], NULL);
  double q[ETHD_JOINTS_MAX], furthest = 0, moved = 0;
  for (uint32_t i = 0; i < table.limits.count; i++)
    q[i] = table.posture[i] + draw(10 * (uint64_t)_i + i, 0.2, 0.4) * (i % 2 ? 1 : -1);
  ethd__arm_motion_start(&table, q, &m);
  const ethd_vec3 from = m.tool.x;
  double normal[3];
  ethd_vec3_put(m.tool.facing, normal);
  for (int k = 0; k < 2000; k++) {
    (void)ethd__arm_motion_step(&m, (ethd_vec3){0, 0, 0}, normal);
    furthest = fmax(furthest, apart(m.tool.x, from));
  }
  for (uint32_t i = 0; i < table.limits.count; i++) moved = fmax(moved, fabs(m.q[i] - q[i]));
  ck_assert_double_ge(moved, 0.1);
  ck_assert_double_le(furthest, 1e-12);
  ck_assert_double_ge(ethd_vec3_dot(ethd_vec3_of(normal), m.tool.facing), 1 - 1e-6);
}

/* The free part moves neither point nor plate, at singular postures, too; nor does it lose what is free. */
TEST(test_free_part) {
  arm_table("iiwa7", "", &table);
  for (uint64_t k = 0; k < 2000; k++) {
    double q[7], p[7];
    for (uint64_t i = 0; i < 7; i++) {
      q[i] = k % 2 ? 0.5 * M_PI * rint(draw(14 * k + i, -1, 1)) : draw(14 * k + i, -2, 2);
      p[i] = draw(14 * k + 7 + i, -1, 1);
    }
    ethd__arm_motion_start(&table, q, &m);
    ethd__inverse_free(&m.inverse, p);
    const ethd_vec3 v = ethd__linkage_sum(m.tool.j, p, 7), w = ethd__linkage_sum(m.tool.axis, p, 7);
    ck_assert_double_le(ethd_vec3_norm(v), 1e-12);
    ck_assert_double_le(ethd_vec3_norm(ethd_vec3_cross(w, m.tool.facing)), 1e-11);
    double again[7], off = 0;
    memcpy(again, p, sizeof p);
    ethd__inverse_free(&m.inverse, again);
    for (int i = 0; i < 7; i++) off = fmax(off, fabs(again[i] - p[i]));
    ck_assert_double_le(off, 1e-12);
  }
}

/* With singular values above `singular` the inverse is exact; below them it is s / singular^2 of one direction alone. A
   planar arm, nearly stretched: link 2 at the angle b, so that the singular values are those of
   [-L sin b, -L sin b; L + L cos b, L cos b] after a turn by q1. */
TEST(test_damped) {
  begin("planar", NULL);
  for (uint64_t k = 0; k < 1000; k++) {
    const double q[2] = {draw(2 * k, -3, 3), draw(2 * k + 1, -0.2, 0.2)}, L = 0.25, s = sin(q[1]), c = cos(q[1]);
    const double a = -L * s, d = L + L * c, e = L * c; /* rows (a, a), (d, e) */
    const double trace = 2 * a * a + d * d + e * e, det = a * (e - d);
    const double large = (trace + sqrt(trace * trace - 4 * det * det)) / 2, small = det * det / large;
    ethd__arm_motion_start(&table, q, &m);
    double most = 0, least = INFINITY;
    for (int i = 0; i < 3; i++) {
      if (m.inverse.square[i] == 0) continue;
      most = fmax(most, m.inverse.square[i]);
      least = fmin(least, m.inverse.square[i]);
    }
    ck_assert_double_eq_tol(most, large, 1e-15);
    ck_assert_double_eq_tol(least, small, 1e-12 * small);
    const double angle = draw(k, 0, 6), task[3] = {cos(angle), sin(angle), 5}; /* it can't go out of its plane */
    double dq[2];
    ethd__inverse_solve(&m.inverse, task, dq);
    const ethd_vec3 v = ethd__linkage_sum(m.tool.j, dq, 2);
    const double lost = hypot(v.x - task[0], v.y - task[1]), floor = table.singular * table.singular;
    ck_assert_double_le(hypot(dq[0], dq[1]), 1 / fmin(table.singular, sqrt(large)));
    ck_assert_double_le(lost, fmax(0, 1 - small / floor) + 1e-12);
    if (small >= floor) ck_assert_double_le(lost, 1e-12);
  }
}

/* Links at 90 and 0 degrees: J = [-L, 0; L, L] with L = 0.25 m, so x takes (-4, 4) rad/m of the joints, y (0, 4). */
TEST(test_able) {
  begin("planar", NULL);
  const ethd_ability x = ethd__arm_motion_able(&m, (ethd_vec3){1, 0, 0});
  const ethd_ability y = ethd__arm_motion_able(&m, (ethd_vec3){0, -1, 0});
  ck_assert_double_eq_tol(x.speed, 6 / 4.0, 1e-12);
  ck_assert_double_eq_tol(x.acceleration, 100 / 4.0, 1e-12);
  ck_assert_double_eq_tol(x.force, 1.2 / 0.25, 1e-12);
  ck_assert_double_eq_tol(y.speed, 6 / 4.0, 1e-12);
  ck_assert_double_eq_tol(y.force, 1.2 / 0.25, 1e-12);
  ck_assert_double_eq_tol(x.delay, 0.002 + 2 / 300.0, 1e-15);
  ck_assert(isnan(x.mass) && isnan(x.friction));
  const ethd_ability out = ethd__arm_motion_able(&m, (ethd_vec3){0, 0, 1});
  ck_assert(out.force == INFINITY && out.speed == 0 && out.acceleration == 0); /* no joint bears it, none moves it */
}

/* A plate turns to a normal that turns, as the controller's does, while its point stays. */
TEST(test_turn) {
  begin("iiwa7", NULL);
  const ethd_vec3 from = m.tool.x, f = m.tool.facing;
  ethd_vec3 to = f;
  for (int k = 0; k < 2500; k++) {
    const double angle = fmin(0.6, 5e-7 * k * k / 2), c = cos(angle), s = sin(angle); /* 0.125 rad/s^2 */
    to = (ethd_vec3){f.x * c + f.z * s, f.y, f.z * c - f.x * s};
    double normal[3];
    ethd_vec3_put(to, normal);
    (void)ethd__arm_motion_step(&m, (ethd_vec3){0, 0, 0}, normal);
    ck_assert_double_le(apart(m.tool.facing, to), 0.2);
  }
  ck_assert_double_ge(apart(to, f), 0.5);
  ck_assert_double_le(apart(m.tool.facing, to), 1e-3);
  ck_assert_double_le(apart(m.tool.x, from), 1e-12);
}

/* A plate that turns one way comes round when its normal jumps to the other side, on an arm of small accelerations too. */
TEST_LOOP(test_turn_back, 0, 3) {
  begin(arm_names[_i], NULL);
  const ethd_vec3 from = m.tool.x, f = m.tool.facing;
  const double angle = 0.5, there[3] = {f.x * cos(angle) + f.z * sin(angle), f.y, f.z * cos(angle) - f.x * sin(angle)};
  const double back[3] = {f.x * cos(angle) - f.z * sin(angle), f.y, f.z * cos(angle) + f.x * sin(angle)};
  const int second = (int)(1 / table.limits.period);
  for (int k = 0; k < second / 2; k++) (void)ethd__arm_motion_step(&m, (ethd_vec3){0, 0, 0}, there);
  ck_assert_double_le(apart(m.tool.facing, ethd_vec3_of(there)), 0.3);
  for (int k = 0; k < 4 * second; k++) (void)ethd__arm_motion_step(&m, (ethd_vec3){0, 0, 0}, back);
  ck_assert_double_le(apart(m.tool.facing, ethd_vec3_of(back)), 1e-2);
  ck_assert_double_le(apart(m.tool.x, from), 1e-3);
}

/* A stop takes v / a of the joint that needs longest, ends at rest, and doesn't leave the line that the tool is on but by
   its joints' turn on it. */
TEST(test_stop) {
  begin("ur5e", NULL);
  for (int k = 0; k < 200; k++) (void)ethd__arm_motion_step(&m, (ethd_vec3){0, 0.3, 0.1}, NULL);
  double longest = 0;
  for (uint32_t i = 0; i < 6; i++) longest = fmax(longest, fabs(m.dq[i]) / table.limits.joint[i].acceleration);
  ck_assert_double_ge(longest, 0.01);
  int periods = 0;
  const ethd_vec3 from = m.tool.x, way = {0, 0.3, 0.1};
  for (double most = 1; most > 0; periods++) {
    ethd__arm_motion_stop(&m);
    most = 0;
    for (uint32_t i = 0; i < 6; i++) most = fmax(most, fabs(m.dq[i]));
  }
  ck_assert_int_eq(periods, (int)ceil(longest / table.limits.period - 1e-9));
  const ethd_vec3 off = ethd_vec3_cross(ethd_vec3_sub(m.tool.x, from), way);
  ck_assert_double_le(ethd_vec3_norm(off) / ethd_vec3_norm(way), 1e-4);
  ck_assert_double_ge(apart(m.tool.x, from), 1e-3);
}
