/* One tick in space, in the order of control/tick.c: present faults, the finger, the contacts, tracking, the laws'
   request, the guard, and the reactions to the noted rows. If the measurement is impossible, the command is zero. */
#include "core/clock.h"
#include "core/rows.h"
#include "core/swap.h"
#include "space/state.h"

#define GAP_MAX 1000000 /* periods: a longer gap counts as this one */
#define UNIT 2e-6       /* of |n|^2: 1e-6 of the length */

static int64_t at_most(int64_t periods) { return periods < GAP_MAX ? periods : GAP_MAX; }

/* ---- present faults ---- */

/* Returns false for NaN too. */
static bool within(const double v[3], double most) {
  return fabs(v[0]) <= most && fabs(v[1]) <= most && fabs(v[2]) <= most;
}

static bool is_unit(ethd_vec3 n) { return fabs(ethd_vec3_dot(n, n) - 1) <= UNIT; }

static bool surfaces_are_possible(const ethd__space_tick *t) {
  if (t->count > ETHD_SURFACES_MAX || (t->count && !t->surfaces)) return false;
  for (uint32_t i = 0; i < t->count; i++) {
    const ethd_surface *s = &t->surfaces[i];
    if (!(fabs(s->point.x) <= ETHD_SENSE_LENGTH_MAX && fabs(s->point.y) <= ETHD_SENSE_LENGTH_MAX &&
          fabs(s->point.z) <= ETHD_SENSE_LENGTH_MAX && fabs(s->v.x) <= ETHD_SENSE_SPEED_MAX &&
          fabs(s->v.y) <= ETHD_SENSE_SPEED_MAX && fabs(s->v.z) <= ETHD_SENSE_SPEED_MAX && is_unit(s->n)))
      return false;
    if (s->material >= (int32_t)t->plan->setup.materials || s->material < -1) return false;
  }
  return true;
}

/* As input_is_possible in control/tick.c. */
static bool input_is_possible(const ethd__space_tick *t, double *which) {
  const ethd_space_sense *s = t->sense;
  *which = 0;
  if (!within(s->x, ETHD_SENSE_LENGTH_MAX) || !within(s->v, ETHD_SENSE_SPEED_MAX)) return false;
  *which = ETHD_SPACE_HAVE_FINGER;
  if (s->have & ETHD_SPACE_HAVE_FINGER &&
      (!within(s->finger, ETHD_SENSE_LENGTH_MAX) || !within(s->finger_v, ETHD_SENSE_SPEED_MAX)))
    return false;
  *which = ETHD_SPACE_HAVE_NORMAL;
  if (s->have & ETHD_SPACE_HAVE_NORMAL && !is_unit(ethd_vec3_of(s->normal))) return false;
  *which = ETHD_SPACE_HAVE_COMMANDED;
  if (s->have & ETHD_SPACE_HAVE_COMMANDED && !within(s->commanded, ETHD_SENSE_FORCE_MAX)) return false;
  *which = ETHD_SPACE_SURFACES;
  return surfaces_are_possible(t);
}

static bool note_what_is_wrong(ethd__space_tick *t) {
  ethd__core *core = &t->state->core;
  double which;
  ethd__rows_begin(core, t->sense->faults, t->sense->grave);
  const bool possible = input_is_possible(t, &which);
  if (!possible) ethd__note_value(core, ETHD_FAULT_INPUT, which);
  if (!possible && which == ETHD_SPACE_SURFACES) t->trace->near = ETHD_NEAR_REFUSED;
  if (possible && t->sense->have & ETHD_SPACE_HAVE_COMMANDED) t->state->last = ethd_vec3_of(t->sense->commanded);
  ethd__clock_check(core, t->sense->time_ns, t->periods, t->plan->setup.period, t->plan->setup.gap);
  if (possible && !core->fault && !(1e-9 * (double)t->sense->step_ns <= t->plan->setup.step_time))
    ethd__note_value(core, ETHD_FAULT_BUDGET, (double)t->sense->step_ns);
  return possible;
}

/* ---- the laws' request ---- */

