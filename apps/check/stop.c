/* How the ring stops at a wall: rest at touch and braking, in closed form. */
#include "bounds/stop.h"

#include <math.h>
#include <stdio.h>

#include "check/report.h"

/* The delay of the finger's estimate: the readings' age, unless the filter compensates it. */
static double behind(const ethd__subject *s) {
  const ethd_setup *setup = &s->config->setup;
  if (ethd_setup_get(setup, "finger_filter.compensation") == ETHD_COMPENSATION_STAMP) return 0;
  return isnan(s->device.latency) ? 0 : s->device.latency;
}

static ethd__bounds_stop stop_of(const ethd__subject *s, int axis) {
  const ethd_setup *setup = &s->config->setup;
  const ethd__figures *f = &s->device;
  return (ethd__bounds_stop){.mass = f->loop.mass[axis],
                             .force = f->force[axis],
                             .friction = isnan(f->loop.friction) ? 0 : f->loop.friction,
                             .viscous = isnan(f->loop.viscous) ? 0 : f->loop.viscous,
                             .stiffness = s->felt.stiffness[axis],
                             .behind = behind(s),
                             .gap = setup->ring_radius - setup->finger_radius};
}

static const double speeds[] = {0.2, 0.4};

static void rest_at_touch(const ethd__subject *s, int axis) {
  ethd__bounds_stop stop = stop_of(s, axis);
  double most = ethd__stop_speed(&stop);
  printf("  rest at touch, %c         gap - lag >= v^2/(2a), a = (F_sat + f_c)/m = %.4g m/s^2, gap %.4g "
         "mm\n",
         'x' + axis, ethd__stop_deceleration(&stop), 1e3 * stop.gap);
  for (int i = 0; i < 2; i++) {
    double v = speeds[i], lag = ethd__stop_lag(&stop, v), margin = ethd__stop_margin(&stop, v);
    printf("    at %.1f m/s             lag (f_c + b_v v)/K_%c + v t_f = %.3f mm, v^2/(2a) = %.3f mm: "
           "%s %.3f mm\n",
           v, 'x' + axis, 1e3 * lag, 1e3 * (stop.gap - lag - margin), margin < 0 ? "touched early by" : "left",
           1e3 * fabs(margin));
  }
  printf("    highest speed          v* = %.3f m/s without early contact", most);
  stop.stiffness = INFINITY;
  stop.behind = 0;
  printf(" (%.3f without lag)\n", ethd__stop_speed(&stop));
}

static void braking(const ethd__subject *s, int axis, double damping) {
  const ethd_setup *setup = &s->config->setup;
  ethd__bounds_stop stop = stop_of(s, axis);
  double delay = isnan(s->device.loop.delay) ? 0 : s->device.loop.delay;
  double eps_max = ethd_setup_get(setup, "transition.eps_max");
  double t_max = ethd_setup_get(setup, "transition.t_max");
  ethd__bounds_braking b = {damping, ethd_setup_get(setup, "transition.v_th"), setup->period, delay};
  for (int i = 0; i < 2; i++) {
    double time = ethd__braking_time(&stop, &b, speeds[i]), eps = ethd__braking_depth(&stop, &b, speeds[i]);
    printf("  saturated braking, %c     at %.1f m/s: Delta_s = %.3g ms, eps = %.3g mm%s\n", 'x' + axis, speeds[i],
           1e3 * time, 1e3 * eps,
           eps > eps_max  ? ": cut short by transition.eps_max"
           : time > t_max ? ": cut short by transition.t_max"
                          : "");
  }
}

static void creep(const ethd_setup *setup, double damping) {
  int capped =
      isfinite(ethd_setup_get(setup, "transition.eps_max")) || isfinite(ethd_setup_get(setup, "transition.t_max"));
  printf(
      "  creep                  a finger that pushes with F > B_d v_th = %.3g N moves the braking ring at F/B_d %s\n",
      damping * ethd_setup_get(setup, "transition.v_th"),
      capped ? "until transition.eps_max or t_max" : "for ever: transition.eps_max and t_max would end it");
}

/* Compares the law's range before the wall with the distance of a stop. */
static int looks_ahead(const ethd__subject *s, int axis) {
  const ethd_setup *setup = &s->config->setup;
  ethd__bounds_stop stop = stop_of(s, axis);
  int short_of = 0;
  if (!ETHD_LAW_HAS(setup->transition, range)) return 0;
  for (int i = 0; i < 2; i++) {
    double v = speeds[i], needed = v * v / (2 * ethd__stop_deceleration(&stop));
    double asked =
        fmax(setup->transition->range(setup->transition_p, v), setup->ring_radius - setup->finger_radius_max);
    printf("  looks ahead, %c         at %.1f m/s: begins %.3g mm before the wall, v^2/(2a) = %.3g mm: %s\n",
           'x' + axis, v, 1e3 * asked, 1e3 * needed, asked > needed ? "in time" : "TOO LATE, raise transition.range");
    short_of += !(asked > needed);
  }
  return short_of;
}

static void say_missing(const ethd__subject *s) {
  const ethd__figures *f = &s->device;
  printf("  needs");
  if (isnan(f->loop.mass[0]) && isnan(f->loop.mass[1])) printf(" arm.mass_x or arm.mass_y");
  if (isnan(f->force[0]) && isnan(f->force[1])) printf(" --force-limit or limits.torque");
  if (isnan(s->felt.stiffness[0])) printf(" a tracking law that names its stiffness");
  printf("\n");
}

int ethd__report_stop(const ethd__subject *s) {
  const ethd__figures *f = &s->device;
  const ethd_setup *setup = &s->config->setup;
  ethd__bounds_gains brake = {.damping = 0};
  (void)!ethd__bounds_gains_of(setup, ETHD_LOOP_BRAKING, &brake);
  const double b_d = isnan(ethd_setup_get(setup, "transition.v_th")) ? 0 : brake.damping;
  int said = 0, exceeded = 0;
  printf("\nstop         at a wall across each axis, with the motors' force at once%s\n",
         isnan(f->loop.friction) || isnan(f->loop.viscous) ? " (friction unknown, taken as 0)" : "");
  for (int axis = 0; axis < 2; axis++) {
    if (isnan(f->loop.mass[axis]) || !isfinite(f->force[axis]) || isnan(s->felt.stiffness[axis])) continue;
    rest_at_touch(s, axis);
    exceeded += looks_ahead(s, axis);
    if (b_d > 0) braking(s, axis, b_d);
    said = 1;
  }
  if (!said) {
    say_missing(s);
    return 0;
  }
  if (b_d > 0) creep(setup, b_d);
  printf("  to change:             a lighter ring, more force, a larger gap (ring.radius - "
         "finger.radius), a higher\n");
  printf("                         tracking.k_t%s\n", behind(s) > 0 ? ", finger_filter.compensation = stamp" : "");
  return exceeded;
}
