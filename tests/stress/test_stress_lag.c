/* The steady lag behind a finger at constant speed. All that tracking has to bear is friction,
   F = (f_c + b |v|) against the motion; in a steady state the damper sees nothing, so

       J^T F = K_t J^-1 eps_X,   eps_X = J J^T F / K_t

   which along x and y of the parallel arm at 90 and 0 degrees is F / K_x with K_x = K_t / L^2. */
#include <math.h>

#include "stress/mass.h"

#define FRICTION 0.398 /* N */
#define VISCOUS 1.267  /* Ns/m */

/* Ring at (L, L) when the finger is; all is slow against the loop, so that it is steady all the way. */
static ethd_vec measure(ethd_mechanism mechanism, ethd_vec direction, double speed, ethd_pose *pose) {
  mass_rig r;
  mass_open(&r, 0.1173, 1);
  const double L = r.on.setup.arm.link1, ahead = 0.3 * speed;
  r.on.setup.arm.mechanism = mechanism;
  ethd_setup_tracking(&r.on.setup, &ethd_tracking_pd);
  r.measured = r.has_finger = 1;
  mass_start(&r, 0);
  ethd_vec start = {L - ahead * direction.x, L - ahead * direction.y};
  if (ethd_arm_angles(&r.on.setup.arm, start, -1, r.q) < 0) return (ethd_vec){NAN, NAN};
  r.finger = start;
  r.finger_v = ethd_vec_scale(speed, direction);
  r.push = ethd_vec_scale(-(FRICTION + VISCOUS * speed), direction);
  for (int k = 0; k <= 300; k++) {
    double t = (k - 300) * r.on.setup.period;
    r.finger = (ethd_vec){L + speed * t * direction.x, L + speed * t * direction.y};
    mass_step(&r);
    if (k < 300) mass_move(&r);
  }
  ethd_arm_pose(&r.on.setup.arm, r.q, pose);
  ethd_vec behind = ethd_vec_sub(r.finger, pose->x);
  mass_close(&r);
  return behind;
}

/* J J^T F / K_t */
static ethd_vec formula(const ethd_pose *pose, ethd_vec force) {
  ethd_vec tau = ethd_mat_mul_transposed(pose->j, force);
  return ethd_vec_scale(1 / 40.0, ethd_mat_mul(pose->j, tau));
}

static void one(ethd_mechanism mechanism, const char *name, ethd_vec direction) {
  static const double speeds[] = {1e-3, 3e-3, 0.01, 0.03};
  for (int i = 0; i < 4; i++) {
    ethd_pose pose;
    ethd_vec eps = measure(mechanism, direction, speeds[i], &pose);
    ethd_vec f = formula(&pose, ethd_vec_scale(FRICTION + VISCOUS * speeds[i], direction));
    within(ethd_vec_norm(ethd_vec_sub(eps, f)), 0, 5e-3 * ethd_vec_norm(f), "%s arm, along %s: eps_X - J J^T F / K_t",
           mechanism ? "serial" : "parallel", name);
  }
  if (mechanism == ETHD_ARM_SERIAL || direction.x * direction.y != 0) return;
  for (int i = 0; i < 4; i++) {
    ethd_pose pose;
    ethd_vec eps = measure(mechanism, direction, speeds[i], &pose);
    near(ethd_vec_dot(eps, direction), (FRICTION + VISCOUS * speeds[i]) / 640, 5e-3,
         "parallel arm, along %s: (f_c + b v) / 640 N/m", name);
  }
}

TEST(test_lag) {
  static const ethd_vec directions[] = {{1, 0}, {0, 1}, {-0.6, 0.8}};
  static const char *const names[] = {"x", "y", "127 degrees"};
  for (int d = 0; d < 3; d++) one(ETHD_ARM_PARALLEL, names[d], directions[d]);
  for (int d = 0; d < 3; d++) one(ETHD_ARM_SERIAL, names[d], directions[d]);
}
