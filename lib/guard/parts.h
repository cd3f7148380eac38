/* Parts of the guard, all [rt]. */
#ifndef ETHD__GUARD_PARTS_H
#define ETHD__GUARD_PARTS_H

#include <stdbool.h>

#include "ethd/guard.h"
#include "ethd/maths.h"

/* Adds the push of the workspace's wall to the torque; returns false if the ring doesn't touch it. */
bool ethd__guard_wall(const ethd_limits *limits, const ethd_pose *pose, ethd_vec v, double torque[2]) ETHD_RT;

/* Returns the largest torque, Nm, that a motor of this heat may give. */
double ethd__guard_cool(const ethd_limits *limits, double heat) ETHD_RT;

#endif
