#include "arm/simulated.h"

#include <math.h>
#include <stdbool.h>

void ethd__arm_sim_start(ethd__arm_sim *s) {
  ethd__arm_motion_start(&s->table, NULL, &s->motion);
  ethd__arm_servo_start(&s->table, s->table.posture, &s->servo);
  s->finger.given = 0;
  s->periods = 0;
  s->braked = 0;
}

int64_t ethd__arm_sim_time_ns(const ethd__arm_sim *s) {
  return (int64_t)rint(1e9 * s->table.limits.period * (double)s->periods);
}

void ethd__arm_sim_read(ethd__arm_sim *s, ethd_space_sense *out) {
  out->time_ns = ethd__arm_sim_time_ns(s);
  ethd_vec3_put(s->motion.tool.x, out->x);
  ethd_vec3_put(s->motion.v, out->v);
  if (s->table.turn > 0) {
    ethd_vec3_put(s->motion.tool.facing, out->normal);
    out->have |= ETHD_SPACE_HAVE_NORMAL;
  }
  ethd__arm_finger_read(&s->finger, out->time_ns, out);
}

/* The joints stay where the brakes stop them, and the commanded state becomes the same. */
static void brake(ethd__arm_sim *s) {
  double q[ETHD_JOINTS_MAX];
  ethd__arm_servo_brake(&s->servo);
  for (uint32_t i = 0; i < s->table.limits.count; i++) q[i] = s->servo.joint[i].q;
  ethd__arm_motion_start(&s->table, q, &s->motion);
  s->braked = 1;
}

static bool has_normal(const ethd_space_command *c) {
  return c->normal[0] != 0 || c->normal[1] != 0 || c->normal[2] != 0;
}

void ethd__arm_sim_write(ethd__arm_sim *s, const ethd_space_command *command) {
  s->periods++;
  s->ruling = (ethd_joints_ruling){.share = 1, .joint = -1};
  if (command->safe && s->table.safe == ETHD__ARM_BRAKES && !s->braked) brake(s);
  if (s->braked) return;
  if (command->safe)
    ethd__arm_motion_stop(&s->motion);
  else
    s->ruling =
        ethd__arm_motion_step(&s->motion, ethd_vec3_of(command->value), has_normal(command) ? command->normal : NULL);
  ethd__arm_servo_step(&s->servo, s->motion.dq);
}

void ethd__arm_sim_true(const ethd__arm_sim *s, ethd__tool *tool, ethd_vec3 *v) {
  double q[ETHD_JOINTS_MAX], dq[ETHD_JOINTS_MAX];
  for (uint32_t i = 0; i < s->table.limits.count; i++) {
    q[i] = s->servo.joint[i].q;
    dq[i] = s->servo.joint[i].v;
  }
  ethd__linkage_place(&s->table.linkage, q, tool);
  *v = ethd__linkage_sum(tool->j, dq, s->table.limits.count);
}
