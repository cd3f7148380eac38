/* The wall of the workspace, which lies inside the bounds by the margin and slows the ring down before it meets them:

        x_min   x_min + margin                F = -(stiffness depth + damping speed into it),
          |//////:                            never pulling
          |//////:    ring                                                                          */
#include "guard/parts.h"

static double push(const ethd_guard_device *d, double depth, double speed) {
  return depth > 0 ? d->stiffness * depth + d->damping * fmax(speed, 0) : 0;
}

static double push_both(const ethd_guard_device *d, const double range[2], double margin, double x, double v) {
  return push(d, range[0] + margin - x, -v) - push(d, x - (range[1] - margin), v);
}

bool ethd__guard_wall(const ethd_limits *l, const ethd_guard_device *d, const ethd_guard_motion *m, double torque[2]) {
  const ethd_vec x = m->pose->x, v = m->v;
  ethd_vec f = {push_both(d, &l->workspace[0], l->margin, x.x, v.x),
                push_both(d, &l->workspace[2], l->margin, x.y, v.y)};
  double r = ethd_vec_norm(x);
  if (r > 0) {
    ethd_vec n = ethd_vec_scale(1 / r, x);
    f = ethd_vec_add(f, ethd_vec_scale(push_both(d, l->reach, l->margin, r, ethd_vec_dot(n, v)), n));
  }
  if (!(f.x != 0 || f.y != 0)) return false;
  double tau[2];
  ethd_pose_torques(m->pose, f, tau);
  for (int i = 0; i < 2; i++) torque[i] += tau[i];
  return true;
}
