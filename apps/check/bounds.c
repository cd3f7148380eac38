#include <math.h>
#include <stdio.h>
#include <string.h>

#include "check/report.h"
#include "check/stability.h"
#include "file/config_parts.h"

/* One loop of the controller along one axis. */
typedef struct gains {
  const char *what, *stiffness_name, *damping_name;
  double stiffness, damping; /* N/m, Ns/m at the ring */
} gains;

typedef struct axis {
  const char *name;
  double mass, link;
} axis;

static const char *law_value(const ethd_law *law, const double *p, const char *name, double *out) {
  int i = ethd_params_find(law->params, law->param_count, name);
  *out = i < 0 ? 0 : p[i];
  return i < 0 ? NULL : name;
}

static ethd_loop loop_of(const ethd__bounds *b, const gains *g, const axis *a) {
  const ethd_setup *s = &b->config->setup;
  ethd_loop loop = {.mass = a->mass,
                    .period = s->period,
                    .stiffness = g->stiffness,
                    .damping = g->damping,
                    .delay = b->delay,
                    .method = s->velocity,
                    .link = a->link};
  memcpy(loop.p, s->velocity_p, sizeof loop.p);
  return loop;
}

/* ---- one loop ---- */

static void say_gains(const gains *g, const axis *a) {
  printf("%-9s %s  ", g->what, a->name);
  if (g->stiffness > 0) printf("%s = %.5g N/m", g->stiffness_name, g->stiffness);
  if (g->damping > 0)
    printf("%s%s = %.5g Ns/m", g->stiffness > 0 ? ", " : "", g->damping_name, g->damping);
}

static void say_velocity(const ethd__bounds *b) {
  const ethd_setup *s = &b->config->setup;
  const ethd_method *m = &ethd_velocity_methods[s->velocity];
  printf(" with your velocity %s", m->id);
  if (m->param_count) {
    bool pure = strcmp(m->params[0].unit, "1") == 0;
    printf(" (%s %.5g%s%s)", m->params[0].name, s->velocity_p[0], pure ? "" : " ",
           pure ? "" : m->params[0].unit);
  }
  if (b->delay) printf(" and %d tick%s of delay", b->delay, b->delay > 1 ? "s" : "");
}

static void say_largest(const ethd_loop *loop, const gains *g) {
  if (g->stiffness > 0)
    printf("; largest %s %.5g N/m", g->stiffness_name, ethd__loop_stiffness_max(loop));
  if (g->damping > 0) printf("; largest %s %.5g Ns/m", g->damping_name, ethd__loop_damping_max(loop));
  if (g->damping > 0 && !(g->stiffness > 0))
    printf(" (backward difference: %.5g)",
           ethd__loop_damping_free(loop->mass, loop->period, loop->delay));
}

static int report_loop(const ethd__bounds *b, const gains *g, const axis *a) {
  ethd_loop loop = loop_of(b, g, a);
  double least = 0;
  say_gains(g, a);
  if (!(g->stiffness > 0 || g->damping > 0)) {
    printf("no gains\n");
    return 0;
  }
  if (isnan(a->mass)) loop.mass = 1;
  least = ethd__loop_mass_min(&loop);
  bool known = !isnan(a->mass), stable = known ? ethd__loop_stable(&loop) : least < (double)INFINITY;
  if (least == (double)INFINITY)
    printf(" is unstable at any mass without friction: over %.3g Ns/m of damping make up for the hold",
           ethd__loop_damping_needed(&loop));
  else if (stable)
    printf(" is stable from %.3g kg on", least);
  else
    printf(" is unstable under %.3g kg", least), say_velocity(b);
  if (known) {
    printf("; the arm has %.5g kg", a->mass);
    say_largest(&loop, g);
  } else {
    printf("; give arm.mass_%s to check", a->name);
  }
  printf("\n");
  return !stable;
}

/* ---- all loops ---- */

/* J^-T K J^-1 with K = k I: what a joint gain is at the ring. */
static void at_ring(const double ji[4], double k, double out[3]) {
  out[0] = k * (ji[0] * ji[0] + ji[2] * ji[2]);
  out[1] = k * (ji[0] * ji[1] + ji[2] * ji[3]);
  out[2] = k * (ji[1] * ji[1] + ji[3] * ji[3]);
  if (fabs(out[1]) < 1e-9 * (out[0] + out[2])) out[1] = 0;
}

