/* Kinematics against long double and central differences, the inverse against its definition. */
#include "ethd/arm.h"

#include <stdlib.h>
#include <string.h>

#include "draw.h"
#include "ethd/control.h"
#include "unit/suite.h"

enum { POINTS = 20000 };

static const ethd_arm arms[] = {
    {ETHD_ARM_PARALLEL, 0.25, 0.25}, {ETHD_ARM_SERIAL, 0.25, 0.25}, {ETHD_ARM_PARALLEL, 0.31, 0.17},
    {ETHD_ARM_SERIAL, 0.31, 0.17},   {ETHD_ARM_SERIAL, 0.1, 0.4},
};
enum { ARMS = sizeof arms / sizeof *arms };

/* The second derivation: X from the angles, in long double. */
static void forward(const ethd_arm *arm, const long double q[2], long double x[2]) {
  long double a = q[0], b = arm->mechanism == ETHD_ARM_SERIAL ? q[0] + q[1] : q[1];
  x[0] = arm->link1 * cosl(a) + arm->link2 * cosl(b);
  x[1] = arm->link1 * sinl(a) + arm->link2 * sinl(b);
}

static double between_links(const ethd_arm *arm, const double q[2]) {
  return arm->mechanism == ETHD_ARM_SERIAL ? q[1] : q[1] - q[0];
}

static void with_angle(const ethd_arm *arm, double q1, double th, double q[2]) {
  q[0] = q1;
  q[1] = arm->mechanism == ETHD_ARM_SERIAL ? th : q1 + th;
}

static double largest(const double m[4]) { return fmax(fmax(fabs(m[0]), fabs(m[1])), fmax(fabs(m[2]), fabs(m[3]))); }

TEST_LOOP(test_forward_and_jacobian, 0, ARMS) {
  const ethd_arm *arm = &arms[_i];
  const long double h = 1e-6L;
  for (uint64_t i = 0; i < POINTS; i++) {
    double q[2] = {draw(2 * i, -7, 7), draw(2 * i + 1, -7, 7)};
    ethd_pose pose;
    ethd_arm_pose(arm, q, &pose);
    long double x[2], plus[2], minus[2];
    forward(arm, (long double[2]){q[0], q[1]}, x);
    ck_assert_double_le(fabs((double)(pose.x.x - x[0])), 6e-16);
    ck_assert_double_le(fabs((double)(pose.x.y - x[1])), 6e-16);
    for (int k = 0; k < 2; k++) {
      forward(arm, (long double[2]){q[0] + (k ? 0 : h), q[1] + (k ? h : 0)}, plus);
      forward(arm, (long double[2]){q[0] - (k ? 0 : h), q[1] - (k ? h : 0)}, minus);
      for (int row = 0; row < 2; row++)
        ck_assert_double_le(fabs((double)(pose.j[2 * row + k] - (plus[row] - minus[row]) / (2 * h))), 2e-12);
    }
  }
}

/* To the last bit adj(J) / det(J) where |sin| allows it. */
TEST_LOOP(test_exact_inverse, 0, ARMS) {
  const ethd_arm *arm = &arms[_i];
  int seen = 0;
  for (uint64_t i = 0; i < POINTS; i++) {
    double q[2] = {draw(2 * i, -7, 7), draw(2 * i + 1, -7, 7)};
    if (fabs(sin(between_links(arm, q))) < 1.0001 * ETHD_ARM_SINGULAR) continue;
    ethd_pose pose;
    ethd_arm_pose(arm, q, &pose);
    const double *j = pose.j, *inverse = pose.j_inv;
    double det = j[0] * j[3] - j[1] * j[2];
    ck_assert(inverse[0] == j[3] / det && inverse[1] == -j[1] / det);
    ck_assert(inverse[2] == -j[2] / det && inverse[3] == j[0] / det);
    seen++;
  }
  ck_assert_int_gt(seen, POINTS * 9 / 10);
}

