#ifndef ETHD__ARM_POSE_H
#define ETHD__ARM_POSE_H

#include "ethd/arm.h"

/* ethd_arm_pose in the library's floating-point mode. [rt] */
void ethd__arm_pose(const ethd_arm *arm, const double q[2], ethd_pose *out) ETHD_RT;

#endif
