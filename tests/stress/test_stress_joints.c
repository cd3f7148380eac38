/* Commands of arms of one to seven joints, of any size, sign and direction: integrated exactly, no joint leaves its
   limits, and none stops earlier than it must. */
#include <math.h>
#include <string.h>

#include "ethd/guard.h"
#include "stress/mass.h"
#include "unit/draw.h"

#define TICKS 1000 /* of each arm */
#define NEAR 1e-11

/* As ck_assert_msg, which also writes to a file each time. */
#define KEPT(so, ...) \
  if (!(so)) ck_abort_msg(__VA_ARGS__)

static uint64_t next;

static double any(double a, double b) { return draw(next++, a, b); }

static double scale(double a, double b) { return a * pow(b / a, any(0, 1)); }

typedef struct arm {
  ethd_joint_limits limits;
  double q[ETHD_JOINTS_MAX], v[ETHD_JOINTS_MAX], wish[ETHD_JOINTS_MAX];
} arm;

static arm random_arm(ethd_joints_kind kind) {
  arm a = {.limits = {.count = 1 + (uint32_t)any(0, 7), .kind = kind, .period = scale(2.5e-4, 0.02)}};
  for (uint32_t i = 0; i < a.limits.count; i++) {
    ethd_joint_limit *j = &a.limits.joint[i];
    *j = (ethd_joint_limit){-any(0, 3), any(0, 3), scale(0.01, 10), scale(0.1, 100), scale(0.1, 300), scale(1e-3, 10)};
    if (any(0, 1) < 0.1) j->least = -INFINITY;
    if (any(0, 1) < 0.1) j->speed = INFINITY;
    if (any(0, 1) < 0.1 && (kind == ETHD_JOINTS_SPEED || j->torque < 1e9)) j->acceleration = INFINITY;
    if (any(0, 1) < 0.1) j->torque = INFINITY;
    if (any(0, 1) < 0.05) j->most = j->least = 0;
    if (any(0, 1) < 0.3) a.q[i] = j->most; /* it rests at its bound */
  }
  return a;
}

/* A wish lasts some ticks; near a singularity it is huge and changes its sign. */
static void wish(arm *a, long tick) {
  const double mood = any(0, 1);
  if (tick > 0 && mood < 0.9) return;
  for (uint32_t i = 0; i < a->limits.count; i++) {
    a->wish[i] = any(-1, 1) * scale(1e-3, mood < 0.91 ? 1e9 : 20);
    if (any(0, 1) < 0.02) a->wish[i] = 0;
    if (any(0, 1) < 0.002) a->wish[i] = NAN;
  }
}

/* Moves a joint by one period and returns the furthest that it was on the way. */
static double move(const arm *a, uint32_t i, double command, double *q, double *v) {
  const double T = a->limits.period, before = *q, was = *v;
  if (a->limits.kind == ETHD_JOINTS_SPEED) {
    *v = command;
    *q += command * T;
    return *q;
  }
  const double acceleration = command / a->limits.joint[i].inertia;
  *q += was * T + acceleration * T * T / 2;
  *v += acceleration * T;
  return was * *v < 0 ? before - was * was / (2 * acceleration) : *q;
}

static void watch(const arm *a, uint32_t i, double was, double command, double furthest, double v) {
  const ethd_joint_limit *j = &a->limits.joint[i];
  const double most = j->acceleration * a->limits.period;
  KEPT(furthest <= j->most + NEAR && furthest >= j->least - NEAR, "%.17g outside %.17g %.17g", furthest, j->least,
       j->most);
  KEPT(fabs(v) <= j->speed * (1 + NEAR), "%.17g faster than %.17g", v, j->speed);
  KEPT(fabs(v - was) <= most * (1 + 1e-9) + NEAR, "a step of %.17g, allowed %.17g", v - was, most);
  const bool strong = a->limits.kind == ETHD_JOINTS_TORQUE && !(fabs(command) <= j->torque);
  KEPT(!strong, "%.17g Nm of %.17g", command, j->torque);
}

static void run(arm *a) {
  for (long tick = 0; tick < TICKS; tick++) {
    double command[ETHD_JOINTS_MAX], most = 0;
    wish(a, tick);
    memcpy(command, a->wish, sizeof command);
    const ethd_joints_ruling r = ethd_guard_joints(&a->limits, a->q, a->v, command);
    KEPT(r.share >= 0 && r.share <= 1, "a share of %.17g", r.share);
    for (uint32_t i = 0; i < a->limits.count; i++) most = fmax(most, fabs(a->wish[i]));
    for (uint32_t i = 0; i < a->limits.count; i++) {
      const double was = a->v[i];
      const bool straight =
          r.turned || r.bound == ETHD_JOINTS_FINITE || fabs(command[i] - r.share * a->wish[i]) <= 1.01e-6 * most;
      KEPT(straight, "the direction isn't kept");
      const double furthest = move(a, i, command[i], &a->q[i], &a->v[i]);
      watch(a, i, was, command[i], furthest, a->v[i]);
    }
  }
}

