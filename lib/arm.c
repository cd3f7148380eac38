#include "ethd/arm.h"

#include <stdbool.h>
#include <string.h>

#include "arm_pose.h"
#include "error.h"
#include "ethd/maths.h"
#include "fp_mode.h"
#include "maths/two_waves.h"

/* The differences between arms. A new arm gets a row here and a name in ethd_mechanism. */
typedef struct arm_row {
  const char *name;
  void (*pose)(const ethd_arm *arm, const double q[2], ethd_pose *out) ETHD_RT;
  ethd_status (*angles)(const ethd_arm *arm, ethd_vec x, int elbow, double q[2]) ETHD_RT;
  void (*reach)(const ethd_arm *arm, double *inner, double *outer) ETHD_RT;
} arm_row;

/* Damped least squares J^T (J J^T + lambda^2 I)^-1. With J^T adj(J J^T) = det(J) adj(J) it is

     (det adj(J) + lambda^2 J^T) / (det^2 + lambda^2 tr(J J^T) + lambda^4),

   which has no cancellation, and with lambda = 0 is adj(J) / det. */
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

/* ---- two links ---- */

/* a and b are the links as vectors, at their angles from the x axis. With a relative q2 link 2 rotates with joint 1. */
static inline void pose_of_links(const ethd_arm *arm, two angles, bool relative, ethd_pose *out) {
  two_waves w = two_sincos(angles);
  ethd_vec a = {arm->link1 * w.cosine[0], arm->link1 * w.sine[0]};
  ethd_vec b = {arm->link2 * w.cosine[1], arm->link2 * w.sine[1]};
  out->x = ethd_vec_add(a, b);
  out->j[0] = relative ? -(a.y + b.y) : -a.y;
  out->j[1] = -b.y;
  out->j[2] = relative ? a.x + b.x : a.x;
  out->j[3] = b.x;
  invert(out->j, ETHD_ARM_SINGULAR * arm->link1 * arm->link2, out->j_inv);
}

static void links_reach(const ethd_arm *arm, double *inner, double *outer) ETHD_RT {
  *inner = fabs(arm->link1 - arm->link2);
  *outer = arm->link1 + arm->link2;
}

/* Brings an angle, |a| < 3 pi, to (-pi, pi]. */
static double wrap(double a) {
  if (a > M_PI) a -= 2 * M_PI;
  if (a <= -M_PI) a += 2 * M_PI;
  return a;
}

/* Finds q1, the angle of link 1, and th, the angle from it to link 2. r^2 = L1^2 + L2^2 + 2 L1 L2 cos th, so
     4 L1 L2 sin^2(th/2) = outer^2 - r^2,   4 L1 L2 cos^2(th/2) = r^2 - inner^2:
   both factors keep their digits at the ends of the reach, where acos would lose half of them. */
static ethd_status links_angles(const ethd_arm *arm, ethd_vec x, int elbow, double *q1, double *th) {
  double inner, outer, r = ethd_vec_norm(x);
  links_reach(arm, &inner, &outer);
  if (!(r >= inner && r <= outer)) return ETHD_E_UNREACHABLE;
  double s = sqrt((outer - r) * (outer + r)), c = sqrt((r - inner) * (r + inner));
  double side = elbow < 0 ? -1 : 1;
  *th = side * 2 * ethd_atan2(s, c);
  /* The ring's centre lies side s c / (2 L1) across link 1 and along / (2 L1) along it. */
  double along = r * r + arm->link1 * arm->link1 - arm->link2 * arm->link2;
  *q1 = ethd_atan2(x.y, x.x) - ethd_atan2(side * s * c, along);
  return ETHD_OK;
}

/* ---- parallel: both angles are absolute ---- */

static void parallel_pose(const ethd_arm *arm, const double q[2], ethd_pose *out) ETHD_RT {
  pose_of_links(arm, (two){q[0], q[1]}, false, out);
}

static ethd_status parallel_angles(const ethd_arm *arm, ethd_vec x, int elbow, double q[2]) ETHD_RT {
  double q1, th;
  ethd_status status = links_angles(arm, x, elbow, &q1, &th);
  if (status < 0) return status;
  q[0] = wrap(q1);
  q[1] = wrap(q1 + th);
  return ETHD_OK;
}

/* ---- serial: q2 is relative to link 1 ---- */

static void serial_pose(const ethd_arm *arm, const double q[2], ethd_pose *out) ETHD_RT {
  pose_of_links(arm, (two){q[0], q[0] + q[1]}, true, out);
}

static ethd_status serial_angles(const ethd_arm *arm, ethd_vec x, int elbow, double q[2]) ETHD_RT {
  double q1, th;
  ethd_status status = links_angles(arm, x, elbow, &q1, &th);
  if (status < 0) return status;
  q[0] = wrap(q1);
  q[1] = wrap(th);
  return ETHD_OK;
}

/* ---- the table ---- */

static const arm_row rows[] = {
    [ETHD_ARM_PARALLEL] = {"parallel", parallel_pose, parallel_angles, links_reach},
    [ETHD_ARM_SERIAL] = {"serial", serial_pose, serial_angles, links_reach},
};

#define ROWS (sizeof rows / sizeof *rows)

ethd_status ethd_arm_check(const ethd_arm *arm, ethd_error *error) {
  ethd_status status = ethd__check_number(error, "mechanism", (double)arm->mechanism, 0, (double)(ROWS - 1));
  if (!status) status = ethd__check_number(error, "link1", arm->link1, ETHD_ARM_LINK_MIN, ETHD_ARM_LINK_MAX);
  if (!status) status = ethd__check_number(error, "link2", arm->link2, ETHD_ARM_LINK_MIN, ETHD_ARM_LINK_MAX);
  return status;
}

const char *ethd_arm_name(ethd_mechanism mechanism) { return (unsigned)mechanism < ROWS ? rows[mechanism].name : ""; }

void ethd__arm_pose(const ethd_arm *arm, const double q[2], ethd_pose *out) { rows[arm->mechanism].pose(arm, q, out); }

void ethd_arm_pose(const ethd_arm *arm, const double q[2], ethd_pose *out) { ETHD__FP_DO(ethd__arm_pose(arm, q, out)); }

ethd_status ethd_arm_angles(const ethd_arm *arm, ethd_vec x, int elbow, double q[2]) {
  ETHD__FP_RETURN(ethd_status, rows[arm->mechanism].angles(arm, x, elbow, q));
}

void ethd_arm_reach(const ethd_arm *arm, double *inner, double *outer) {
  rows[arm->mechanism].reach(arm, inner, outer);
}

/* ---- dynamics ---- */

ethd_dynamics ethd_dynamics_unknown(void) {
  const double unknown = (double)NAN;
  return (ethd_dynamics){{unknown, unknown}, unknown, unknown, unknown};
}

static double known(double first, double second) { return isnan(first) ? second : first; }

ethd_dynamics ethd_dynamics_known(const ethd_dynamics *first, const ethd_dynamics *second) {
  return (ethd_dynamics){
      {known(first->mass[0], second->mass[0]), known(first->mass[1], second->mass[1])},
      known(first->friction, second->friction),
      known(first->viscous, second->viscous),
      known(first->delay, second->delay),
  };
}
