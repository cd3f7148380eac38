/* The distance before a wall at which a device in space has to react, in closed form. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "check/report.h"

typedef struct reaction {
  double a;         /* m/s^2: the device's deceleration; NaN: not known */
  double late;      /* s from a command to its motion, plus the period for which it is held */
  const char *from; /* where the delay is from */
  double gap;       /* m between finger and effector */
} reaction;

static double param(const ethd_space_setup *s, const char *name, double otherwise) {
  const double value = ethd_space_get(s, name);
  return isnan(value) ? otherwise : value;
}

/* Returns what the device can do along the worst of the axes, as it stands; NaN: it doesn't say. */
static ethd_ability worst_of(const ethd_device *device) {
  ethd_ability worst = ethd_ability_unknown();
  for (int k = 0; k < 6; k++) {
    double n[3] = {0, 0, 0};
    n[k / 2] = k % 2 ? -1 : 1;
    const ethd_ability a = ethd_device_able(device, n);
    if (a.acceleration <= 0) continue; /* no joint moves it that way */
    worst.acceleration = fmin(worst.acceleration, a.acceleration);
    worst.force = fmin(worst.force, a.force);
    worst.mass = fmax(worst.mass, a.mass);
    worst.delay = fmax(worst.delay, a.delay);
  }
  return worst;
}

/* The device's reaction in the law `approach`. */
static reaction reaction_of(const ethd_space_setup *s, const ethd_device *device) {
  const ethd_ability said = device ? worst_of(device) : ethd_ability_unknown();
  const bool knows = !isnan(said.acceleration) || !isnan(said.delay) || !isnan(said.mass);
  const ethd_ability *able = knows ? &said : &s->ability;
  const double limit = s->kind == ETHD_SPACE_VELOCITY ? s->acceleration : (double)INFINITY;
  double a = fmin(isnan(able->acceleration) ? able->force / able->mass : able->acceleration, limit);
  if (!(a < 1e6)) a = param(s, "transition.acceleration", NAN);
  const char *from = knows ? "of the device" : "of [ability]";
  return (reaction){.a = param(s, "transition.effort", 1) * a,
                    .late = (isnan(able->delay) ? 0 : able->delay) + s->period,
                    .gap = s->radius - s->finger_radius,
                    .from = isnan(able->delay) ? "not known (0; [ability] delay gives it)" : from};
}

static double distance(const reaction *r, double v) { return v * r->late + v * v / (2 * r->a); }

/* Returns the speed whose distance is d, in the form without cancellation. */
static double speed_of(const reaction *r, double d) {
  return 2 * d / (r->late + sqrt(r->late * r->late + 2 * d / r->a));
}

int ethd__report_space(const ethd_space_setup *s, const ethd_device *device) {
  static const double speeds[] = {0.2, 0.4};
  const reaction r = reaction_of(s, device);
  int exceeded = 0;
  printf("reaction distance        v t_d + v^2/(2a): the finger comes closer by this until the effector stands at the "
         "wall\n");
  printf("  t_d                    %.4g ms: delay %s, and the period %.4g ms\n", 1e3 * r.late, r.from, 1e3 * s->period);
  if (strcmp(s->transition->law.id, ethd_transition_approach.law.id))
    printf("  law                    %s isn't judged: these figures are those of a law that brakes with a\n",
           s->transition->law.id);
  if (isnan(r.a)) {
    printf("  a                      not known: [ability] acceleration, or force and mass, give it\n");
    return 0;
  }
  printf("  a                      %.4g m/s^2%s\n", r.a,
         device ? ": the law's share of the least that setup and device allow along x, y and z" : "");
  for (int i = 0; i < 2; i++) {
    const double need = distance(&r, speeds[i]);
    printf("  at %.1f m/s             %.3f mm of the gap of %.3f mm: %s\n", speeds[i], 1e3 * need, 1e3 * r.gap,
           need > r.gap ? "the finger arrives before the effector stands; a larger space.radius leaves it time"
                        : "the effector stands when the finger arrives");
    exceeded += need > r.gap;
  }
  printf("  highest speed          %.3f m/s at which the gap is enough\n", speed_of(&r, r.gap));
  const double wait = param(s, "transition.wait", 0);
  if (wait > 0 && s->effector == ETHD_EFFECTOR_PLATE)
    printf("  wait                   the plate stands at the wall while the finger is within %.4g mm of it\n",
           1e3 * (wait + s->radius - s->finger_radius));
  const double range = param(s, "transition.range", NAN);
  if (isnan(range)) return exceeded;
  const bool is_short = s->speed < (double)INFINITY && distance(&r, s->speed) > range;
  printf("  range                  %.4g m before the wall, enough to stop from %.3f m/s%s\n", range,
         speed_of(&r, range), is_short ? ": space.speed is higher; a larger transition.range is needed" : "");
  return exceeded + is_short;
}