TEST_LOOP(test_random_commands, ETHD_JOINTS_SPEED, ETHD_JOINTS_TORQUE + 1) {
  const int64_t arms = pick(500000, 5000000) / TICKS;
  next = (uint64_t)_i << 40;
  for (int64_t k = 0; k < arms; k++) {
    arm a = random_arm((ethd_joints_kind)_i);
    run(&a);
  }
}

/* From rest to rest over d takes no less than 2 sqrt(d / a), and with sampled speeds two periods more, plus what the
   speed's limit costs, d / s + s / a in place of the former. */
TEST(test_quickest) {
  for (int k = 0; k < 200; k++) {
    const double a = draw(3 * (uint64_t)k, 1, 50), d = draw(3 * (uint64_t)k + 1, 0.05, 3), T = 0.002;
    const double s = k % 2 ? INFINITY : draw(3 * (uint64_t)k + 2, 0.1, 2);
    const ethd_joint_limits l = {.count = 1, .period = T, .joint = {{-INFINITY, d, s, a, INFINITY, 0}}};
    const double ideal = s * s / a < d ? d / s + s / a : 2 * sqrt(d / a);
    double q = 0, v = 0;
    long tick = 0;
    for (; d - q > 1e-9 && tick < 100000; tick++) {
      double command = 1e6;
      (void)ethd_guard_joints(&l, &q, &v, &command);
      ck_assert(command <= sqrt(2 * a * (d - q)));
      v = command;
      q += v * T;
    }
    ck_assert_msg((double)tick * T >= ideal - T && (double)tick * T <= ideal + 3 * T, "%g s beside %g s",
                  (double)tick * T, ideal);
  }
}

/* The speed allowed at a distance is the one that uses it up: v T + (v - a T) T + (v - 2 a T) T + ... */
TEST(test_the_sampled_way) {
  const double a = 10, T = 0.01;
  ethd_joint_limits l = {.count = 1, .period = T, .joint = {{-INFINITY, 0, INFINITY, a, INFINITY, 0}}};
  for (int k = 0; k < 1000; k++) {
    const double v = draw((uint64_t)k, 0, 3);
    double way = 0, command = 1e3;
    for (double u = v; u > 0; u -= a * T) way += u * T;
    l.joint[0].most = way;
    const double q = 0;
    (void)ethd_guard_joints(&l, &q, &v, &command);
    ck_assert_double_eq_tol(command, v, 1e-12);
  }
}

/* Accelerations alone: the change of the speeds is along the requested change, as far as one joint's limit allows. */
TEST(test_change_keeps_its_direction) {
  for (uint64_t k = 0; k < 1000; k++) {
    ethd_joint_limits l = {.count = 3, .period = 0.002};
    double v[3], wish[3], command[3], share = INFINITY, reached = 0;
    const double q[3] = {0, 0, 0};
    for (uint64_t i = 0; i < 3; i++) {
      l.joint[i] = (ethd_joint_limit){-INFINITY, INFINITY, INFINITY, draw(9 * k + i, 1, 50), INFINITY, 0};
      v[i] = draw(9 * k + 3 + i, -1, 1);
      command[i] = wish[i] = draw(9 * k + 6 + i, -1, 1);
      share = fmin(share, fmin(1, l.joint[i].acceleration * l.period / fabs(wish[i] - v[i])));
    }
    (void)ethd_guard_joints(&l, q, v, command);
    for (int i = 0; i < 3; i++) {
      ck_assert_double_eq_tol(command[i], v[i] + share * (wish[i] - v[i]), 1e-15);
      reached = fmax(reached, fabs(command[i] - v[i]) / (l.joint[i].acceleration * l.period));
    }
    ck_assert_double_le(reached, 1 + 1e-12);
  }
}

/* A joint on its way to a stop at its bound doesn't keep the others from braking, or from turning back. */
TEST(test_braking_joint_holds_up_no_other) {
  const ethd_joint_limit ends = {-INFINITY, 0, INFINITY, 1, INFINITY, 0},
                         open = {-INFINITY, INFINITY, INFINITY, 1, INFINITY, 0};
  ethd_joint_limits l = {.count = 2, .period = 0.01, .joint = {ends, open}};
  double way = 0;
  for (double u = 0.49; u > 0; u -= 0.01) way += 0.01 * u;
  l.joint[0].most = way;
  for (int k = 0; k < 2; k++) {
    const double q[2] = {0, 0}, v[2] = {0.5, 0.5};
    double command[2] = {0, k ? -0.5 : 0};
    (void)ethd_guard_joints(&l, q, v, command);
    ck_assert_double_eq_tol(command[0], 0.49, 1e-12);
    ck_assert_double_eq_tol(command[1], 0.49, 1e-12);
  }
}

