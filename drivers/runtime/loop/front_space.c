/* The loop's front for space: an end effector among surfaces, forces or velocities, ethd_space. */
#include "loop/loop.h"

#include <math.h>
#include <string.h>

#define UNIT 1e-5 /* allowed difference from 1 of the square of a normal's length */
#define KEPT (ETHD_SPACE_HAVE_NORMAL | ETHD_SPACE_HAVE_ABILITY)

static ethd_status read_effector(ethd_loop *l) ETHD_RT {
  if (!l->held) memset(&l->sense.space, 0, sizeof l->sense.space);
  return ethd_device_read_space(l->def.device, l->due, &l->sense.space);
}

static void blind_effector(ethd_loop *l) ETHD_RT {
  for (int i = 0; i < 3; i++) l->sense.space.x[i] = (double)NAN;
}

static void keep(const ethd_space_sense *s, ethd__effector *last) ETHD_RT {
  last->time_ns = s->time_ns;
  last->have = s->have & KEPT;
  memcpy(last->x, s->x, sizeof s->x);
  memcpy(last->v, s->v, sizeof s->v);
  memcpy(last->normal, s->normal, sizeof s->normal);
  memcpy(last->ability, s->ability, sizeof s->ability);
}

static void put_back(const ethd__effector *last, ethd_space_sense *s) ETHD_RT {
  s->time_ns = last->time_ns;
  s->have = (s->have & ~(int64_t)KEPT) | last->have;
  memcpy(s->x, last->x, sizeof s->x);
  memcpy(s->v, last->v, sizeof s->v);
  memcpy(s->normal, last->normal, sizeof s->normal);
  memcpy(s->ability, last->ability, sizeof s->ability);
}

/* The controller must know the part of a command that the soft start passes: the limit of its change starts there. */
static void remember_effector(ethd_loop *l, bool is_new) ETHD_RT {
  ethd_space_sense *s = &l->sense.space;
  if (is_new)
    keep(s, &l->last.effector);
  else
    put_back(&l->last.effector, s);
  if (!l->near.altered || s->have & ETHD_SPACE_HAVE_COMMANDED) return;
  s->have |= ETHD_SPACE_HAVE_COMMANDED;
  memcpy(s->commanded, l->near.given, sizeof s->commanded);
}

/* ---- near surfaces ---- */

/* Returns the nearest surface along its normal, among those that a step accepts; NULL: there is none. */
static const ethd_surface *nearest(const ethd__near *near, const double x[3]) ETHD_RT {
  const ethd_surface *found = NULL;
  double least = (double)INFINITY;
  if (near->count > ETHD_SURFACES_MAX) return NULL;
  for (uint32_t i = 0; i < near->count; i++) {
    const ethd_surface *s = &near->at[i];
    const double d = ethd_vec3_dot(s->n, ethd_vec3_sub(s->point, ethd_vec3_of(x)));
    if (!(d < least) || !(fabs(ethd_vec3_dot(s->n, s->n) - 1) <= UNIT)) continue;
    least = d;
    found = s;
  }
  return found;
}

/* Adds the device's ability along n, if any of it is known. */
static void tell_ability(ethd_loop *l, const ethd_surface *along) ETHD_RT {
  ethd_space_sense *s = &l->sense.space;
  double n[3];
  ethd_vec3_put(along->n, n);
  const ethd_ability a = ethd_device_able(l->def.device, n);
  const double able[ETHD_ABILITY] = {a.speed, a.acceleration, a.delay, a.mass, a.force, a.friction};
  bool known = false;
  for (int i = 0; i < ETHD_ABILITY; i++) known |= !isnan(able[i]);
  if (!known) return;
  memcpy(s->ability, able, sizeof able);
  s->have |= ETHD_SPACE_HAVE_ABILITY;
}

/* An effector with an unknown position has no near surfaces. */
static void look_around(ethd_loop *l) ETHD_RT {
  const ethd_space_sense *s = &l->sense.space;
  const bool seen = l->def.surfaces && !isnan(s->x[0] + s->x[1] + s->x[2]);
  l->near.count = seen ? l->def.surfaces(l->def.surfaces_of, s, l->near.at) : 0;
  const ethd_surface *along = nearest(&l->near, s->x);
  if (along && !(s->have & ETHD_SPACE_HAVE_ABILITY)) tell_ability(l, along);
}

/* ---- the controller ---- */

static void rehearse_space(ethd_loop *l) ETHD_RT {
  (void)!ethd_space_rehearse(l->def.space, &l->sense.space, l->near.at, l->near.count, &l->command.space);
}

static bool step_space(ethd_loop *l) ETHD_RT {
  ethd_space_trace *trace = &l->row.space.trace;
  (void)!ethd_space_step(l->def.space, &l->sense.space, l->near.at, l->near.count, &l->command.space, trace);
  return trace->swap != 0;
}

static bool is_safe_space(const ethd_loop *l) ETHD_RT { return l->command.space.safe; }

static ethd_status write_space(ethd_loop *l, bool armed, double share) ETHD_RT {
  ethd_space_command *c = &l->command.space;
  l->near.altered = armed ? share < 1 : !c->safe;
  for (int i = 0; i < 3; i++) c->value[i] = armed ? share * c->value[i] : 0;
  memcpy(l->near.given, c->value, sizeof c->value);
  if (!armed) {
    c->kind = ethd_space_commands(l->def.space); /* before the first step it isn't set yet */
    c->safe = 1;
  }
  return ethd_device_write_space(l->def.device, l->due, c);
}

static void acknowledge_space(ethd_loop *l) ETHD_RT { ethd_space_acknowledge(l->def.space); }
static const ethd_law *law_of_space(const ethd_loop *l) ETHD_RT { return ethd_space_law(l->def.space); }

/* ---- [main] ---- */

static double period_of_space(const ethd_loop_def *def) { return ethd_space_period(def->space); }
static void counters_of_space(const ethd_loop *l, ethd_counters *out) { ethd_space_counters(l->def.space, out); }
static void restart_space(ethd_loop *l) { ethd_space_restart(l->def.space); }
static void start_space(ethd_loop *l) { l->near.altered = false; }
static bool space_has_fault(const ethd_loop *l) { return l->row.space.trace.fault != 0; }

const ethd__loop_front ethd__loop_space = {.row = sizeof(ethd_space_row),
                                           .tail = offsetof(ethd_space_row, share),
                                           .read = read_effector,
                                           .blind = blind_effector,
                                           .remember = remember_effector,
                                           .look = look_around,
                                           .rehearse = rehearse_space,
                                           .step = step_space,
                                           .is_safe = is_safe_space,
                                           .write = write_space,
                                           .acknowledge = acknowledge_space,
                                           .law = law_of_space,
                                           .period = period_of_space,
                                           .counters = counters_of_space,
                                           .restart = restart_space,
                                           .start = start_space,
                                           .has_fault = space_has_fault};
