/* A simulated arm that is commanded by velocities of its tool's point: motion.h converts them to joint speeds, servo.h
   follows. Its sense has the commanded state, which a controller of velocities needs; the true state is available too.
   Time advances by a period at each write. All [any, rt-safe]. */
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
  int32_t braked;            /* 1: the brakes are closed, until the next start */
} ethd__arm_sim;

/* Puts the arm to rest at its posture, at time 0, with what `table` and `finger` hold. */
void ethd__arm_sim_start(ethd__arm_sim *sim) ETHD_RT;

/* Returns the time since the start. */
int64_t ethd__arm_sim_time_ns(const ethd__arm_sim *sim) ETHD_RT;

/* Fills the sense, with time_ns since the start: the commanded position and velocity, a plate's direction, and a
   reading that has just arrived. */
void ethd__arm_sim_read(ethd__arm_sim *sim, ethd_space_sense *out) ETHD_RT;

/* Moves by a period: towards the command's velocity or, if the command is safe, into the table's safe state. */
void ethd__arm_sim_write(ethd__arm_sim *sim, const ethd_space_command *command) ETHD_RT;

/* Gives the tool's true pose, and its point's true velocity, m/s. */
void ethd__arm_sim_true(const ethd__arm_sim *sim, ethd__tool *tool, ethd_vec3 *v) ETHD_RT;

#endif
