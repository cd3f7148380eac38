/* Place and Jacobian: against the library's own arm in the plane, and against those of Orocos KDL and MuJoCo, which
   tests/arm_kinematics.py has written down. */
#include "arm/linkage.h"

#include <stdlib.h>

#include "draw.h"
#include "ethd/arm.h"
#include "unit/arm_tables.h"

static void near(double found, double expected, double bound, const char *what) {
  if (!(fabs(found - expected) <= bound)) ck_abort_msg("%s: %.17g, expected %.17g", what, found, expected);
}

TEST(test_planar) {
  ethd__arm_table table;
  arm_table("planar", "", &table);
  const ethd_arm arm = {ETHD_ARM_SERIAL, 0.25, 0.25};
  for (uint64_t i = 0; i < 20000; i++) {
    const double q[2] = {draw(2 * i, -7, 7), draw(2 * i + 1, -7, 7)};
    ethd_pose pose;
    ethd__tool tool;
    ethd_arm_pose(&arm, q, &pose);
    ethd__linkage_place(&table.linkage, q, &tool);
    near(tool.x.x, pose.x.x, 5e-16, "x");
    near(tool.x.y, pose.x.y, 5e-16, "y");
    for (int k = 0; k < 2; k++) {
      near(tool.j[k].x, pose.j[k], 5e-16, "dx/dq");
      near(tool.j[k].y, pose.j[2 + k], 5e-16, "dy/dq");
      ck_assert(tool.x.z == 0 && tool.j[k].z == 0 && tool.axis[k].z == 1 && tool.facing.z == 1);
    }
  }
}

static ethd_vec3 three(char **at) {
  double v[3];
  for (int i = 0; i < 3; i++) v[i] = strtod(*at, at), ++*at;
  return ethd_vec3_of(v);
}

static void same(ethd_vec3 found, char **at, const char *what) {
  const ethd_vec3 expected = three(at);
  near(ethd_vec3_norm(ethd_vec3_sub(found, expected)), 0, 1e-14, what);
}

/* The base stands askew, as in tests/arm_kinematics.py. */
TEST(test_kdl_and_mujoco) {
  char line[1 << 13];
  FILE *in = fopen("tests/reference/arms.csv", "r");
  ck_assert_ptr_nonnull(in);
  int lines = 0;
  for (; fgets(line, sizeof line, in); lines += line[0] != '#') {
    if (line[0] == '#') continue;
    ethd__arm_table table;
    ethd__tool tool;
    double q[ETHD_JOINTS_MAX];
    char *at = strchr(line, ',');
    *at++ = 0;
    arm_table(line, "\n[base]\nx = 0.1\ny = -0.2\nz = 0.3\nroll = 0.4\npitch = -0.5\nyaw = 0.6\n", &table);
    ck_assert_uint_eq(strtoul(at, &at, 10), table.linkage.count);
    for (uint32_t i = 0; i < table.linkage.count; i++) q[i] = strtod(at + 1, &at);
    at++;
    ethd__linkage_place(&table.linkage, q, &tool);
    same(tool.x, &at, "place");
    same(tool.facing, &at, "facing");
    for (uint32_t i = 0; i < table.linkage.count; i++) {
      same(tool.j[i], &at, "j");
      same(tool.axis[i], &at, "axis");
    }
  }
  fclose(in);
  ck_assert_int_eq(lines, 20);
}

/* The tool's velocity is what central differences say, about an offset joint and with a tool and a facing aslant. */
TEST(test_velocity) {
  const ethd__dh_row rows[3] = {{0.3, 0.2, 0.7, 0.4}, {-0.2, 0.1, -1.1, -0.9}, {0.25, -0.3, 0.5, 2}};
  const double place[3] = {1, 2, 3}, turned[3] = {-1, 0.4, 2}, h = 1e-4;
  const ethd__axes base = ethd__axes_at(place, turned);
  for (int convention = 0; convention < 2; convention++) {
    ethd__linkage l;
    ethd__linkage_make((ethd__dh)convention, rows, 3, &base, (ethd_vec3){0.1, 0.2, -0.1}, (ethd_vec3){0.6, 0, 0.8}, &l);
    const double q[3] = {0.3, -1.2, 2.2}, dq[3] = {1, -2, 0.5};
    double before[3], after[3];
    for (int i = 0; i < 3; i++) before[i] = q[i] - h * dq[i], after[i] = q[i] + h * dq[i];
    ethd__tool tool, b, a;
    ethd__linkage_place(&l, q, &tool);
    ethd__linkage_place(&l, before, &b);
    ethd__linkage_place(&l, after, &a);
    const ethd_vec3 v = ethd__linkage_sum(tool.j, dq, 3), w = ethd__linkage_sum(tool.axis, dq, 3);
    const ethd_vec3 moved = ethd_vec3_scale(1 / (2 * h), ethd_vec3_sub(a.x, b.x));
    const ethd_vec3 turn = ethd_vec3_scale(1 / (2 * h), ethd_vec3_sub(a.facing, b.facing));
    near(ethd_vec3_norm(ethd_vec3_sub(v, moved)), 0, 1e-7, "v");
    near(ethd_vec3_norm(ethd_vec3_sub(ethd_vec3_cross(w, tool.facing), turn)), 0, 1e-7, "turn");
  }
}
