#include <math.h>
#include <stdio.h>
#include <string.h>

#include "check/report.h"

#define POSE_X 0.25
#define POSE_Y 0.25

void ethd__velocity_text(const ethd_setup *s, char *out, size_t room) {
  const ethd_method *m = &ethd_velocity_methods[s->velocity];
  if (!m->param_count) {
    snprintf(out, room, "%s", m->id);
    return;
  }
  const char *unit = strcmp(m->params[0].unit, "1") ? m->params[0].unit : "samples";
  snprintf(out, room, "%s, %s %.4g %s", m->id, m->params[0].name, s->velocity_p[0], unit);
}

/* J^-T K J^-1 with K = k I: what a joint gain is at the ring; x, across, y. */
static void at_ring(const double ji[4], double k, double out[3]) {
  out[0] = k * (ji[0] * ji[0] + ji[2] * ji[2]);
  out[1] = k * (ji[0] * ji[1] + ji[2] * ji[3]);
  out[2] = k * (ji[1] * ji[1] + ji[3] * ji[3]);
  if (fabs(out[1]) < 1e-9 * (out[0] + out[2])) out[1] = 0;
}

/* A gain that the law doesn't have is 0; without the first it isn't a law that is known here. */
static void feel(ethd__subject *s) {
  const ethd_setup *setup = &s->config->setup;
  double k_t = ethd_setup_get(setup, "tracking.k_t"), b_t = ethd_setup_get(setup, "tracking.b_t");
  double q[2], k[3], d[3];
  ethd_pose pose;
  s->k[0] = s->k[1] = s->d[0] = s->d[1] = NAN;
  if (isnan(k_t)) {
    printf("tracking     %s has no k_t: its stiffness at the ring isn't known\n", setup->tracking->law.id);
    return;
  }
  if (ethd_arm_angles(&setup->arm, (ethd_vec){POSE_X, POSE_Y}, -1, q)) {
    printf("tracking     not checked: (%g, %g) is out of this arm's reach\n", POSE_X, POSE_Y);
    return;
  }
  ethd_arm_pose(&setup->arm, q, &pose);
  at_ring(pose.j_inv, k_t, k);
  at_ring(pose.j_inv, isnan(b_t) ? 0 : b_t, d);
  printf("tracking     felt at the ring at (%g, %g) m: %.4g N/m in x, %.4g in y, %.4g across; %.4g, "
         "%.4g, %.4g Ns/m\n",
         POSE_X, POSE_Y, k[0], k[2], k[1], d[0], d[2], d[1]);
  s->k[0] = k[0], s->k[1] = k[2];
  s->d[0] = d[0], s->d[1] = d[2];
}

static void figure(const char *name, double value, double scale, const char *unit, const char *give) {
  if (isnan(value))
    printf("%s unknown (%s)", name, give);
  else
    printf("%s %.4g%s%s", name, value * scale, *unit ? " " : "", unit);
}

void ethd__report_device(ethd__subject *s) {
  const ethd__figures *f = &s->device;
  const ethd_arm *arm = &s->config->setup.arm;
  printf("device       ");
  figure("mass", f->mass[0], 1, "kg in x", "arm.mass_x");
  figure(",", f->mass[1], 1, "in y", "arm.mass_y");
  figure("; force", f->force[0], 1, "N", "--force-limit");
  figure("; friction", f->friction, 1, "N", "--friction");
  figure(" and", f->viscous, 1, "Ns/m", "--viscous");
  printf("\n             ");
  figure("delay", f->delay, 1e3, "ms", "--delay");
  figure("; encoder count", f->count * fmax(arm->link1, arm->link2), 1e6, "um at the ring", "--counts");
  figure("; finger's readings", f->latency, 1e3, "ms old", "--latency");
  printf("\n%s",
         f->compliant
             ? "             its transmission gives way, which stability counts; the other bounds are a rigid one's\n"
             : "");
  feel(s);
}
