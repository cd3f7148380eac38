/* Margins of each gain in the sampled loop. */
#include "bounds/stability.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "check/report.h"

#define THIN 1.5 /* a margin under this is said to be thin */

/* One loop along one axis: gains at the ring, and what they are called in the configuration. */
typedef struct gains {
  char what[48];
  const char *stiffness_key, *damping_key;
  double stiffness, damping;             /* N/m, Ns/m; 0: none */
  double stiffness_scale, damping_scale; /* from the ring to the key's unit */
  const char *stiffness_unit, *damping_unit;
} gains;

static ethd__sampled_loop loop_of(const ethd__subject *s, const gains *g, int axis) {
  const ethd_setup *setup = &s->config->setup;
  double delay = isnan(s->device.delay) ? 0 : s->device.delay, mass = s->device.mass[axis];
  int ticks = (int)floor(delay / setup->period * (1 + 1e-12));
  ethd__sampled_loop loop = {.mass = isnan(mass) ? 1 : mass,
                             .period = setup->period,
                             .stiffness = g->stiffness,
                             .damping = g->damping,
                             .delay = ticks,
                             .late = fmax(0, delay - ticks * setup->period),
                             .method = setup->velocity,
                             .link = axis ? setup->arm.link2 : setup->arm.link1};
  if (s->device.compliant) {
    loop.motor_mass = s->device.motor_mass;
    loop.spring = s->device.spring;
    loop.damper = s->device.damper;
  }
  if (loop.late < 1e-9 * setup->period) loop.late = 0;
  memcpy(loop.p, setup->velocity_p, sizeof loop.p);
  return loop;
}

/* ---- rows ---- */

/* The loop's name stands in its first row only. `margin`: how many times. */
static void row(gains *g, int axis, const char *key, double value, const char *relation, double end, double margin,
                const char *unit) {
  char times[16] = "";
  if (isfinite(margin)) snprintf(times, sizeof times, "%.3g", margin);
  printf("  %-20s %c %-18s %10.5g   %s %-10.5g %7s  %-8s%s\n", g->what, 'x' + axis, key, value, relation, end, times,
         unit,
         margin < 1      ? " EXCEEDED"
         : margin < THIN ? " thin"
                         : "");
  g->what[0] = 0;
}

static void gain_rows(gains *g, int axis, double most_k, double most_b) {
  double k = g->stiffness, b = g->damping;
  if (k > 0)
    row(g, axis, g->stiffness_key, k * g->stiffness_scale, "<=", most_k * g->stiffness_scale, most_k / k,
        g->stiffness_unit);
  row(g, axis, g->damping_key, b * g->damping_scale, "<=", most_b * g->damping_scale, most_b / b, g->damping_unit);
}

/* How much delay, sampling period and so on the same gains tolerate. */
static void other_rows(const ethd__subject *s, gains *g, int axis, const ethd__sampled_loop *loop) {
  double mass = loop->mass, least = ethd__sampled_mass_min(loop), delay = loop->delay * loop->period + loop->late;
  double longest = ethd__sampled_delay_max(loop), end = ethd__sampled_velocity_end(loop);
  if (isfinite(least)) row(g, axis, axis ? "mass in y" : "mass in x", mass, ">=", least, mass / least, "kg");
  if (longest >= 0)
    row(g, axis, isnan(s->device.delay) ? "delay (unknown)" : "delay", 1e3 * delay, "<=", 1e3 * longest,
        delay > 0 ? longest / delay : NAN, "ms");
  if (isnan(end)) return;
  int lowpass = loop->method == ETHD_VELOCITY_LOWPASS;
  row(g, axis, lowpass ? "velocity.cutoff" : "velocity.window", loop->p[0], lowpass ? ">=" : "<=", end,
      lowpass ? loop->p[0] / end : end / loop->p[0], lowpass ? "Hz" : "samples");
}

static const char *quicker(const ethd_setup *s) {
  switch (s->velocity) {
  case ETHD_VELOCITY_LOWPASS: return "a higher velocity.cutoff";
  case ETHD_VELOCITY_LSQ:
  case ETHD_VELOCITY_FOAW: return "a smaller velocity.window";
  case ETHD_VELOCITY_KALMAN: return "a higher velocity.acceleration, or the true velocity.inertia";
  default: return "speeds that are measured";
  }
}

/* An unstable loop whose gain is below its largest stable value needs more of that gain. */
static void say_change(const ethd__subject *s, const gains *g, const ethd__sampled_loop *loop, double most_k,
                       double most_b) {
  printf("  to change:           ");
  if (g->stiffness > 0 && most_k > 0) printf("%s at most %.4g, or ", g->stiffness_key, most_k * g->stiffness_scale);
  if (g->damping < most_b)
    printf("more %s (up to %.4g), or ", g->damping_key, most_b * g->damping_scale);
  else if (most_b > 0)
    printf("%s at most %.4g, or ", g->damping_key, most_b * g->damping_scale);
  printf("%s%s, a shorter loop.period, more mass\n", loop->delay || loop->late > 0 ? "less delay, " : "",
         quicker(&s->config->setup));
}

/* ---- one loop ---- */

/* Only a damper, or friction, can make up for what the hold takes. */
static int undamped(const ethd__subject *s, const gains *g, const ethd__sampled_loop *loop) {
  double needed = ethd__sampled_damping_needed(loop), b = s->device.viscous;
  printf("  %-20s has no damping: the hold takes K (T (n + 1/2) + t_d) = %.4g Ns/m, for friction to give; ", g->what,
         needed);
  if (isnan(b))
    printf("give --viscous\n");
  else if (b >= needed)
    printf("the device has %.4g\n", b);
  else
    printf("the device has %.4g: EXCEEDED\n  to change:           %s at most %.4g, or a damped law\n", b,
           g->stiffness_key, g->stiffness * g->stiffness_scale * b / needed);
  return b < needed;
}