/* Gives X and its velocity; for a plate X is the desired position of the finger. */
static void place(ethd__space_tick *t) {
  const ethd_space_sense *s = t->sense;
  t->core.x = ethd_vec3_of(s->x);
  t->core.v = ethd_vec3_of(s->v);
  t->ability = t->plan->setup.ability;
  if (s->have & ETHD_SPACE_HAVE_ABILITY)
    t->ability =
        (ethd_ability){s->ability[0], s->ability[1], s->ability[2], s->ability[3], s->ability[4], s->ability[5]};
  if (t->plan->setup.effector != ETHD_EFFECTOR_PLATE) return;
  const ethd_vec3 n = s->have & ETHD_SPACE_HAVE_NORMAL ? ethd_vec3_of(s->normal) : t->state->facing;
  t->core.x = ethd_vec3_sub(t->core.x, ethd_vec3_scale(t->plan->setup.radius, n));
}

static bool follow(ethd__space_tick *t, ethd_vec3 *out) {
  const ethd__core_plan *plan = &t->plan->core;
  const ethd_follow_in in = {
      .eps_x = ethd_vec3_sub(ethd_vec3_add(t->core.finger, t->core.touched.lead), t->core.x),
      .eps_v = ethd_vec3_sub(t->core.finger_v, t->core.v),
      .finger_v = t->core.finger_v,
      .period = t->core.dt,
  };
  *out = (ethd_vec3){0, 0, 0};
  const ethd_status status = plan->follow(plan->tracking_p, t->state->core.tracking.at, &in, out);
  const bool finite = isfinite(out->x) && isfinite(out->y) && isfinite(out->z);
  return ethd__law_is_good(&t->state->core, ETHD_TRACKING, status, finite);
}

static void show(const ethd__space_tick *t, ethd_space_trace *out) {
  const ethd__touched *touched = &t->core.touched;
  out->contacts = touched->contacts;
  out->overflow += touched->overflow;
  out->object = touched->object;
  out->state = touched->state;
  out->eps = touched->eps;
  out->d_re = touched->d_re;
  out->d_fe = touched->d_fe;
  out->v_n = touched->v_n;
  out->beta = touched->beta * (1 - t->state->absent);
  out->speed = touched->bounds ? touched->bound[0].speed : (double)INFINITY;
  ethd_vec3_put(touched->fe, out->fe);
  ethd_vec3_put(touched->fd, out->fd);
}

static void prepare(ethd__space_tick *t) {
  t->core.plan = &t->plan->core;
  t->core.state = &t->state->core;
  t->core.keeps = t->state == t->scratch;
  t->core.touched.bounds = 0;
  place(t);
  ethd__space_finger(t);
  ethd_vec3_put(t->core.finger, t->trace->xf);
  ethd_vec3_put(t->core.finger_v, t->trace->vf);
}

/* Sets trace->asked. False: a law failed, which is noted. */
static bool evaluate(ethd__space_tick *t) {
  ethd_space_trace *out = t->trace;
  ethd_vec3 tracking;
  prepare(t);
  if (!ethd__space_touch(t)) return false;
  show(t, out);
  if (!follow(t, &tracking)) return false;
  const ethd_vec3 forces = ethd_vec3_add(t->core.touched.fe, t->core.touched.fd);
  const double scale = t->plan->core.by_velocity ? 1 / t->plan->setup.damping : 1;
  ethd_vec3_put(ethd_vec3_add(ethd_vec3_scale(out->beta, tracking), ethd_vec3_scale(scale, forces)), out->asked);
  return true;
}

/* ---- the tick of a swap ---- */

static void swap_state(const ethd__space_tick *t, const ethd__space_state *old) {
  const ethd__space_plan *from = t->from, *to = t->plan;
  ethd_vec3 x, v;
  if (t->state->filter.started &&
      (from->filter.method != to->filter.method || memcmp(from->filter.p, to->filter.p, sizeof from->filter.p) != 0)) {
    ethd_filter_output3(&from->filter, &t->state->filter, &x, &v);
    ethd_filter_start3(&to->filter, &t->state->filter, x, v);
  }
  ethd__core_swap(&from->core, &to->core, &t->state->core, old ? &old->core : NULL, 0);
}

