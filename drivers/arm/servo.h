/* A joint that follows commanded speeds: after a dead time its speed follows a second-order equation,

     v'' + 2 damping frequency v' + frequency^2 (v - u) = 0,   q' = v

   solved exactly between commands, each of which is held for a period. All [any, rt-safe]. */
#ifndef ETHD__ARM_SERVO_H
#define ETHD__ARM_SERVO_H

#include "arm/table.h"

enum { ETHD__ARM_HELD = 128 }; /* commands: delay times rate is 100 at most */

/* The propagation of y = v - u and a over a time h. */
typedef struct ethd__arm_ahead {
  double h;              /* s */
  double yy, ya, ay, aa; /* y = yy y + ya a, a = ay y + aa a */
} ethd__arm_ahead;

typedef struct ethd__arm_joint {
  double q, v, a; /* rad, rad/s, rad/s^2 */
} ethd__arm_joint;

typedef struct ethd__arm_servo {
  const ethd__arm_table *table;
  ethd__arm_ahead late, rest;                   /* of a period: under the previous command, and under the new one */
  uint32_t whole;                               /* periods of the dead time */
  uint64_t period;                              /* since the start */
  double held[ETHD__ARM_HELD][ETHD_JOINTS_MAX]; /* rad/s */
  ethd__arm_joint joint[ETHD_JOINTS_MAX];
} ethd__arm_servo;

/* Puts the joints to rest at q, rad. */
void ethd__arm_servo_start(const ethd__arm_table *table, const double *q, ethd__arm_servo *out) ETHD_RT;

/* Advances by a period, at whose beginning the speeds u, rad/s, are commanded. */
void ethd__arm_servo_step(ethd__arm_servo *servo, const double *u) ETHD_RT;

/* Stops all joints at once, as brakes do; earlier commands are forgotten. */
void ethd__arm_servo_brake(ethd__arm_servo *servo) ETHD_RT;

#endif