/* J^T (J J^T + lambda^2 I)^-1 written out, with the header's lambda. */
TEST_LOOP(test_damped_inverse, 0, ARMS) {
  const ethd_arm *arm = &arms[_i];
  for (uint64_t i = 0; i < POINTS; i++) {
    double q[2], th = draw(3 * i, -1, 1) * ETHD_ARM_SINGULAR + (draw_bits(3 * i + 1) & 1 ? 3.14159265358979324 : 0);
    with_angle(arm, draw(3 * i + 2, -3, 3), th, q);
    ethd_pose pose;
    ethd_arm_pose(arm, q, &pose);
    long double a = pose.j[0], b = pose.j[1], c = pose.j[2], d = pose.j[3];
    long double det = a * d - b * c, w0 = ETHD_ARM_SINGULAR * (long double)arm->link1 * arm->link2;
    long double lambda = w0 / sqrtl(a * a + b * b + c * c + d * d) * (1 - fabsl(det) / w0);
    long double p = a * a + b * b + lambda * lambda, r = a * c + b * d, s = c * c + d * d + lambda * lambda;
    long double m = p * s - r * r;
    long double expected[4] = {(a * s - c * r) / m, (c * p - a * r) / m, (b * s - d * r) / m, (d * p - b * r) / m};
    for (int k = 0; k < 4; k++)
      ck_assert_double_le(fabs((double)(pose.j_inv[k] - expected[k])), 1e-9 * largest(pose.j_inv));
  }
}

/* Through both singularities in fine steps: no jump, and never much above the exact inverse's largest.
 */
TEST_LOOP(test_continuous_and_bounded, 0, ARMS) {
  const ethd_arm *arm = &arms[_i];
  const double step = ETHD_ARM_SINGULAR / 20000;
  for (int folded = 0; folded < 2; folded++) {
    double centre = folded ? 3.14159265358979324 : 0, q[2], jump = 0, top = 0;
    ethd_pose last, pose;
    with_angle(arm, 0.4, centre - asin(ETHD_ARM_SINGULAR) * 1.000001, q);
    ethd_arm_pose(arm, q, &last);
    double edge = largest(last.j_inv);
    for (int i = -21000; i <= 21000; i++) {
      with_angle(arm, 0.4, centre + i * step, q);
      ethd_arm_pose(arm, q, &pose);
      for (int k = 0; k < 4 && i > -21000; k++) jump = fmax(jump, fabs(pose.j_inv[k] - last.j_inv[k]));
      if (abs(i) <= 20000) top = fmax(top, largest(pose.j_inv));
      last = pose;
    }
    ck_assert_double_le(jump, 1e-3 * edge);
    ck_assert_double_le(top, 1.31 * edge);
    ck_assert_double_ge(top, edge);
  }
}

TEST_LOOP(test_singular, 0, ARMS) {
  double q[2];
  ethd_pose pose;
  with_angle(&arms[_i], 0, 0, q);
  ethd_arm_pose(&arms[_i], q, &pose);
  for (int k = 0; k < 4; k++) ck_assert(isfinite(pose.j_inv[k]));
  /* Stretched along x: no joint moves the ring in x, and none is asked to. */
  ethd_vec none = ethd_mat_mul(pose.j_inv, (ethd_vec){1, 0});
  ck_assert(none.x == 0 && none.y == 0);
  ethd_vec y = ethd_mat_mul(pose.j, ethd_mat_mul(pose.j_inv, (ethd_vec){0, 1}));
  ck_assert_double_eq_tol(y.y, 1, 1e-3);
}

TEST_LOOP(test_angles_there_and_back, 0, ARMS) {
  const ethd_arm *arm = &arms[_i];
  double inner, outer;
  ethd_arm_reach(arm, &inner, &outer);
  ck_assert(inner == fabs(arm->link1 - arm->link2) && outer == arm->link1 + arm->link2);
  for (uint64_t i = 0; i < POINTS; i++) {
    double near = pow(10, -draw(4 * i, 0, 16)), way = draw_bits(4 * i + 1) & 1 ? near : 1 - near;
    double r = inner + (outer - inner) * way, a = draw(4 * i + 2, -4, 4);
    int elbow = draw_bits(4 * i + 3) & 1 ? 1 : -1;
    ethd_vec x = {r * cos(a), r * sin(a)};
    double q[2];
    ethd_pose pose;
    if (!(ethd_vec_norm(x) >= inner && ethd_vec_norm(x) <= outer)) continue;
    ck_assert_int_eq(ethd_arm_angles(arm, x, elbow, q), ETHD_OK);
    for (int k = 0; k < 2; k++) ck_assert(q[k] > -3.14159265358979324 && q[k] <= 3.14159265358979324);
    double side = sin(between_links(arm, q));
    ck_assert(elbow > 0 ? side > -1e-15 : side < 1e-15);
    ethd_arm_pose(arm, q, &pose);
    ck_assert_double_le(ethd_vec_norm(ethd_vec_sub(pose.x, x)), 2e-15);
  }
}