/* A joint at its bound stands, with the whole arm, when it is asked to go on, and leaves when it is asked to. */
TEST(test_resting_at_the_bound) {
  const ethd_joint_limit joint = {-1, 1, 2, 10, 100, 0};
  const ethd_joint_limits l = {.count = 2, .period = 0.01, .joint = {joint, joint}};
  const double q[2] = {1, 0}, v[2] = {0, 0};
  double on[2] = {0.1, 0.05}, away[2] = {-0.1, 0.05}, hardly[2] = {1e-9, 0.05};
  ethd_joints_ruling r = ethd_guard_joints(&l, q, v, on);
  ck_assert(on[0] == 0 && on[1] == 0 && r.share == 0);
  ck_assert(r.joint == 0 && r.bound == ETHD_JOINTS_POSITION && !r.turned);
  r = ethd_guard_joints(&l, q, v, away);
  ck_assert(away[0] == -0.1 && away[1] == 0.05 && r.share == 1 && r.joint == -1 && r.bound == ETHD_JOINTS_FREE);
  r = ethd_guard_joints(&l, q, v, hardly);
  ck_assert(hardly[0] == 0 && hardly[1] == 0.05 && r.share == 1);
}

/* Pushed beyond its bound by a hand, it brakes by its acceleration and then only comes back. */
TEST(test_beyond_the_bound) {
  const ethd_joint_limits l = {.count = 1, .period = 0.01, .joint = {{-1, 1, 2, 10, 100, 0}}};
  double q = 1.1, v = 0.25, out = 1;
  (void)ethd_guard_joints(&l, &q, &v, &out);
  ck_assert_double_eq_tol(out, 0.15, 1e-15);
  v = 0;
  out = 1;
  (void)ethd_guard_joints(&l, &q, &v, &out);
  ck_assert(out == 0);
  out = -0.1;
  (void)ethd_guard_joints(&l, &q, &v, &out);
  ck_assert(out == -0.1);
}

/* A UR5e's motors, 150 Nm and 28 Nm (Universal Robots, "Max. joint torques", article 17260). */
TEST(test_each_joint_has_its_torque) {
  ethd_joint_limits l = {.count = 6, .kind = ETHD_JOINTS_TORQUE, .period = 0.002};
  for (int i = 0; i < 6; i++)
    l.joint[i] = (ethd_joint_limit){-INFINITY, INFINITY, INFINITY, INFINITY, i < 3 ? 150 : 28, 0};
  const double zero[6] = {0};
  double torque[6] = {100, -140, 10, 56, 1, 0};
  const ethd_joints_ruling r = ethd_guard_joints(&l, zero, zero, torque);
  const double half[6] = {50, -70, 5, 28, 0.5, 0};
  ck_assert(!memcmp(torque, half, sizeof half));
  ck_assert(r.share == 0.5 && r.joint == 3 && r.bound == ETHD_JOINTS_STRONG && !r.turned);
}

TEST(test_refused) {
  const ethd_joint_limit joint = {-1, 1, 2, 10, 100, 0};
  const ethd_joint_limits good = {.count = 2, .period = 0.01, .joint = {joint, joint}};
  const double zero[2] = {0}, lost[2] = {0, NAN};
  double command[2] = {0.1, 0.1};
  ethd_error error;
  ethd_joint_limits bad = good;
  ck_assert_int_eq(ethd_joint_limits_check(&good, &error), ETHD_OK);
  bad.joint[1].least = 1.5;
  ck_assert_int_eq(ethd_joint_limits_check(&bad, &error), ETHD_E_RANGE);
  ck_assert_str_eq(error.name, "joint2.least");
  ck_assert(ethd_guard_joints(&bad, zero, zero, command).bound == ETHD_JOINTS_FINITE);
  ck_assert(command[0] == 0 && command[1] == 0);
  command[0] = 0.1;
  ck_assert(ethd_guard_joints(&good, zero, lost, command).bound == ETHD_JOINTS_FINITE);
  ck_assert(command[0] == 0 && command[1] == 0);
  bad = good;
  bad.period = 0;
  ck_assert_int_eq(ethd_joint_limits_check(&bad, &error), ETHD_E_RANGE);
  bad.count = 8;
  ck_assert_int_eq(ethd_joint_limits_check(&bad, &error), ETHD_E_RANGE);
}
