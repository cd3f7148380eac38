/* The steady lag behind a finger at constant speed. All that tracking has to bear is friction,
   F = (f_c + b |v|) against the motion; in a steady state the damper sees nothing, so

       J^T F = K_t J^-1 eps_X,   eps_X = J J^T F / K_t

   which along x and y of the parallel arm at 90 and 0 degrees is F / K_x with K_x = K_t / L^2. */
#include <math.h>

#include "stress/rig.h"
#include "stress/stress.h"

#define FRICTION 0.398 /* N */
#define VISCOUS 1.267  /* Ns/m */

/* Ring at (L, L) when the finger is; all is slow against the loop, so that it is steady all the way. */
static ethd_vec measure(ethd_mechanism mechanism, ethd_vec direction, double speed, ethd_pose *pose) {
  ethd__stress_rig rig;
  ethd__stress_rig_open(&rig, 0.1173, 1);
  const double L = rig.setup.arm.link1, ahead = 0.3 * speed;
  rig.setup.arm.mechanism = mechanism;
  ethd_setup_tracking(&rig.setup, &ethd_tracking_pd);
  rig.measured = rig.has_finger = 1;
  ethd__stress_rig_start(&rig, 0);
  ethd_vec start = {L - ahead * direction.x, L - ahead * direction.y};
  if (ethd_arm_angles(&rig.setup.arm, start, -1, rig.q) < 0) return (ethd_vec){NAN, NAN};
  rig.finger = start;
  rig.finger_v = ethd_vec_scale(speed, direction);
  rig.push = ethd_vec_scale(-(FRICTION + VISCOUS * speed), direction);
  for (int k = 0; k <= 300; k++) {
    double t = (k - 300) * rig.setup.period;
    rig.finger = (ethd_vec){L + speed * t * direction.x, L + speed * t * direction.y};
    ethd__stress_rig_step(&rig);
    if (k < 300) ethd__stress_rig_move(&rig);
  }
  ethd_arm_pose(&rig.setup.arm, rig.q, pose);
  ethd_vec behind = ethd_vec_sub(rig.finger, pose->x);
  ethd__stress_rig_close(&rig);
  return behind;
}

/* J J^T F / K_t */
static ethd_vec formula(const ethd_pose *pose, ethd_vec force) {
  ethd_vec tau = ethd_mat_mul_transposed(pose->j, force);
  return ethd_vec_scale(1 / 40.0, ethd_mat_mul(pose->j, tau));
}

static void one(ethd__stress_log *log, ethd_mechanism mechanism, const char *name, ethd_vec direction) {
  static const double speeds[] = {1e-3, 3e-3, 0.01, 0.03};
  for (int i = 0; i < 4; i++) {
    ethd_pose pose;
    ethd_vec eps = measure(mechanism, direction, speeds[i], &pose);
    ethd_vec f = formula(&pose, ethd_vec_scale(FRICTION + VISCOUS * speeds[i], direction));
    ethd__stress_within(log, "m", ethd_vec_norm(ethd_vec_sub(eps, f)), 0, 5e-3 * ethd_vec_norm(f),
                        "%s arm, along %s: eps_X - J J^T F / K_t", mechanism ? "serial" : "parallel", name);
  }
  if (mechanism == ETHD_ARM_SERIAL || direction.x * direction.y != 0) return;
  for (int i = 0; i < 4; i++) {
    ethd_pose pose;
    ethd_vec eps = measure(mechanism, direction, speeds[i], &pose);
    ethd__stress_near(log, "m", ethd_vec_dot(eps, direction), (FRICTION + VISCOUS * speeds[i]) / 640, 5e-3,
                      "parallel arm, along %s: (f_c + b v) / 640 N/m", name);
  }
}

static void run(ethd__stress_log *log) {
  static const ethd_vec directions[] = {{1, 0}, {0, 1}, {-0.6, 0.8}};
  static const char *const names[] = {"x", "y", "127 degrees"};
  for (int d = 0; d < 3; d++) one(log, ETHD_ARM_PARALLEL, names[d], directions[d]);
  for (int d = 0; d < 3; d++) one(log, ETHD_ARM_SERIAL, names[d], directions[d]);
}

const ethd__stress ethd__stress_lag = {"lag", "steady lag behind a finger at constant speed", run};
