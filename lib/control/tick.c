/* One tick: from what the device measured to the torque that it is told.

   1. What is already wrong is noted as rows of the fault table: numbers that can't be, clock, joints, heat, the step
      budget, and what device and loop saw.
   2. Moving bodies take their new poses.
   3. The laws work the torque out (evaluate.c). A tick that may not push, for a row forbids it or a fault is latched,
      only estimates, so that the trace is right and a later tick goes on from where things are. A tick without
      measurement does nothing.
   4. At a swap the old plan's torque is the tick's, and the difference to the new plan's fades (swap.c).
      After an acknowledged fault the torque starts from zero in the same way.
   5. The guard has the last word: it bounds the torque, damps a stop, or lets the ring go.
   6. The rows that were met say what latches, and the trace how the tick ended (rows.c). */
#include "control/tick.h"

#include "control/estimate.h"
#include "control/evaluate.h"
#include "control/fence.h"
#include "control/places.h"
#include "control/rows.h"
#include "control/swap.h"

#define GAP_MAX 1000000 /* periods: a longer gap is no longer a gap of a loop */

static int64_t at_most(int64_t periods) ETHD_RT { return periods < GAP_MAX ? periods : GAP_MAX; }

/* ---- what is already wrong ---- */

/* NaN fails. */
static bool within(const double v[2], double most) ETHD_RT { return fabs(v[0]) <= most && fabs(v[1]) <= most; }

static bool pose_is_possible(const double pose[6]) ETHD_RT {
  return within(pose, ETHD_SENSE_LENGTH_MAX) && fabs(pose[2]) <= ETHD_SENSE_ANGLE_MAX &&
         within(pose + 3, ETHD_SENSE_SPEED_MAX) && fabs(pose[5]) <= ETHD_SENSE_SPEED_MAX;
}

static bool bodies_are_possible(const ethd_sense *s) ETHD_RT {
  for (int i = 0; i < ETHD_BODIES_MAX; i++)
    if ((s->have & ((int64_t)ETHD_HAVE_BODY << i)) && !pose_is_possible(s->bodies + 6 * i)) return false;
  return true;
}

/* True: every number that will be used is possible. Else the ETHD_HAVE_* bit of what isn't, 0 for q. */
static bool input_is_possible(const ethd_sense *s, double *which) ETHD_RT {
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
  return !(s->have & ETHD__HAVE_BODIES) || bodies_are_possible(s);
}

/* No two steps are further apart than the limit, on either clock. A bus's first sample may be from before the loop
   ran: its age says nothing about the clock. */
static bool clock_is_good(const ethd__tick *t) ETHD_RT {
  const double most = t->plan->setup.limits.gap, expected = (double)t->periods * t->plan->setup.period;
  if (isinf(most)) return true;
  double passed = 1e-9 * (double)(int64_t)((uint64_t)t->sense->time_ns - (uint64_t)t->state->time_ns);
  return expected <= most && (t->state->counters.ticks < 2 || fabs(passed - expected) <= most);
}

static bool joints_are_good(const double joints[4], const double q[2]) ETHD_RT {
  return q[0] >= joints[0] && q[0] <= joints[1] && q[1] >= joints[2] && q[1] <= joints[3];
}

static bool reach_is_good(const double reach[2], ethd_vec x) ETHD_RT {
  double r = ethd_vec_norm(x);
  return r >= reach[0] && r <= reach[1];
}

#define HOT 1.05 /* times the heat that a motor stands for ever */

/* Limits that most setups don't have. */
static void note_rare_limits(ethd__tick *t) ETHD_RT {
  const ethd_limits *limits = &t->plan->setup.limits;
  if (!clock_is_good(t)) ethd__note_grave(t->state, ETHD_FAULT_CLOCK);
  if (!joints_are_good(limits->joints, t->sense->q)) ethd__note_grave(t->state, ETHD_FAULT_WORKSPACE);
  if (limits->nominal_torque < (double)INFINITY &&
      !(ethd_guard_heat(limits, &t->state->guard, (double)t->periods * t->plan->setup.period) <= HOT))
    ethd__note_grave(t->state, ETHD_FAULT_HEAT);
  t->state->time_ns = t->sense->time_ns;
}

/* Returns whether the tick has a measurement. */
static bool note_what_is_wrong(ethd__tick *t) ETHD_RT {
  double which;
  ethd__rows_begin(t->state, t->sense);
  bool possible = input_is_possible(t->sense, &which);
  if (!possible) ethd__note_value(t->state, ETHD_FAULT_INPUT, which);
  if (t->plan->has_rare_limits) note_rare_limits(t);
  if (possible && !t->state->fault && !(1e-9 * (double)t->sense->step_ns <= t->plan->setup.limits.step_time))
    ethd__note_value(t->state, ETHD_FAULT_BUDGET, (double)t->sense->step_ns);
  return possible;
}

