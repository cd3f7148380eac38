/* Whatever the torque, the pose, the speed and the state, the limits that ethd_limits_check lets pass and the time
   between two ticks: what the guard gives is finite and within the torque limit, and is what it remembers. The parts
   that replace or add to the torque before may give any number. */
#include "ethd/guard.h"

double nondet_double(void);
_Bool nondet_bool(void);

/* any results, NaN and infinity included */
double sqrt(double x) {
  double root = nondet_double();
  __CPROVER_assume(x != x || !(root < 0));
  return root;
}

static double heat_limit;

#include "guard/parts.h"

bool ethd__guard_wall(const ethd_limits *limits, const ethd_guard_device *device, const ethd_guard_motion *motion,
                      double torque[2]) {
  (void)limits, (void)device, (void)motion;
  torque[0] = nondet_double();
  torque[1] = nondet_double();
  return nondet_bool();
}

void ethd__guard_stop(const ethd_limits *limits, const ethd_guard_device *device, ethd_guard_state *state,
                      const ethd_guard_motion *motion, double torque[2]) {
  (void)limits, (void)device, (void)state, (void)motion;
  torque[0] = nondet_double();
  torque[1] = nondet_double();
}

double ethd__guard_cool(const ethd_limits *limits, double heat) {
  (void)limits, (void)heat;
  return heat_limit;
}

#include "../../lib/guard/guard.c"

static bool is_finite(double v) { return v - v == 0; }

int main(void) {
  ethd_limits limits;
  ethd_guard_state state;
  ethd_guard_device device;
  ethd_pose pose;
  ethd_guard_motion motion;
  double torque[2];
  motion.pose = &pose;
  __CPROVER_assume(limits.torque >= 0 && limits.torque_rate >= 0 && limits.speed >= 0);
  __CPROVER_assume(is_finite(motion.dt) && motion.dt > 0);
  __CPROVER_assume(is_finite(state.last[0]) && is_finite(state.last[1])); /* kept, as proven below */
  __CPROVER_assume(heat_limit >= 0);
  __CPROVER_assume(state.steep >= 0 && state.steep < INT64_MAX);
  ethd_guard_step(&limits, &device, &state, &motion, torque);
  for (int i = 0; i < 2; i++) {
    __CPROVER_assert(is_finite(torque[i]), "the torque is finite");
    __CPROVER_assert(torque[i] >= -limits.torque && torque[i] <= limits.torque, "the torque is within its limit");
    __CPROVER_assert(state.last[i] == torque[i], "the state remembers it");
  }
  return 0;
}
