/* Margins of each gain in the sampled loop. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "check/report.h"

#define THIN 1.5 /* a margin under this is said to be thin */

static const char *const units_of[ETHD_LOOP_KINDS][2] = {[ETHD_LOOP_TRACKING] = {"Nm/rad", "Nms/rad"},
                                                         [ETHD_LOOP_WALL] = {"N/m", "Ns/m"},
                                                         [ETHD_LOOP_BRAKING] = {"", "Ns/m"}};

/* One loop along one axis. */
typedef struct looked_at {
  const ethd__bounds_device *device;
  const char *const *units;        /* of stiffness and damping in the configuration */
  const char *stiffness, *damping; /* their keys */
  char what[48];                   /* printed in its first row only */
  int axis;
  ethd__sampled_loop loop;
  double stiffness_scale, damping_scale; /* from the ring to the configuration's unit */
} looked_at;

/* ---- rows ---- */

static void print_row(looked_at *l, const char *key, double value, double end, const char *unit,
                      const ethd__bounds_row *row) {
  char times[16] = "";
  if (isfinite(row->margin)) snprintf(times, sizeof times, "%.3g", row->margin);
  printf("  %-20s %c %-18s %10.5g   %s %-10.5g %7s  %-8s%s\n", l->what, 'x' + l->axis, key, value,
         row->least ? ">=" : "<=", end, times, unit,
         row->margin < 1      ? " EXCEEDED"
         : row->margin < THIN ? " thin"
                              : "");
  l->what[0] = 0;
}

static void print_number(looked_at *l, const ethd__bounds_row *r) {
  double k = l->stiffness_scale, b = l->damping_scale;
  switch (r->number) {
  case ETHD_LOOP_STIFFNESS: print_row(l, l->stiffness, r->value * k, r->end * k, l->units[0], r); return;
  case ETHD_LOOP_DAMPING: print_row(l, l->damping, r->value * b, r->end * b, l->units[1], r); return;
  case ETHD_LOOP_MASS: print_row(l, l->axis ? "mass in y" : "mass in x", r->value, r->end, "kg", r); return;
  case ETHD_LOOP_DELAY:
    print_row(l, isnan(l->device->delay) ? "delay (unknown)" : "delay", 1e3 * r->value, 1e3 * r->end, "ms", r);
    return;
  default:
    print_row(l, r->least ? "velocity.cutoff" : "velocity.window", r->value, r->end, r->least ? "Hz" : "samples", r);
  }
}

/* ---- proposed changes ---- */

static const char *quicker(ethd_velocity_method method) {
  switch (method) {
  case ETHD_VELOCITY_LOWPASS: return "a higher velocity.cutoff";
  case ETHD_VELOCITY_LSQ:
  case ETHD_VELOCITY_FOAW: return "a smaller velocity.window";
  case ETHD_VELOCITY_KALMAN: return "a higher velocity.acceleration, or the true velocity.inertia";
  default: return "speeds that are measured";
  }
}

/* Largest stable value of a gain; 0: none, or no such gain. */
static double most_of(const ethd__bounds_row *rows, int count, ethd__bounds_number number) {
  for (int i = 0; i < count; i++)
    if (rows[i].number == number) return rows[i].end;
  return 0;
}

/* An unstable loop with a gain below the gain's largest stable value needs more of this gain. */
static void say_change(const looked_at *l, double most_k, double most_b) {
  const ethd__sampled_loop *loop = &l->loop;
  printf("  to change:           ");
  if (most_k > 0) printf("%s at most %.4g, or ", l->stiffness, most_k * l->stiffness_scale);
  if (loop->damping < most_b)
    printf("more %s (up to %.4g), or ", l->damping, most_b * l->damping_scale);
  else if (most_b > 0)
    printf("%s at most %.4g, or ", l->damping, most_b * l->damping_scale);
  printf("%s%s, a shorter loop.period, more mass\n", loop->delay || loop->late > 0 ? "less delay, " : "",
         quicker(loop->method));
}

