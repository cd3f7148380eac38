/* The wall of the workspace, which lies inside the bounds by the margin and slows the ring down before it meets them:

        x_min   x_min + margin                F = -(WALL_STIFFNESS depth + WALL_DAMPING speed into it),
          |//////:                            never pulling
          |//////:    ring                                                                          */
#include "guard/parts.h"

/* A fifth of the paper's K_e and B_e (eq. 10): stable on any device that renders its walls. */
#define WALL_STIFFNESS 500.0 /* N/m */
#define WALL_DAMPING 10.0    /* Ns/m */

static double push(double depth, double speed) ETHD_RT {
  return depth > 0 ? WALL_STIFFNESS * depth + WALL_DAMPING * fmax(speed, 0) : 0;
}

static double push_both(double lo, double hi, double margin, double x, double v) ETHD_RT {
  return push(lo + margin - x, -v) - push(x - (hi - margin), v);
}

bool ethd__guard_wall(const ethd_limits *l, const ethd_pose *pose, ethd_vec v, double torque[2]) {
  ethd_vec f = {push_both(l->workspace[0], l->workspace[1], l->margin, pose->x.x, v.x),
                push_both(l->workspace[2], l->workspace[3], l->margin, pose->x.y, v.y)};
  double r = ethd_vec_norm(pose->x);
  if (r > 0) {
    ethd_vec n = ethd_vec_scale(1 / r, pose->x);
    f = ethd_vec_add(f, ethd_vec_scale(push_both(l->reach[0], l->reach[1], l->margin, r, ethd_vec_dot(n, v)), n));
  }
  if (!(f.x != 0 || f.y != 0)) return false;
  double tau[2];
  ethd_pose_torques(pose, f, tau);
  for (int i = 0; i < 2; i++) torque[i] += tau[i];
  return true;
}
