/* One tick: from the device's measurements to the commanded torque.

   1. Present faults are noted as rows of the fault table: impossible numbers, clock, joints, heat, the step budget, and
      the reports of device and loop.
   2. Moving bodies take their new poses.
   3. The laws compute the torque (evaluate.c). If a noted row forbids a torque, or a fault is latched, the tick only
      estimates, so that the trace is right and a later tick can continue.
   4. At a swap the old plan's torque is computed, too (swap.c).
   5. The guard bounds the torque, stops the ring, or removes the torque. The torque fades from the old plan's to the
      new plan's, and from zero after an acknowledged fault (limit.c).
   6. The noted rows decide what latches, and the trace shows how the tick ended (rows.c).

   When the measurement is impossible there are no steps 2 to 5, and the torque is zero. */
#include "control/tick.h"

#include "control/estimate.h"
#include "control/evaluate.h"
#include "control/limit.h"
#include "control/places.h"
#include "control/swap.h"
#include "core/clock.h"
#include "core/rows.h"
#include "core/swap.h"

#define GAP_MAX 1000000 /* periods: a longer gap counts as this one, so that sums stay small */

static int64_t at_most(int64_t periods) { return periods < GAP_MAX ? periods : GAP_MAX; }

/* ---- present faults ---- */

/* Returns false for NaN too. */
static bool within(const double v[2], double most) { return fabs(v[0]) <= most && fabs(v[1]) <= most; }

static bool pose_is_possible(const ethd__body_pose *pose) {
  return fabs(pose->x.x) <= ETHD_SENSE_LENGTH_MAX && fabs(pose->x.y) <= ETHD_SENSE_LENGTH_MAX &&
         fabs(pose->angle) <= ETHD_SENSE_ANGLE_MAX && fabs(pose->v.x) <= ETHD_SENSE_SPEED_MAX &&
         fabs(pose->v.y) <= ETHD_SENSE_SPEED_MAX && fabs(pose->rate) <= ETHD_SENSE_SPEED_MAX;
}

static bool bodies_are_possible(const ethd_sense *s) {
  for (int i = 0; i < ETHD_BODIES_MAX; i++) {
    if (!(s->have & ((int64_t)ETHD_HAVE_BODY << i))) continue;
    ethd__body_pose pose = ethd__body_pose_of(s, i);
    if (!pose_is_possible(&pose)) return false;
  }
  return true;
}

/* As the next function, for a device's report of its last command and of its samples' ages. Few devices report them. */
static bool report_is_possible(const ethd_sense *s, double *which) {
  *which = ETHD_HAVE_COMMANDED;
  if ((s->have & ETHD_HAVE_COMMANDED) && !within(s->commanded, ETHD_SENSE_FORCE_MAX)) return false;
  *which = ETHD_HAVE_AGE;
  return !(s->have & ETHD_HAVE_AGE) || (within(s->age, ETHD_SENSE_AGE_MAX) && s->age[0] >= 0 && s->age[1] >= 0);
}

/* Returns true if every number that will be used is possible; else *which is the ETHD_HAVE_* bit of the impossible one,
   0 for q. */
static bool input_is_possible(const ethd_sense *s, double *which) {
  *which = 0;
  if (!within(s->q, ETHD_SENSE_ANGLE_MAX)) return false;
  *which = ETHD_HAVE_DQ;
  if ((s->have & ETHD_HAVE_DQ) && !within(s->dq, ETHD_SENSE_SPEED_MAX)) return false;
  *which = ETHD_HAVE_FINGER;
  if ((s->have & (ETHD_HAVE_FINGER | ETHD_HAVE_START)) && !within(s->finger, ETHD_SENSE_LENGTH_MAX)) return false;
  if ((s->have & ETHD_HAVE_FINGER) && !within(s->finger_v, ETHD_SENSE_SPEED_MAX)) return false;
  *which = ETHD_HAVE_RING;
  if ((s->have & ETHD_HAVE_RING) && !within(s->ring, ETHD_SENSE_LENGTH_MAX)) return false;
  *which = ETHD_HAVE_BODY;
  if ((s->have & ETHD__HAVE_BODIES) && !bodies_are_possible(s)) return false;
  return !(s->have & (ETHD_HAVE_COMMANDED | ETHD_HAVE_AGE)) || report_is_possible(s, which);
}

static bool joints_are_good(const double joints[4], const double q[2]) {
  return q[0] >= joints[0] && q[0] <= joints[1] && q[1] >= joints[2] && q[1] <= joints[3];
}

static bool reach_is_good(const double reach[2], ethd_vec x) {
  double r = ethd_vec_norm(x);
  return r >= reach[0] && r <= reach[1];
}

#define HOT 1.05 /* times the final heat under the nominal torque */

/* Notes a motor that is too hot. The torque since the last tick was held under the limits of that tick. */
static void note_heat(ethd__tick *t) {
  const ethd_limits *held = t->from ? &t->from->setup.limits : &t->plan->setup.limits;
  if (held->nominal_torque < (double)INFINITY &&
      !(ethd_guard_heat(held, &t->state->guard, (double)t->periods * t->plan->setup.period) <= HOT))
    ethd__note_grave(&t->state->core, ETHD_FAULT_HEAT);
}

