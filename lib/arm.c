#include "ethd/arm.h"

#include <string.h>

#include "error.h"
#include "ethd/maths.h"
#include "maths/two_waves.h"

ethd_status ethd_arm_check(const ethd_arm *arm, ethd_error *error) {
  ethd_status status =
      ethd__check_number(error, "mechanism", (double)arm->mechanism, ETHD_ARM_PARALLEL, ETHD_ARM_SERIAL);
  if (!status) status = ethd__check_number(error, "link1", arm->link1, ETHD_ARM_LINK_MIN, ETHD_ARM_LINK_MAX);
  if (!status) status = ethd__check_number(error, "link2", arm->link2, ETHD_ARM_LINK_MIN, ETHD_ARM_LINK_MAX);
  return status;
}

/* Damped least squares J^T (J J^T + lambda^2 I)^-1. With J^T adj(J J^T) = det(J) adj(J) it is

     (det adj(J) + lambda^2 J^T) / (det^2 + lambda^2 tr(J J^T) + lambda^4),

   in which nothing cancels and lambda = 0 gives adj(J) / det. */
static void invert_damped(const double j[4], double det, double w0, double out[4]) {
  double trace = j[0] * j[0] + j[1] * j[1] + j[2] * j[2] + j[3] * j[3];
  double share = 1 - fabs(det) / w0;
  double damping = w0 * w0 / trace * share * share;
  double scale = det * det + damping * trace + damping * damping;
  out[0] = (det * j[3] + damping * j[0]) / scale;
  out[1] = (-det * j[1] + damping * j[2]) / scale;
  out[2] = (-det * j[2] + damping * j[1]) / scale;
  out[3] = (det * j[0] + damping * j[3]) / scale;
}

static void invert(const double j[4], double w0, double out[4]) {
  double det = j[0] * j[3] - j[1] * j[2];
  if (!(fabs(det) >= w0)) {
    invert_damped(j, det, w0, out);
    return;
  }
  two top = (two){j[3], -j[1]} / det, bottom = (two){-j[2], j[0]} / det;
  memcpy(out, &top, sizeof top);
  memcpy(out + 2, &bottom, sizeof bottom);
}

void ethd_arm_pose(const ethd_arm *arm, const double q[2], ethd_pose *out) {
  int serial = arm->mechanism == ETHD_ARM_SERIAL;
  two_waves w = two_sincos((two){q[0], serial ? q[0] + q[1] : q[1]});
  ethd_vec a = {arm->link1 * w.cosine[0], arm->link1 * w.sine[0]};
  ethd_vec b = {arm->link2 * w.cosine[1], arm->link2 * w.sine[1]};
  out->x = ethd_vec_add(a, b);
  out->j[0] = serial ? -(a.y + b.y) : -a.y;
  out->j[1] = -b.y;
  out->j[2] = serial ? a.x + b.x : a.x;
  out->j[3] = b.x;
  invert(out->j, ETHD_ARM_SINGULAR * arm->link1 * arm->link2, out->j_inv);
}

void ethd_arm_reach(const ethd_arm *arm, double *inner, double *outer) {
  *inner = fabs(arm->link1 - arm->link2);
  *outer = arm->link1 + arm->link2;
}

/* To (-pi, pi], for |a| < 3 pi. */
static double wrap(double a) {
  if (a > M_PI) a -= 2 * M_PI;
  if (a <= -M_PI) a += 2 * M_PI;
  return a;
}

/* With the angle th between the links, r^2 = L1^2 + L2^2 + 2 L1 L2 cos th, so
     4 L1 L2 sin^2(th/2) = outer^2 - r^2,   4 L1 L2 cos^2(th/2) = r^2 - inner^2:
   both factors keep their digits at the ends of the reach, where acos would lose half of them. */
ethd_status ethd_arm_angles(const ethd_arm *arm, ethd_vec x, int elbow, double q[2]) {
  double inner, outer, r = ethd_vec_norm(x);
  ethd_arm_reach(arm, &inner, &outer);
  if (!(r >= inner && r <= outer)) return ETHD_E_UNREACHABLE;
  double s = sqrt((outer - r) * (outer + r)), c = sqrt((r - inner) * (r + inner));
  double side = elbow < 0 ? -1 : 1;
  double th = side * 2 * ethd_atan2(s, c);
  /* The ring's centre across and along link 1, both times 2 L1. */
  double along = r * r + arm->link1 * arm->link1 - arm->link2 * arm->link2;
  double q1 = ethd_atan2(x.y, x.x) - ethd_atan2(side * s * c, along);
  q[0] = wrap(q1);
  q[1] = wrap(arm->mechanism == ETHD_ARM_SERIAL ? th : q1 + th);
  return ETHD_OK;
}