/* Effect of friction on rows that are EXCEEDED without it. */
static void say_held(const looked_at *l) {
  const ethd__bounds_hold hold = ethd__bounds_holds(&l->loop, l->device);
  if (isnan(hold.held)) return;
  printf("  friction             ");
  if (!isfinite(hold.held)) {
    printf("compensates this: %.3g Ns/m are needed, the device has %.3g\n", hold.needed, l->device->viscous);
    return;
  }
  printf("stops swings slower than %.3g mm/s at the motors, no faster ones", 1e3 * hold.held);
  if (!isnan(hold.kick))
    printf("; one encoder count makes %.3g mm/s: %s", 1e3 * hold.kick,
           hold.kick > hold.held ? "the ring chatters" : "the ring is quiet until it is pushed");
  printf("\n");
}

/* ---- one loop ---- */

/* Only a damper or friction can compensate the energy of the hold. */
static int undamped(const looked_at *l) {
  double needed = ethd__sampled_damping_needed(&l->loop), b = l->device->viscous;
  printf("  %-20s has no damping; sampling and delay act as the negative damping K (T (n + 1/2) + t_d) = %.4g Ns/m, "
         "and viscous friction must be as large; ",
         l->what, needed);
  if (isnan(b))
    printf("give --viscous\n");
  else if (b >= needed)
    printf("the device has %.4g\n", b);
  else
    printf("the device has %.4g: EXCEEDED\n  to change:           %s at most %.4g, or a damped law\n", b, l->stiffness,
           l->loop.stiffness * l->stiffness_scale * b / needed);
  return b < needed;
}

static int unknown_mass(const looked_at *l) {
  double least = ethd__sampled_mass_min(&l->loop);
  if (isinf(least))
    printf("  %-20s %c unstable at any mass: EXCEEDED\n", l->what, 'x' + l->axis);
  else
    printf("  %-20s %c stable from %.3g kg on; arm.mass_%c would give its margins\n", l->what, 'x' + l->axis, least,
           'x' + l->axis);
  return isinf(least);
}

static int report_loop(looked_at *l) {
  ethd__bounds_row rows[ETHD_LOOP_NUMBERS];
  if (!(l->loop.stiffness > 0) && !(l->loop.damping > 0)) return 0;
  if (!(l->loop.damping > 0)) return l->axis ? 0 : undamped(l);
  if (isnan(l->device->mass[l->axis])) return unknown_mass(l);
  int count = ethd__bounds_rows(&l->loop, rows);
  for (int i = 0; i < count; i++) print_number(l, &rows[i]);
  if (ethd__sampled_stable(&l->loop)) return 0;
  say_held(l);
  say_change(l, most_of(rows, count, ETHD_LOOP_STIFFNESS), most_of(rows, count, ETHD_LOOP_DAMPING));
  return 1;
}

/* ---- all loops ---- */

/* Both axes of a loop of a setup. */
static int report_axes(const ethd_setup *setup, const ethd__bounds_device *device, ethd__bounds_kind kind,
                       const char *what) {
  int exceeded = 0;
  ethd__bounds_gains gains;
  if (!ethd__bounds_gains_of(setup, kind, &gains)) return 0;
  for (int axis = 0; axis < 2; axis++) {
    looked_at l = {.device = device,
                   .units = units_of[kind],
                   .stiffness = *gains.stiffness_key ? gains.stiffness_key : "stiffness",
                   .damping = *gains.damping_key ? gains.damping_key : "damping",
                   .axis = axis,
                   .stiffness_scale = 1,
                   .damping_scale = 1};
    snprintf(l.what, sizeof l.what, "%s", what);
    if (!ethd__bounds_of(setup, device, kind, axis, &l.loop)) continue;
    if (kind == ETHD_LOOP_TRACKING) {
      l.stiffness_scale = gains.stiffness / l.loop.stiffness;
      l.damping_scale = gains.damping / l.loop.damping;
    }
    exceeded += report_loop(&l);
  }
  return exceeded;
}

/* The setup, with a material's numbers in the contact law; numbers of other laws don't count. */
static ethd_setup on_material(const ethd_setup *setup, const ethd_material *m) {
  ethd_setup changed = *setup;
  for (uint32_t i = 0; i < m->count; i++) {
    char name[64];
    snprintf(name, sizeof name, "contact.%s", m->values[i].name);
    (void)!ethd_setup_set(&changed, name, m->values[i].value, NULL);
  }
  return changed;
}

