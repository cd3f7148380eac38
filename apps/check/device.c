#include <math.h>
#include <stdio.h>
#include <string.h>

#include "check/report.h"

void ethd__velocity_text(const ethd_setup *s, char *out, size_t room) {
  const ethd_method *m = &ethd_velocity_methods[s->velocity];
  if (!m->param_count) {
    snprintf(out, room, "%s", m->id);
    return;
  }
  const char *unit = strcmp(m->params[0].unit, "1") ? m->params[0].unit : "samples";
  snprintf(out, room, "%s, %s %.4g %s", m->id, m->params[0].name, s->velocity_p[0], unit);
}

static void feel(ethd__subject *s) {
  const ethd_setup *setup = &s->config->setup;
  const ethd__bounds_felt *f = &s->felt;
  s->felt = (ethd__bounds_felt){{NAN, NAN}, {NAN, NAN}, NAN, NAN};
  if (ethd__bounds_feel(setup, &s->felt))
    printf("tracking     felt at the ring at (%g, %g) m: %.4g N/m in x, %.4g in y, %.4g across; %.4g, "
           "%.4g, %.4g Ns/m\n",
           ETHD_LOOP_FELT_X, ETHD_LOOP_FELT_Y, f->stiffness[0], f->stiffness[1], f->stiffness_across, f->damping[0],
           f->damping[1], f->damping_across);
  else if (!ethd_law_gains(&setup->tracking->law) || !ethd_law_gains(&setup->tracking->law)->stiffness)
    printf("tracking     %s names no stiffness, so its stiffness at the ring is unknown\n", setup->tracking->law.id);
  else
    printf("tracking     not checked: (%g, %g) is out of this arm's reach\n", ETHD_LOOP_FELT_X, ETHD_LOOP_FELT_Y);
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
  figure("mass", f->loop.mass[0], 1, "kg in x", "arm.mass_x");
  figure(",", f->loop.mass[1], 1, "in y", "arm.mass_y");
  figure("; force", f->force[0], 1, "N", "--force-limit");
  figure("; friction", f->loop.friction, 1, "N", "--friction");
  figure(" and", f->loop.viscous, 1, "Ns/m", "--viscous");
  printf("\n             ");
  figure("delay", f->loop.delay, 1e3, "ms", "--delay");
  figure("; encoder count", f->loop.count * fmax(arm->link1, arm->link2), 1e6, "um at the ring", "--counts");
  figure("; finger's readings", f->latency, 1e3, "ms old", "--latency");
  if (f->delay_is[0]) printf("\n             delay: %s", f->delay_is);
  printf("\n%s", f->loop.motor_mass > 0
                     ? "             elastic transmission: included in stability; the other bounds assume a rigid one\n"
                     : "");
  feel(s);
}
