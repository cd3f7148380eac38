/* The motion of the loop's mass under a constant force: x' = A x + B f, solved exactly by the matrix exponential.

        force   motor's side      transmission     the rest
       ------> [ motor_mass ]--/\/\ spring /\/\--[ mass - motor_mass ]     lead: how far the rest is ahead of the
           friction |  x           | damper |                              motor's side; a rigid device has none
   Pure functions. [any] */
#ifndef ETHD__BOUNDS_MOTION_H
#define ETHD__BOUNDS_MOTION_H

#include "bounds/stability.h"

/* The state: position and speed of the motor's side, then the lead and its speed. */
enum { ETHD_MOTION_X, ETHD_MOTION_V, ETHD_MOTION_LEAD, ETHD_MOTION_LEAD_V, ETHD_MOTION_STATE };

/* The change of the state over a stretch of time: state' = of_state state + of_force force. */
typedef struct ethd__bounds_motion {
  double of_state[ETHD_MOTION_STATE][ETHD_MOTION_STATE], of_force[ETHD_MOTION_STATE];
} ethd__bounds_motion;

/* Fills the motion over `span` s. */
void ethd__bounds_motion_over(const ethd__sampled_loop *loop, double span, ethd__bounds_motion *out);

/* Advances the state under a force, N. */
void ethd__bounds_motion_apply(const ethd__bounds_motion *motion, double force, double state[ETHD_MOTION_STATE]);

#endif