static int report_walls(const ethd_setup *setup, const ethd__bounds_device *device) {
  const ethd_material *m;
  int exceeded = report_axes(setup, device, ETHD_LOOP_WALL, ethd__bounds_names[ETHD_LOOP_WALL]);
  for (size_t i = 0; setup->scene && (m = ethd_scene_material(setup->scene, i)) != NULL; i++) {
    ethd_setup changed = on_material(setup, m);
    char what[48];
    snprintf(what, sizeof what, "wall of %s", m->name);
    exceeded += report_axes(&changed, device, ETHD_LOOP_WALL, what);
  }
  double c_e = ethd_setup_get(setup, "contact.c_e"), k_e = ethd_setup_get(setup, "contact.k_e");
  if (c_e > 0)
    printf("  wall's damping K_e c_e p grows with the depth p, %.4g Ns/m at 1 mm: not counted\n",
           c_e * (isnan(k_e) ? 0 : k_e) * 1e-3);
  return exceeded;
}

void ethd__report_unjudged(const ethd_setup *setup) {
  for (int kind = 0; kind < ETHD_LOOP_KINDS; kind++) {
    const ethd_law *law = ethd__bounds_unjudged(setup, (ethd__bounds_kind)kind);
    if (law)
      printf("not judged: %s, because the law %s doesn't name its gains; try small ones first\n",
             ethd__bounds_names[kind], law->id);
  }
}

int ethd__report_stability(const ethd_setup *setup, const ethd__bounds_device *device) {
  char velocity[96];
  ethd__velocity_text(setup, velocity, sizeof velocity);
  printf("\nstability    of the sampled loop: spectral radius of one tick, the ring's mass under "
         "zero-order hold,\n");
  printf("             velocity %s; one number at a time, axes apart, no friction\n", velocity);
  printf("  %-20s   %-18s %10s   %-13s %7s\n", "loop", "", "is", "stable", "margin");
  int exceeded = report_axes(setup, device, ETHD_LOOP_TRACKING, ethd__bounds_names[ETHD_LOOP_TRACKING]);
  exceeded += report_walls(setup, device);
  return exceeded + report_axes(setup, device, ETHD_LOOP_BRAKING, ethd__bounds_names[ETHD_LOOP_BRAKING]);
}

/* The guard's stop is judged like any other damping. It uses the setup's dynamics, which may differ from the device's
   figures here. */
int ethd__report_guard(const ethd_setup *setup, const ethd__bounds_device *device) {
  const ethd_limits *limits = &setup->limits;
  const double most = isfinite(limits->stop_time) ? limits->stop_time : ETHD_STOP_TIME;
  ethd_velocity velocity;
  if (ethd_velocity_prepare(setup->velocity, setup->velocity_p, setup->period, &velocity, NULL) < 0) return 0;
  const ethd_guard_device g =
      ethd_guard_device_of(&setup->arm, &setup->dynamics, limits->gap, setup->period, ethd_velocity_lag(&velocity));
  int exceeded = 0;
  printf("\nguard        stops the ring by a damping of m/(e reaction), reaction = t_d + T + lag, for limits.stop_time "
         "at most\n");
  for (int axis = 0; axis < 2; axis++) {
    looked_at l = {.device = device, .axis = axis, .what = "guard's stop"};
    if (!ethd__bounds_of(setup, device, ETHD_LOOP_BRAKING, axis, &l.loop)) continue;
    const double b = ethd_guard_damping(&g, g.inertia[axis] / (g.link[axis] * g.link[axis]), true);
    const double end = isnan(device->mass[axis]) ? NAN : ethd__sampled_damping_max(&l.loop);
    const ethd__bounds_row row = {ETHD_LOOP_DAMPING, b, end, false, end / b};
    if (isnan(end)) continue;
    print_row(&l, "m/(e reaction)", b, end, "Ns/m", &row);
    exceeded += row.margin < 1;
  }
  if (isnan(setup->dynamics.mass[0]) || isnan(setup->dynamics.mass[1]))
    printf("  guard's stop           arm.mass_x and mass_y unknown: a ring heavier than %.3g kg loses its torque\n",
           1.2 * ETHD_MASS_ASSUMED);
  const double needed = ethd_guard_stop_time(&g, limits);
  if (needed > 0)
    printf("  guard's stop         from limits.speed takes %.3g s, limits.stop_time is %.3g s%s\n", needed, most,
           needed > most ? ": EXCEEDED" : "");
  return exceeded + (needed > most);
}
