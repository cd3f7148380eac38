/* Parts of the guard, all [rt]. */
#ifndef ETHD__GUARD_PARTS_H
#define ETHD__GUARD_PARTS_H

#include <stdbool.h>

#include "ethd/guard.h"
#include "ethd/maths.h"

/* Adds the workspace's wall to the torque; false: the ring doesn't touch it. */
bool ethd__guard_wall(const ethd_limits *limits, const ethd_pose *pose, ethd_vec v, double torque[2]) ETHD_RT;

/* The torque that a motor so hot may have, Nm. */
double ethd__guard_cool(const ethd_limits *limits, double heat) ETHD_RT;

#endif