TEST(test_angles_at_the_ends) {
  const double pi = 3.14159265358979324;
  ethd_arm arm = {ETHD_ARM_PARALLEL, 0.25, 0.25};
  double q[2] = {5, 6};
  ck_assert_int_eq(ethd_arm_angles(&arm, (ethd_vec){-0.5, 0}, 1, q), ETHD_OK);
  ck_assert(q[0] == pi && q[1] == pi);
  ck_assert_int_eq(ethd_arm_angles(&arm, (ethd_vec){-0.5, -0.0}, 1, q), ETHD_OK);
  ck_assert(q[0] == pi && q[1] == pi);
  ck_assert_int_eq(ethd_arm_angles(&arm, (ethd_vec){0, 0}, 1, q), ETHD_OK);
  ck_assert_double_eq_tol(fabs(q[1] - q[0]), pi, 1e-15);
  ck_assert_int_eq(ethd_arm_angles(&arm, (ethd_vec){0.25, 0.25}, -1, q), ETHD_OK);
  ck_assert_double_eq_tol(q[0], pi / 2, 1e-15);
  ck_assert_double_eq_tol(q[1], 0, 1e-15);
}

TEST(test_unreachable) {
  const ethd_vec far[] = {{0.5000001, 0}, {0, 1e300}, {NAN, 0}, {0, INFINITY}, {0.1, -0.05}};
  ethd_arm arm = {ETHD_ARM_SERIAL, 0.32, 0.18};
  for (size_t i = 0; i < sizeof far / sizeof *far; i++) {
    double q[2] = {5, 6};
    ck_assert_int_eq(ethd_arm_angles(&arm, far[i], 1, q), ETHD_E_UNREACHABLE);
    ck_assert(q[0] == 5 && q[1] == 6);
  }
}

TEST(test_check) {
  ethd_error error;
  for (int i = 0; i < ARMS; i++) ck_assert_int_eq(ethd_arm_check(&arms[i], &error), ETHD_OK);
  const double bad[] = {0, -0.25, 1e-4, 101, INFINITY};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    ck_assert_int_eq(ethd_arm_check(&(ethd_arm){ETHD_ARM_SERIAL, 0.25, bad[i]}, &error), ETHD_E_RANGE);
    ck_assert_str_eq(error.name, "link2");
    ck_assert(error.found == bad[i] && error.min == ETHD_ARM_LINK_MIN && error.max == ETHD_ARM_LINK_MAX);
  }
  ck_assert_int_eq(ethd_arm_check(&(ethd_arm){ETHD_ARM_SERIAL, NAN, 0.25}, &error), ETHD_E_NOT_FINITE);
  ck_assert_str_eq(error.name, "link1");
  ck_assert_int_eq(ethd_arm_check(&(ethd_arm){(ethd_mechanism)2, 0.25, 0.25}, &error), ETHD_E_RANGE);
  ck_assert(error.found == 2 && error.min == 0 && error.max == 1);
}

/* The words of the configuration are the arms' names, in their order. */
TEST(test_names) {
  ethd_setup setup = ethd_setup_default();
  ethd_setup_key key;
  uint32_t i = 0;
  do ck_assert_int_eq(ethd_setup_key_at(&setup, i++, &key), ETHD_OK);
  while (strcmp(key.section, "arm") != 0 || strcmp(key.param.name, "mechanism") != 0);
  ck_assert_uint_eq(ethd_param_words(&key.param), 2);
  for (int m = 0; m < 2; m++) ck_assert_int_eq(ethd_param_word(&key.param, ethd_arm_name((ethd_mechanism)m)), m);
  ck_assert_str_eq(ethd_arm_name(ETHD_ARM_SERIAL), "serial");
  ck_assert_str_eq(ethd_arm_name((ethd_mechanism)2), "");
}

/* What moves it: what one source doesn't know, the next one may. */
TEST(test_dynamics) {
  ethd_dynamics none = ethd_dynamics_unknown(), some = {{NAN, 0.3}, 0.4, NAN, 1e-4}, all = {{0.1, 0.2}, 0.5, 0.6, 2e-4};
  ck_assert(isnan(none.mass[0]) && isnan(none.mass[1]) && isnan(none.friction) && isnan(none.viscous) &&
            isnan(none.delay));
  ethd_dynamics d = ethd_dynamics_known(&some, &all);
  ck_assert(d.mass[0] == 0.1 && d.mass[1] == 0.3 && d.friction == 0.4 && d.viscous == 0.6 && d.delay == 1e-4);
  d = ethd_dynamics_known(&none, &none);
  ck_assert(isnan(d.mass[0]) && isnan(d.delay));
  d = ethd_dynamics_known(&all, &none);
  ck_assert(memcmp(&d, &all, sizeof d) == 0);
}