#define POSE_X 0.25
#define POSE_Y 0.25

static int report_tracking(const ethd__bounds *b, const axis axes[2]) {
  const ethd_setup *s = &b->config->setup;
  double q[2], k_t, b_t, k[3], d[3];
  ethd_pose pose;
  const char *has_k = law_value(&s->tracking->law, s->tracking_p, "k_t", &k_t);
  law_value(&s->tracking->law, s->tracking_p, "b_t", &b_t);
  if (!has_k) return 0;
  if (ethd_arm_angles(&s->arm, (ethd_vec){POSE_X, POSE_Y}, -1, q)) {
    printf("tracking     not checked: (%g, %g) is out of this arm's reach\n", POSE_X, POSE_Y);
    return 0;
  }
  ethd_arm_pose(&s->arm, q, &pose);
  at_ring(pose.j_inv, k_t, k);
  at_ring(pose.j_inv, b_t, d);
  printf(
      "felt at the ring at (%g, %g) m: %.5g N/m in x, %.5g in y, %.5g across; %.5g, %.5g, %.5g Ns/m\n",
      POSE_X, POSE_Y, k[0], k[2], k[1], d[0], d[2], d[1]);
  const gains x = {"tracking", "K_x", "B_x", k[0], d[0]}, y = {"tracking", "K_y", "B_y", k[2], d[2]};
  return report_loop(b, &x, &axes[0]) + report_loop(b, &y, &axes[1]);
}

static int report_wall(const ethd__bounds *b, const axis axes[2]) {
  const ethd_setup *s = &b->config->setup;
  gains g = {"wall", "K_e", "B_e", 0, 0};
  double c_e;
  if (!law_value(&s->contact->law, s->contact_p, "k_e", &g.stiffness)) return 0;
  law_value(&s->contact->law, s->contact_p, "b_e", &g.damping);
  int exceeded = report_loop(b, &g, &axes[0]) + report_loop(b, &g, &axes[1]);
  ethd_loop loop = loop_of(b, &g, &axes[0]);
  printf("wall         passive only with a friction of %.5g Ns/m or more (K_e T/2 + B_e)\n",
         ethd__loop_passive_friction(&loop));
  if (law_value(&s->contact->law, s->contact_p, "c_e", &c_e) && c_e > 0)
    printf(
        "wall         its damping K_e c_e p grows with the depth p: %.5g Ns/m at 1 mm, not counted above\n",
        g.stiffness * c_e * 1e-3);
  return exceeded;
}

static int report_braking(const ethd__bounds *b, const axis axes[2]) {
  const ethd_setup *s = &b->config->setup;
  gains g = {"braking", "", "B_d", 0, 0};
  if (!law_value(&s->transition->law, s->transition_p, "b_d", &g.damping)) return 0;
  return report_loop(b, &g, &axes[0]) + report_loop(b, &g, &axes[1]);
}

/* One count per tick is what a backward difference makes of the smallest motion. */
static int report_threshold(const ethd__bounds *b) {
  const ethd_setup *s = &b->config->setup;
  double v_th;
  if (!law_value(&s->transition->law, s->transition_p, "v_th", &v_th)) return 0;
  if (isnan(b->count)) {
    printf("v_th         %.5g m/s; give --counts to compare it with the encoder's\n", v_th);
    return 0;
  }
  double step = b->count * fmax(s->arm.link1, s->arm.link2) / s->period;
  printf("v_th         %.5g m/s is %s one encoder count per tick, %.5g m/s at the ring%s\n", v_th,
         v_th < step ? "below" : "above", step,
         v_th < step ? ": the estimator must average, or a single count keeps the braking on" : "");
  return v_th < step && s->velocity == ETHD_VELOCITY_DIFFERENCE;
}

int ethd__report_bounds(const ethd__bounds *b) {
  const ethd_arm *arm = &b->config->setup.arm;
  const axis axes[2] = {{"x", b->config->mass_x, arm->link1}, {"y", b->config->mass_y, arm->link2}};
  int exceeded = report_tracking(b, axes);
  exceeded += report_wall(b, axes);
  exceeded += report_braking(b, axes);
  return exceeded + report_threshold(b);
}
