/* Tables of arms: those that come with the programs, and what is refused, each time in one line that says where. */
#include <math.h>

#include "unit/arm_tables.h"

static ethd__arm_table table;
static char text[1 << 14], changed[sizeof text + 256], message[ETHD_MESSAGE_MAX];

/* What the makers publish about the last joints, the farthest reach from the first joint's axis, and the rates. */
TEST(test_makers_numbers) {
  const struct {
    const char *name;
    uint32_t joints;
    double speed, torque, rate;
  } arms[ARMS] = {
      {"ur5e", 6, M_PI, 28, 500}, {"fr3", 7, 5.26, 12, 1000}, {"iiwa7", 7, M_PI, 40, 500}, {"planar", 2, 6, 1.2, 1000}};
  for (int i = 0; i < ARMS; i++) {
    arm_table(arms[i].name, "", &table);
    const ethd_joint_limit *last = &table.limits.joint[table.limits.count - 1];
    ck_assert_uint_eq(table.limits.count, arms[i].joints);
    ck_assert_uint_eq(table.linkage.count, arms[i].joints);
    ck_assert(last->speed == arms[i].speed && last->torque == arms[i].torque && table.servo.rate == arms[i].rate);
    ck_assert_int_eq(ethd_joint_limits_check(&table.limits, NULL), ETHD_OK);
    ck_assert(table.limits.period == 1 / arms[i].rate);
  }
}

/* All joints at 0: a UR5e lies along -x, as its maker's drawing has it, an iiwa stands 1266 mm high, a Franka's flange is
   88 mm before its base's axis and looks down, so that a hand comes from below. */
TEST(test_at_zero) {
  const double zero[ETHD_JOINTS_MAX] = {0};
  ethd__tool tool;
  arm_table("ur5e", "", &table);
  ethd__linkage_place(&table.linkage, zero, &tool);
  ck_assert_double_eq_tol(tool.x.x, -0.8172, 1e-15);
  ck_assert_double_eq_tol(tool.x.y, -0.1333 - 0.0996 - 0.05, 1e-15);
  ck_assert_double_eq_tol(tool.x.z, 0.1625 - 0.0997, 1e-15);
  arm_table("iiwa7", "", &table);
  ethd__linkage_place(&table.linkage, zero, &tool);
  ck_assert_double_eq_tol(tool.x.z, 1.266 + 0.05, 1e-15);
  arm_table("fr3", "", &table);
  ethd__linkage_place(&table.linkage, zero, &tool);
  ck_assert_double_eq_tol(tool.x.x, 0.088, 1e-15);
  ck_assert_double_eq_tol(tool.x.z, 0.333 + 0.316 + 0.384 - 0.107 - 0.05, 1e-15);
  ck_assert_double_eq_tol(tool.facing.z, 1, 1e-15);
}

static ethd_status try(const char *was, const char *now) {
  char *at = strstr(text, was);
  ck_assert_msg(at != NULL, "no %s", was);
  int length = snprintf(changed, sizeof changed, "%.*s%s%s", (int)(at - text), text, now, at + strlen(was));
  message[0] = 0;
  return ethd__arm_table_parse(changed, (size_t)length, "t.arm", &table, message);
}

static void refused(const char *was, const char *now, const char *why) {
  ck_assert_msg(try(was, now) < 0, "%s passes", now);
  ck_assert_msg(!strncmp(message, why, strlen(why)) && !strchr(message, '\n'), "%s: %s", now, message);
}

#define JOINT(i) "[joint" #i "]\nleast = -1\nmost = 2\nspeed = 3\nacceleration = 4\ntorque = 5\nposture = 1\n"
#define OTHERS                                                                                                     \
  "[servo]\nfrequency = 100\ndamping = 1\ndelay = 0\nrate = 500\n[inverse]\nsingular = 0.01\npull = 1\nturn = 0\n" \
  "[tool]\nfacing_z = 1\n"
#define WHOLE "[arm]\nconvention = standard\nsafe = hold\n" JOINT(1) JOINT(2) OTHERS

TEST(test_refused) {
  strcpy(text, WHOLE);
  ck_assert_msg(try("", "") == ETHD_OK, "%s", message);
  refused("convention = standard", "convention = dh",
          "t.arm:2: arm.convention: found \"dh\", standard|modified is allowed");
  refused("most = 2", "most = 120", "t.arm:6: joint1.most: found \"120\", -6.3 to 6.3 rad is allowed");
  refused("most = 2", "most = 2 deg", "t.arm:6: joint1.most: found \"2 deg\", -6.3 to 6.3 rad is allowed");
  refused("most = 2", "most = -1", "t.arm:6: joint1.most: found \"-1\", more than `least` is allowed");
  refused("posture = 1", "posture = 2.5", "t.arm:10: joint1.posture: found \"2.5\", `least` to `most` is allowed");
  refused("speed = 3", "speed = 180", "t.arm:7: joint1.speed: found \"180\", 0.001 to 50 rad/s is allowed");
  refused("speed = 3", "speed = 0", "t.arm:7: joint1.speed");
  refused("speed = 3", "speed = nan", "t.arm:7: joint1.speed");
  refused("speed = 3\n", "", "t.arm:4: joint1.speed is missing: its greatest speed");
  refused("speed = 3", "d = 425\nspeed = 3", "t.arm:7: joint1.d: found \"425\", -3 to 3 m is allowed");
  refused("speed = 3", "theta = 0\nspeed = 3", "t.arm:7: joint1.theta: unknown key; a, d, alpha, offset, least, most,");
  refused("[joint2]", "[joint3]", "t.arm:11: found [joint3], [joint2] comes first");
  refused(JOINT(2), "", "t.arm:4: found 1 joints, 2 to 7 are allowed");
  refused(JOINT(2), JOINT(2) JOINT(3) JOINT(4) JOINT(5) JOINT(6) JOINT(7) JOINT(8),
          "t.arm:53: found [joint8]; arm, joint1 to joint7, base, tool, servo, inverse are allowed");
  refused("[tool]", "[hand]", "t.arm:27: found [hand]; arm, joint1 to joint7,");
  refused("facing_z = 1", "facing_z = 0", "t.arm:28: tool.facing_z: found \"0\", a direction that isn't 0 is allowed");
  refused("rate = 500", "rate = 50", "t.arm:22: servo.rate: found \"50\", 125 to 1000 Hz is allowed");
  refused("rate = 500\n", "", "t.arm:18: servo.rate is missing: of the commands");
  refused("rate = 500", "rate = 500\nrate = 500", "t.arm:23: ");
  refused("turn = 0", "turn = 0\nturns = 0", "t.arm:27: inverse.turns: unknown key; singular, pull, turn are allowed");
  refused("[servo]", "[base]\nroll = 90\n[servo]", "t.arm:19: base.roll: found \"90\", -6.3 to 6.3 rad is allowed");
}

/* Cut anywhere, or a file that isn't there. */
TEST(test_no_table) {
  strcpy(text, WHOLE);
  const size_t whole = (size_t)(strstr(text, "turn = ") - text) + strlen("turn = ");
  for (size_t length = 0; length <= whole; length++)
    ck_assert_int_lt(ethd__arm_table_parse(text, length, "t.arm", &table, message), 0);
  ck_assert_int_eq(ethd__arm_table_load("apps/config/no-such.arm", "no-such.arm", &table, message), ETHD_E_FILE);
  ck_assert_int_eq(ethd__arm_table_load("apps/config/ur5e.arm", "ur5e.arm", &table, message), ETHD_OK);
}
