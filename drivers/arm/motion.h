/* Converts a commanded velocity of the tool's point to joint speeds within each joint's limits, tick by tick. All
   positions and speeds here are commanded ones, and q += T dq.

     task: v, and where a plate faces  --->  dq = J^+ task + free part of pull (posture - q)
                                             ---> guard: each joint's place, speed, acceleration; if one binds, the
                                                  point's velocity comes first, then rotation and posture
                                             ---> the point goes where v, as the guard left it, says: no drift
                                             ---> guard

   While the arm rotates and its point moves straight, J dq alone would leave the line by the square of the rotation in
   each period, about 1e-7 m. So the joint speeds are corrected until q + T dq has the point at its desired position,
   with the same inverse (chord iteration; each step leaves a thousandth of the error). All [any, rt-safe]. */
#ifndef ETHD__ARM_MOTION_H
#define ETHD__ARM_MOTION_H

#include "arm/inverse.h"
#include "arm/table.h"
#include "ethd/space.h"

typedef struct ethd__arm_motion {
  const ethd__arm_table *table;
  double q[ETHD_JOINTS_MAX], dq[ETHD_JOINTS_MAX]; /* rad, rad/s of the last period */
  ethd__tool tool;                                /* at q */
  ethd_vec3 v;                                    /* m/s: the point's velocity in the last period */
  ethd__inverse inverse;                          /* at q: three rows, and two more for a plate */
  double across[2][3];                            /* unit vectors: the axes of rotation of these two */
} ethd__arm_motion;

/* Puts the arm to rest at q, rad, within its limits; NULL: its posture. */
void ethd__arm_motion_start(const ethd__arm_table *table, const double *q, ethd__arm_motion *out) ETHD_RT;

/* Moves by one period towards v, m/s; a plate rotates towards `normal`, a unit vector, or keeps its direction: NULL.
   Returns the guard's first ruling, which may concern rotation or posture alone. */
ethd_joints_ruling ethd__arm_motion_step(ethd__arm_motion *m, ethd_vec3 v, const double *normal) ETHD_RT;

/* Moves by one period and slows down, all joints in proportion, as quickly as the slowest joint allows: the tool stays
   on its path. */
void ethd__arm_motion_stop(ethd__arm_motion *m) ETHD_RT;

/* Returns the arm's ability here along the unit vector n, which its slowest joint limits. `delay` is the dead time and
   the lag of the second order. */
ethd_ability ethd__arm_motion_able(const ethd__arm_motion *m, ethd_vec3 n) ETHD_RT;

#endif