/* Computes the old plan's command on a copy of the state, and continues with the new plan. */
static void swap(ethd__space_tick *t, double old[3]) {
  memcpy(t->scratch, t->state, sizeof *t->scratch);
  ethd__space_tick before = *t;
  before.plan = t->from;
  before.state = t->scratch;
  const bool held = evaluate(&before);
  if (held) ethd__space_limit(&before);
  t->range = before.range; /* the trace shows the surfaces of both plans */
  memcpy(old, t->trace->command, sizeof t->trace->command);
  swap_state(t, held ? t->scratch : NULL);
  if (!held) {
    t->state->core.met = t->scratch->core.met; /* the row of the law that failed */
    prepare(t);
  } else if (evaluate(t)) {
    t->old = old;
  }
}

static void work_out(ethd__space_tick *t, double old[3]) {
  if (!ethd__rows_forbid(&t->state->core) && t->from && !t->core.soft) {
    swap(t, old);
    return;
  }
  if (t->from) swap_state(t, NULL);
  if (ethd__rows_forbid(&t->state->core))
    prepare(t);
  else
    (void)evaluate(t);
}

/* ---- the whole tick ---- */

static void begin_trace(const ethd_space_sense *sense, ethd_space_trace *out) {
  const size_t own = offsetof(ethd_space_trace, tick);
  out->sense = *sense;
  memset((char *)out + own, 0, sizeof *out - own);
  out->object = -1;
  out->beta = 1;
  out->speed = (double)INFINITY;
  out->d_re = out->d_fe = out->v_n = (double)NAN;
}

static void guard(ethd__space_tick *t, ethd__halt halt) {
  ethd__core *core = &t->state->core;
  if (ethd__rows_any(&core->met.rows)) ethd__rows_stop(core, halt);
  ethd__space_limit(t);
  if (t->trace->guard & ETHD_GUARD_SPEED)
    ethd__note_value(core, ETHD_FAULT_SPEED, ethd_vec3_norm(ethd_vec3_of(t->sense->v)));
}

/* A velocity command is cut and bounded at every approach, so this isn't noted. */
static void judge(ethd__space_tick *t, ethd__halt halt) {
  ethd__core *core = &t->state->core;
  const int64_t common = t->plan->core.by_velocity ? ETHD_GUARD_TORQUE | ETHD_GUARD_RATE : 0;
  const int64_t bits = t->trace->guard & ~common;
  for (int64_t left = t->trace->guard; left; left &= left - 1) core->counters.guard[__builtin_ctzll((uint64_t)left)]++;
  if (!bits && !core->fault && !ethd__rows_any(&core->met.rows)) return;
  if (bits) ethd__note_guard(core, bits, t->state->cut);
  t->trace->fault = ethd__judge(core, t->plan->core.latches, halt, t->periods);
}

void ethd__space_tick_run(ethd__space_tick *t) {
  ethd__space_state *state = t->state;
  const ethd__halt halt = {&state->stopping, &state->stopped};
  double old[3];
  t->old = NULL;
  t->range = 0;
  t->periods = at_most(t->sense->missed > 0 ? at_most(t->sense->missed) + 1 : 1);
  const int64_t gap = at_most(state->blind + t->periods);
  t->core.dt = (double)gap * t->plan->setup.period;
  begin_trace(t->sense, t->trace);
  const bool measured = note_what_is_wrong(t);
  state->blind = measured ? 0 : gap;
  t->trace->swap = t->from != NULL;
  if (measured)
    work_out(t, old);
  else if (t->from)
    swap_state(t, NULL);
  if (ethd__rows_forbid(&state->core)) memset(t->trace->asked, 0, sizeof t->trace->asked);
  if (measured)
    guard(t, halt);
  else
    state->last = (ethd_vec3){0, 0, 0}; /* zero was commanded */
  judge(t, halt);
  if (t->plan->core.range) memcpy(t->trace->learnt, state->core.memory, sizeof state->core.memory);
  t->trace->tick = (int64_t)state->core.counters.ticks++;
}
