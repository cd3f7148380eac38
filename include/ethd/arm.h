/* The arm: two links that carry the ring in a vertical plane. Links from libethd.

       y ^        X                  parallel: both motors at the base, both angles absolute
         |   L2 ./  q2 (parallel)      X = (L1 cos q1 + L2 cos q2, L1 sin q1 + L2 sin q2)
         |   .-'                     serial: q2 relative to link 1
         | /  L1                       X = (L1 cos q1 + L2 cos(q1 + q2), ...)
         |/ q1
      R_0 +------------> x

   Jacobian: V = J dq, force to torque: tau = J^T F. */
#ifndef ETHD_ARM_H
#define ETHD_ARM_H

#include "ethd/base.h"
#include "ethd/maths.h"

ETHD_BEGIN_DECLS

typedef enum ethd_mechanism { ETHD_ARM_PARALLEL = 0, ETHD_ARM_SERIAL = 1 } ethd_mechanism;

typedef struct ethd_arm {
  ethd_mechanism mechanism;
  double link1, link2; /* m, ETHD_ARM_LINK_MIN to ETHD_ARM_LINK_MAX */
} ethd_arm;

#define ETHD_ARM_LINK_MIN 1e-3 /* m */
#define ETHD_ARM_LINK_MAX 1e2

/* While w = |sin| of the angle between the links, |det J| / (L1 L2), is at least this, the inverse of J
   is adj(J) / det(J). Nearer to the singularity it is J^T (J J^T + lambda^2 I)^-1, damped least squares,
   with lambda^2 = lambda_0^2 (1 - w / ETHD_ARM_SINGULAR)^2 (Nakamura and Hanafusa 1986), which is continuous. lambda_0
   = ETHD_ARM_SINGULAR L1 L2 / |J|, which is close to the smaller singular value where the damping begins. The gain of
   the inverse is at most 1.3 times its value at that point. */
#define ETHD_ARM_SINGULAR 0.02

/* Where the ring is, and how it moves with the joints. Row-major J: dx/dq1, dx/dq2, dy/dq1, dy/dq2. */
typedef struct ethd_pose {
  ethd_vec x;      /* ring centre, m, in R_0 */
  double j[4];     /* m/rad */
  double j_inv[4]; /* rad/m: J^-1, damped near a singularity; 0 in the null direction of a singular J */
} ethd_pose;

/* Checks that both links are within their limits and that the mechanism is one of the two: ETHD_E_RANGE, for NaN
   ETHD_E_NOT_FINITE. [any] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_arm_check(const ethd_arm *arm, ethd_error *error);

/* Returns "parallel" or "serial", or "" for any other number. [any] */
ETHD_API const char *ethd_arm_name(ethd_mechanism mechanism);

/* Works out forward kinematics, Jacobian and its (damped) inverse at joint angles q, rad. [any, rt-safe] */
ETHD_API void ethd_arm_pose(const ethd_arm *arm, const double q[2], ethd_pose *out) ETHD_RT;

/* Finds the joint angles, rad in (-pi, pi], that put the ring's centre at x, m in R_0. With elbow >= 0 link 2 is
   rotated counter-clockwise from link 1, with elbow < 0 clockwise. ETHD_E_UNREACHABLE: x lies outside the annulus of
   ethd_arm_reach; q is untouched. [any, rt-safe] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_arm_angles(const ethd_arm *arm, ethd_vec x, int elbow, double q[2]) ETHD_RT;

/* Gives the reachable annulus about the base joint: inner = |L1 - L2|, outer = L1 + L2, m. [any, rt-safe] */
ETHD_API void ethd_arm_reach(const ethd_arm *arm, double *inner, double *outer) ETHD_RT;

/* The arm's dynamics, from the device's driver or a configuration's [arm], for laws that look ahead. All members are
   doubles; NaN: not known. */
typedef struct ethd_dynamics {
  double mass[2];  /* kg at the ring of joint 1 and joint 2: the inertia of a link's absolute angle is mass L^2 */
  double friction; /* N at the ring: torque L friction sign(dq) of each joint */
  double viscous;  /* Ns/m at the ring: torque L^2 viscous dq of each joint */
  double delay;    /* s from the joint sample to the torque */
} ethd_dynamics;

/* Returns dynamics with all numbers unknown. [any] */
ETHD_API ethd_dynamics ethd_dynamics_unknown(void);

/* Returns `first`, with each unknown number replaced by that of `second`. [any] */
ETHD_API ethd_dynamics ethd_dynamics_known(const ethd_dynamics *first, const ethd_dynamics *second);

/* Returns m v for a row-major 2x2 matrix such as J or J^-1. [any, rt-safe] */
static inline ethd_vec ethd_mat_mul(const double m[4], ethd_vec v) ETHD_RT {
  ethd_vec r = {m[0] * v.x + m[1] * v.y, m[2] * v.x + m[3] * v.y};
  return r;
}

/* Returns m^T v: with m = J, the joint torques, Nm, of a force at the ring, N. [any, rt-safe] */
static inline ethd_vec ethd_mat_mul_transposed(const double m[4], ethd_vec v) ETHD_RT {
  ethd_vec r = {m[0] * v.x + m[2] * v.y, m[1] * v.x + m[3] * v.y};
  return r;
}

/* Returns V = J dq, the ring's velocity, m/s, at these joint speeds, rad/s. [any, rt-safe] */
static inline ethd_vec ethd_pose_velocity(const ethd_pose *pose, const double dq[2]) ETHD_RT {
  return ethd_mat_mul(pose->j, ethd_vec_of(dq));
}

/* Gives tau = J^T F, the joint torques, Nm, that produce a force on the ring, N. [any, rt-safe] */
static inline void ethd_pose_torques(const ethd_pose *pose, ethd_vec force, double torque[2]) ETHD_RT {
  ethd_vec tau = ethd_mat_mul_transposed(pose->j, force);
  torque[0] = tau.x;
  torque[1] = tau.y;
}

/* Gives J^-1 x, the joints' motion, rad or rad/s, for a motion of the ring, m or m/s. [any, rt-safe] */
static inline void ethd_pose_joints(const ethd_pose *pose, ethd_vec x, double joints[2]) ETHD_RT {
  ethd_vec q = ethd_mat_mul(pose->j_inv, x);
  joints[0] = q.x;
  joints[1] = q.y;
}

ETHD_END_DECLS

#endif
