/* A simulated arm that takes velocities of its tool's point: motion.h makes joint speeds of them, servo.h follows. It
   tells what it was commanded, as a controller of velocities has to see; where it really is stands beside it. Time goes
   on by a period at each write. All [any, rt-safe]. */
#ifndef ETHD__ARM_SIMULATED_H
#define ETHD__ARM_SIMULATED_H

#include "arm/finger.h"
#include "arm/motion.h"
#include "arm/servo.h"

typedef struct ethd__arm_sim {
  ethd__arm_table table;
  ethd__arm_motion motion;
  ethd__arm_servo servo;
  ethd__arm_finger finger;
  ethd_joints_ruling ruling; /* of the last period's motion */
  int64_t periods;           /* since the start */
  int32_t braked;            /* 1: the brakes are closed, and stay so until the start */
} ethd__arm_sim;

/* Puts the arm to rest at its posture, at time 0, with what `table` and `finger` hold. */
void ethd__arm_sim_start(ethd__arm_sim *sim) ETHD_RT;

/* Returns the time since the start. */
int64_t ethd__arm_sim_time_ns(const ethd__arm_sim *sim) ETHD_RT;

/* Fills the sense but for time_ns's origin, which is the start: the commanded place and speed, where a plate faces, and
   a reading that has just arrived. */
void ethd__arm_sim_read(ethd__arm_sim *sim, ethd_space_sense *out) ETHD_RT;

/* Moves by a period: towards the command's velocity, or, where it says safe, into the table's safe state. */
void ethd__arm_sim_write(ethd__arm_sim *sim, const ethd_space_command *command) ETHD_RT;

/* Gives where the tool really is, and its point's velocity, m/s. */
void ethd__arm_sim_true(const ethd__arm_sim *sim, ethd__tool *tool, ethd_vec3 *v) ETHD_RT;

#endif
