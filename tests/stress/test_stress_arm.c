/* Random velocities of the tool of each arm, at any posture and near singular ones: nothing that is sent is beyond a
   joint's limit, and where the guard leaves the task alone the point goes where it was told to go. */
#include <math.h>

#include "arm/motion.h"
#include "stress/mass.h"
#include "unit/arm_tables.h"
#include "unit/draw.h"

#define NEAR 1e-11

#define KEPT(so, ...) \
  if (!(so)) ck_abort_msg(__VA_ARGS__)

static uint64_t next;

static double any(double a, double b) { return draw(next++, a, b); }

/* A posture anywhere, or with joints at right angles, where wrists and elbows are singular, or at the ends of their
   travel. */
static void posture(const ethd__arm_table *t, double *q) {
  const double mood = any(0, 1);
  for (uint32_t i = 0; i < t->limits.count; i++) {
    const ethd_joint_limit *j = &t->limits.joint[i];
    q[i] = any(j->least, j->most);
    if (mood < 0.4) q[i] = M_PI / 2 * rint(q[i] / (M_PI / 2)) + any(-1, 1) * (mood < 0.2 ? 1e-9 : 1e-2);
    if (mood > 0.8 && any(0, 1) < 0.3) q[i] = any(0, 1) < 0.5 ? j->least : j->most;
    q[i] = fmax(j->least, fmin(j->most, q[i]));
  }
}

static void watch(const ethd__arm_motion *m, const double *was) {
  const ethd_joint_limits *l = &m->table->limits;
  for (uint32_t i = 0; i < l->count; i++) {
    const ethd_joint_limit *j = &l->joint[i];
    KEPT(m->q[i] >= j->least - NEAR && m->q[i] <= j->most + NEAR, "joint %u at %.17g", i + 1, m->q[i]);
    KEPT(fabs(m->dq[i]) <= j->speed * (1 + NEAR), "joint %u with %.17g rad/s", i + 1, m->dq[i]);
    KEPT(fabs(m->dq[i] - was[i]) <= j->acceleration * l->period * (1 + 1e-9) + NEAR, "joint %u jumps by %.17g rad/s",
         i + 1, m->dq[i] - was[i]);
  }
}

TEST_LOOP(test_random_tasks, 0, ARMS) {
  ethd__arm_table table;
  ethd__arm_motion m;
  next = (uint64_t)_i << 40;
  arm_table(arm_names[_i], "", &table);
  for (int64_t runs = pick(100000, 2500000) / 500; runs > 0; runs--) {
    double q[ETHD_JOINTS_MAX], was[ETHD_JOINTS_MAX], normal[3] = {0, 0, 1};
    ethd_vec3 v = {0, 0, 0};
    posture(&table, q);
    ethd__arm_motion_start(&table, q, &m);
    for (int tick = 0; tick < 500; tick++) {
      if (any(0, 1) < 0.05) {
        const double most = any(0, 1) < 0.1 ? 1e6 : 1;
        v = (ethd_vec3){any(-most, most), any(-most, most), any(-most, most)};
        const ethd_vec3 n = {any(-1, 1), any(-1, 1), any(-1, 1)};
        ethd_vec3_put(ethd_vec3_scale(1 / ethd_vec3_norm(n), n), normal);
      }
      memcpy(was, m.dq, sizeof was);
      if (any(0, 1) < 0.01)
        ethd__arm_motion_stop(&m);
      else
        (void)ethd__arm_motion_step(&m, v, normal);
      watch(&m, was);
    }
  }
}
