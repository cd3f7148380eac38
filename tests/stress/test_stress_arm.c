/* The arm stretched out, folded, and near both. With J = U diag(s1, s2) V^T the damped inverse is
   V diag(s_i / (s_i^2 + lambda^2)) U^T, so that its norm follows from s1^2 + s2^2 = |J|^2 and s1 s2 = |det J|:

     w = |det J| / (L1 L2) >= w0:  the inverse;  below:  lambda = w0 L1 L2 / |J| (1 - w / w0). */
#include <math.h>
#include <string.h>

#include "ethd/control.h"
#include "stress/mass.h"

#define K_T 40.0

typedef struct singular_place {
  ethd_arm arm;
  double bend; /* rad between the links at the singular pose: 0 stretched, pi folded */
  const char *name;
} singular_place;

/* Joint angles that leave an angle of `bend` between the links. */
static void at(const ethd_arm *arm, double bend, double q[2]) {
  q[0] = 1;
  q[1] = arm->mechanism == ETHD_ARM_SERIAL ? bend : 1 + bend;
}

/* Largest and smallest singular value. */
static void singular(const double m[4], double s[2]) {
  double square = m[0] * m[0] + m[1] * m[1] + m[2] * m[2] + m[3] * m[3];
  double det = fabs(m[0] * m[3] - m[1] * m[2]);
  s[0] = sqrt((square + sqrt(fmax(0, square * square - 4 * det * det))) / 2);
  s[1] = s[0] > 0 ? det / s[0] : 0;
}

static double gain_formula(const ethd_arm *arm, const double j[4]) {
  double s[2], unit = arm->link1 * arm->link2, w0 = ETHD_ARM_SINGULAR;
  singular(j, s);
  double share = fmax(0, 1 - s[0] * s[1] / unit / w0), lambda = w0 * unit / hypot(s[0], s[1]) * share;
  double damped[2] = {s[0] / (s[0] * s[0] + lambda * lambda), s[1] / (s[1] * s[1] + lambda * lambda)};
  return fmax(damped[0], damped[1]);
}

static void check_gain(const singular_place *p) {
  double q[2], s[2], most = 0, begin = 0;
  ethd_pose pose;
  at(&p->arm, p->bend - asin(ETHD_ARM_SINGULAR), q);
  ethd_arm_pose(&p->arm, q, &pose);
  singular(pose.j_inv, s);
  begin = s[0];
  for (double off = 0.3; off > 1e-13; off *= 0.97)
    for (int side = -1; side <= 1; side += 2) {
      at(&p->arm, p->bend + side * off, q);
      ethd_arm_pose(&p->arm, q, &pose);
      singular(pose.j_inv, s);
      if (off < asin(ETHD_ARM_SINGULAR)) most = fmax(most, s[0]);
      near(s[0], gain_formula(&p->arm, pose.j), 1e-6, "%s: |J^-1|", p->name);
      if (s[0] * s[1] > 0 && off > asin(ETHD_ARM_SINGULAR) * 1.001) {
        double eye = hypot(pose.j[0] * pose.j_inv[0] + pose.j[1] * pose.j_inv[2] - 1,
                           pose.j[2] * pose.j_inv[0] + pose.j[3] * pose.j_inv[2]);
        bound(eye, 1e-13, "%s: |J J^-1 - I| outside of the damping", p->name);
      }
    }
  bound(most, 1.3 * begin, "%s: |J^-1| <= 1.3 times where damping begins", p->name);
}

/* Torques of whole steps on a sweep through the singular pose, the finger 5 mm away: largest torque over
   K_t |J^-1| |eps|, and largest change between neighbours. */
typedef struct torque_sweep {
  double load, jump;
  int bad;
} torque_sweep;

static torque_sweep through(const singular_place *p, int64_t steps) {
  ethd_setup setup = ethd_setup_default();
  torque_sweep r = {0, 0, 0};
  setup.arm = p->arm;
  rig_set(&setup, "tracking.b_t", 0);
  ethd_control *control = rig_control(&setup);
  double last[2] = {0, 0};
  for (int64_t i = 0; i <= steps; i++) {
    ethd_sense sense;
    ethd_command c;
    ethd_pose pose;
    memset(&sense, 0, sizeof sense);
    sense.have = ETHD_HAVE_FINGER | ETHD_HAVE_DQ;
    at(&p->arm, p->bend + 0.2 * ((double)i / (double)steps - 0.5), sense.q);
    ethd_arm_pose(&p->arm, sense.q, &pose);
    sense.finger[0] = pose.x.x + 0.003;
    sense.finger[1] = pose.x.y - 0.004;
    if (ethd_control_step(control, &sense, &c, NULL) < 0 || !isfinite(c.torque[0]) || !isfinite(c.torque[1])) r.bad++;
    double size = hypot(c.torque[0], c.torque[1]);
    r.load = fmax(r.load, size / (K_T * 0.005 * gain_formula(&p->arm, pose.j)));
    if (i) r.jump = fmax(r.jump, hypot(c.torque[0] - last[0], c.torque[1] - last[1]));
    memcpy(last, c.torque, sizeof last);
  }
  ethd_control_destroy(control);
  return r;
}

TEST(test_arm) {
  static const singular_place places[] = {
      {{ETHD_ARM_PARALLEL, 0.25, 0.25}, 0, "parallel, stretched"},
      {{ETHD_ARM_PARALLEL, 0.25, 0.25}, M_PI, "parallel, folded"},
      {{ETHD_ARM_SERIAL, 0.25, 0.25}, 0, "serial, stretched"},
      {{ETHD_ARM_SERIAL, 0.25, 0.25}, M_PI, "serial, folded"},
      {{ETHD_ARM_PARALLEL, 0.30, 0.12}, 0, "parallel 0.30 + 0.12 m, stretched"},
      {{ETHD_ARM_SERIAL, 0.30, 0.12}, M_PI, "serial 0.30 + 0.12 m, folded"},
  };
  int64_t steps = pick(2000, 20000);
  for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
    const singular_place *p = &places[i];
    check_gain(p);
    torque_sweep coarse = through(p, steps), fine = through(p, 10 * steps);
    within(coarse.bad + fine.bad, 0, 0, "%s: steps at fault or not finite", p->name);
    bound(fine.load, 1 + 1e-9, "%s: |tau| <= K_t |J^-1| |eps|", p->name);
    near(fine.jump / coarse.jump, 0.1, 0.05, "%s: a tenth of the step, a tenth of the jump", p->name);
  }
}