static int unknown_mass(const gains *g, int axis, const ethd__sampled_loop *loop) {
  double least = ethd__sampled_mass_min(loop);
  if (isinf(least))
    printf("  %-20s %c unstable at any mass: EXCEEDED\n", g->what, 'x' + axis);
  else
    printf("  %-20s %c stable from %.3g kg on; arm.mass_%c would give its margins\n", g->what, 'x' + axis, least,
           'x' + axis);
  return isinf(least);
}

static int report_loop(const ethd__subject *s, gains *g, int axis) {
  ethd__sampled_loop loop = loop_of(s, g, axis);
  if (!(g->stiffness > 0) && !(g->damping > 0)) return 0;
  if (!(g->damping > 0)) return axis ? 0 : undamped(s, g, &loop);
  if (isnan(s->device.mass[axis])) return unknown_mass(g, axis, &loop);
  double most_k = g->stiffness > 0 ? ethd__sampled_stiffness_max(&loop) : 0, most_b = ethd__sampled_damping_max(&loop);
  gain_rows(g, axis, most_k, most_b);
  other_rows(s, g, axis, &loop);
  if (ethd__sampled_stable(&loop)) return 0;
  say_change(s, g, &loop, most_k, most_b);
  return 1;
}

/* ---- all loops ---- */

static int tracking(const ethd__subject *s, int axis) {
  const ethd_setup *setup = &s->config->setup;
  gains g = {.what = "tracking",
             .stiffness_key = "tracking.k_t",
             .damping_key = "tracking.b_t",
             .stiffness_unit = "Nm/rad",
             .damping_unit = "Nms/rad"};
  if (isnan(s->k[axis])) return 0;
  g.stiffness = s->k[axis];
  g.damping = s->d[axis];
  g.stiffness_scale = ethd_setup_get(setup, "tracking.k_t") / g.stiffness;
  g.damping_scale = ethd_setup_get(setup, "tracking.b_t") / g.damping;
  return report_loop(s, &g, axis);
}

static double or_zero(double value) { return isnan(value) ? 0 : value; }

/* `setup` has the numbers of the wall's material. */
static int wall(const ethd__subject *s, const char *what, const ethd_setup *setup, int axis) {
  gains g = {.stiffness_key = "contact.k_e",
             .damping_key = "contact.b_e",
             .stiffness = or_zero(ethd_setup_get(setup, "contact.k_e")),
             .damping = or_zero(ethd_setup_get(setup, "contact.b_e")),
             .stiffness_scale = 1,
             .damping_scale = 1,
             .stiffness_unit = "N/m",
             .damping_unit = "Ns/m"};
  snprintf(g.what, sizeof g.what, "%s", what);
  return report_loop(s, &g, axis);
}

/* The setup, with a material's numbers in the contact law; those that another law knows don't count. */
static ethd_setup on_material(const ethd_setup *setup, const ethd_material *m) {
  ethd_setup changed = *setup;
  for (uint32_t i = 0; i < m->count; i++) {
    char name[64];
    snprintf(name, sizeof name, "contact.%s", m->values[i].name);
    (void)!ethd_setup_set(&changed, name, m->values[i].value, NULL);
  }
  return changed;
}

static int walls(const ethd__subject *s) {
  const ethd_setup *setup = &s->config->setup;
  const ethd_material *m;
  int exceeded = 0;
  for (int axis = 0; axis < 2; axis++) exceeded += wall(s, "wall", setup, axis);
  for (size_t i = 0; setup->scene && (m = ethd_scene_material(setup->scene, i)) != NULL; i++) {
    ethd_setup changed = on_material(setup, m);
    char what[48];
    snprintf(what, sizeof what, "wall of %s", m->name);
    for (int axis = 0; axis < 2; axis++) exceeded += wall(s, what, &changed, axis);
  }
  double c_e = ethd_setup_get(setup, "contact.c_e");
  if (c_e > 0)
    printf("  wall's damping K_e c_e p grows with the depth p, %.4g Ns/m at 1 mm: not counted\n",
           c_e * or_zero(ethd_setup_get(setup, "contact.k_e")) * 1e-3);
  return exceeded;
}

static int braking(const ethd__subject *s, int axis) {
  const ethd_setup *setup = &s->config->setup;
  gains g = {.what = "braking",
             .damping_key = "transition.b_d",
             .damping = or_zero(ethd_setup_get(setup, "transition.b_d")),
             .damping_scale = 1,
             .damping_unit = "Ns/m"};
  return report_loop(s, &g, axis);
}

int ethd__report_stability(const ethd__subject *s) {
  char velocity[96];
  int exceeded = 0;
  ethd__velocity_text(&s->config->setup, velocity, sizeof velocity);
  printf("\nstability    of the sampled loop: spectral radius of one tick, the ring's mass under "
         "zero-order hold,\n");
  printf("             velocity %s; one number at a time, axes apart, no friction\n", velocity);
  printf("  %-20s   %-18s %10s   %-13s %7s\n", "loop", "", "is", "stable", "margin");
  for (int axis = 0; axis < 2; axis++) exceeded += tracking(s, axis);
  exceeded += walls(s);
  for (int axis = 0; axis < 2; axis++) exceeded += braking(s, axis);
  return exceeded;
}