/* ---- the torque of the laws ---- */

static void start_from_zero(ethd__tick *t) ETHD_RT {
  const double zero[2] = {0, 0};
  ethd__fade_start(t->state, zero, t->trace->tau_raw);
  memset(t->trace->tau_raw, 0, sizeof t->trace->tau_raw);
}

/* trace->tau_raw; a tick whose law fails leaves it undefined and a row that forbids it. */
static void work_out_torque(ethd__tick *t) ETHD_RT {
  if (ethd__rows_forbid(t->state)) {
    if (t->from) ethd__swap_state(t->from, t->plan, t->state, NULL);
    ethd__estimate(t);
  } else if (t->from && !t->soft) {
    ethd__swap(t);
  } else {
    if (t->from) ethd__swap_state(t->from, t->plan, t->state, NULL);
    if (!ethd__evaluate(t)) return;
    ethd__fade(t);
    if (t->soft) start_from_zero(t);
  }
}

/* ---- the guard ---- */

/* A row that forbids the torque takes it away at once, not at the rate's pace. */
static void guard(ethd__tick *t) ETHD_RT {
  ethd__state *state = t->state;
  const ethd_limits *limits = &t->plan->setup.limits;
  if (t->plan->has_rare_limits && !reach_is_good(limits->reach, t->pose.x))
    ethd__note_grave(state, ETHD_FAULT_WORKSPACE);
  if (ethd__rows_any(&state->met.rows)) ethd__rows_stop(state);
  memcpy(t->trace->tau, t->trace->tau_raw, sizeof t->trace->tau);
  t->trace->guard = ethd_guard_step(limits, &state->guard, &t->pose, t->ring.v, t->dt, t->trace->tau);
  if (t->trace->guard & ETHD_GUARD_SPEED) ethd__note_value(state, ETHD_FAULT_SPEED, ethd_vec_norm(t->ring.v));
}

/* ---- the whole tick ---- */

static void begin_trace(const ethd_sense *sense, ethd_trace *out) ETHD_RT {
  const size_t own = offsetof(ethd_trace, tick);
  out->sense = *sense;
  memset((char *)out + own, 0, sizeof *out - own);
  out->object = -1;
  out->beta = 1;
  out->rf = out->d_re = out->d_fe = out->v_n = (double)NAN;
}

static void take_torque_away(ethd__tick *t) ETHD_RT {
  memset(t->trace->tau_raw, 0, sizeof t->trace->tau_raw);
  memset(t->state->guard.last, 0, sizeof t->state->guard.last);
}

void ethd__tick_run(ethd__tick *t) {
  ethd__state *state = t->state;
  t->periods = at_most(t->sense->missed > 0 ? at_most(t->sense->missed) + 1 : 1);
  int64_t gap = at_most(state->blind + t->periods);
  t->dt = (double)gap * t->plan->setup.period;
  bool measured = note_what_is_wrong(t);
  state->blind = measured ? 0 : gap;
  begin_trace(t->sense, t->trace);
  t->trace->swap = t->from != NULL;
  if (measured) {
    ethd__places_take(state, t->sense);
    work_out_torque(t);
  } else if (t->from) {
    ethd__swap_state(t->from, t->plan, state, NULL);
  }
  if (ethd__rows_forbid(state)) take_torque_away(t);
  if (measured) guard(t);
  if (t->trace->guard || state->fault || ethd__rows_any(&state->met.rows))
    t->trace->fault = ethd__judge(t->plan, state, t->trace->guard, t->periods);
  t->trace->tick = (int64_t)state->counters.ticks++;
}

/* After an acknowledged fault contacts begin anew. */
void ethd__resume(const ethd__plan *plan, ethd__state *state) {
  __atomic_store_n(&state->fault, ETHD_FAULT_NONE, __ATOMIC_RELAXED);
  state->before = (ethd__rows){0, 0}; /* what lasts is a new occurrence */
  state->guard.stopping = state->guard.stopped = 0;
  state->fade.elapsed = (double)INFINITY;
  for (int i = 0; i < ETHD_CONTACTS_MAX; i++) state->slots[i].used = false;
  ethd__block_reset(plan, &plan->setup.tracking->law, plan->setup.tracking_p, &state->tracking);
}