/* Notes the rows of limits that most setups don't have. */
static void note_rare_limits(ethd__tick *t, bool possible) {
  ethd__clock_check(&t->state->core, t->sense->time_ns, t->periods, t->plan->setup.period, t->plan->setup.limits.gap);
  if (possible && !joints_are_good(t->plan->setup.limits.joints, t->sense->q))
    ethd__note_grave(&t->state->core, ETHD_FAULT_WORKSPACE);
  note_heat(t);
}

/* Returns whether the tick has a measurement. */
static bool note_what_is_wrong(ethd__tick *t) {
  double which;
  ethd__rows_begin(&t->state->core, t->sense->faults, t->sense->grave);
  bool possible = input_is_possible(t->sense, &which);
  if (!possible) ethd__note_value(&t->state->core, ETHD_FAULT_INPUT, which);
  if (possible && (t->sense->have & ETHD_HAVE_COMMANDED))
    memcpy(t->state->guard.last, t->sense->commanded, sizeof t->state->guard.last);
  if (t->plan->has_rare_limits || (t->from && t->from->has_rare_limits)) note_rare_limits(t, possible);
  if (possible && !t->state->core.fault && !(1e-9 * (double)t->sense->step_ns <= t->plan->setup.limits.step_time))
    ethd__note_value(&t->state->core, ETHD_FAULT_BUDGET, (double)t->sense->step_ns);
  return possible;
}

/* ---- the torque of the laws ---- */

/* Sets trace->tau_raw. If a law fails, tau_raw stays undefined, but a row is noted that forbids a torque. */
static void work_out_torque(ethd__tick *t, double old[2]) {
  if (ethd__rows_forbid(&t->state->core)) {
    if (t->from) ethd__swap_state(t->from, t->plan, t->state, NULL);
    ethd__estimate(t);
  } else if (t->from && !t->soft) {
    ethd__swap(t, old);
  } else {
    if (t->from) ethd__swap_state(t->from, t->plan, t->state, NULL);
    (void)ethd__evaluate(t);
  }
}

/* ---- the guard ---- */

static ethd__halt halt_of(ethd__state *state) { return (ethd__halt){&state->guard.stopping, &state->guard.stopped}; }

static void guard(ethd__tick *t) {
  ethd__state *state = t->state;
  const ethd_limits *limits = &t->plan->setup.limits;
  if (t->plan->has_rare_limits && !reach_is_good(limits->reach, t->pose.x))
    ethd__note_grave(&state->core, ETHD_FAULT_WORKSPACE);
  if (ethd__rows_any(&state->core.met.rows)) ethd__rows_stop(&state->core, halt_of(state));
  ethd__limit(t);
  if (t->trace->guard & ETHD_GUARD_SPEED) ethd__note_value(&state->core, ETHD_FAULT_SPEED, ethd_vec_norm(t->ring.v));
}

/* ---- the whole tick ---- */

static void begin_trace(const ethd_sense *sense, ethd_trace *out) {
  const size_t own = offsetof(ethd_trace, tick);
  out->sense = *sense;
  memset((char *)out + own, 0, sizeof *out - own);
  out->object = -1;
  out->beta = 1;
  out->rf = out->d_re = out->d_fe = out->v_n = (double)NAN;
}

void ethd__tick_run(ethd__tick *t) {
  ethd__state *state = t->state;
  double old[2];
  t->old = NULL;
  t->periods = at_most(t->sense->missed > 0 ? at_most(t->sense->missed) + 1 : 1);
  int64_t gap = at_most(state->blind + t->periods);
  t->dt = (double)gap * t->plan->setup.period;
  bool measured = note_what_is_wrong(t);
  state->blind = measured ? 0 : gap;
  begin_trace(t->sense, t->trace);
  t->trace->swap = t->from != NULL;
  if (measured) {
    ethd__places_take(state, t->sense);
    work_out_torque(t, old);
  } else if (t->from) {
    ethd__swap_state(t->from, t->plan, state, NULL);
  }
  if (ethd__rows_forbid(&state->core)) memset(t->trace->tau_raw, 0, sizeof t->trace->tau_raw);
  if (measured)
    guard(t);
  else
    memset(state->guard.last, 0, sizeof state->guard.last); /* zero was commanded */
  if (t->trace->guard || state->core.fault || ethd__rows_any(&state->core.met.rows)) {
    if (t->trace->guard) ethd__note_guard(&state->core, t->trace->guard, state->guard.cut);
    t->trace->fault = ethd__judge(&state->core, t->plan->core.latches, halt_of(state), t->periods);
  }
  if (t->plan->core.range) memcpy(t->trace->learnt, state->core.memory, sizeof state->core.memory);
  t->trace->tick = (int64_t)state->core.counters.ticks++;
}

void ethd__resume(const ethd__plan *plan, ethd__state *state) {
  ethd__core_resume(&plan->core, &state->core);
  state->guard.stopping = state->guard.stopped = 0;
  state->guard.stop.begun = 0;
  state->guard.steep = 0;
}
