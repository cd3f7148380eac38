#include <string.h>

#include "control/controller.h"
#include "control/fence.h"
#include "control/rows.h"
#include "control/tick.h"
#include "fp_mode.h"

static void push(ethd_control *control, const ethd_event *event) {
  if (!ethd__events_push(&control->events, event)) control->state.counters.events_dropped++;
}

/* Takes a posted setup, but only while there is room for its events, so that no replaced scene is lost. Returns the old
   plan, NULL if nothing was taken. */
static const ethd__plan *take_posted(ethd_control *control) {
  if (!atomic_load_explicit(&control->posted, memory_order_acquire)) return NULL;
  if (ethd__events_room(&control->events) < ETHD__PLACES) return NULL;
  const ethd__plan *from = &control->plans[control->ruling];
  control->ruling = 1 - control->ruling;
  control->state.counters.swaps++;
  return from;
}

/* Returns the replaced setup's scene in this place if nothing uses it any more; one that was in two places is returned
   for the first only. */
static const ethd_scene *released(const ethd_setup *from, const ethd_setup *now, int place) {
  const ethd_scene *scene = ethd__place_scene(from, place);
  for (int i = 0; i < ETHD__PLACES; i++)
    if (scene == ethd__place_scene(now, i) || (i < place && scene == ethd__place_scene(from, i))) return NULL;
  return scene;
}

/* Hands the old scenes back and lets [main] post again, at the end of the tick, which needs both plans till then. */
static void give_back(ethd_control *control, int64_t tick, const ethd__plan *from) {
  const ethd_setup *now = &control->plans[control->ruling].setup;
  push(control, &(ethd_event){.kind = ETHD_EVENT_TAKEN, .tick = tick, .scene = released(&from->setup, now, 0)});
  for (int place = 1; place < ETHD__PLACES; place++) {
    const ethd_scene *scene = released(&from->setup, now, place);
    if (scene) push(control, &(ethd_event){.kind = ETHD_EVENT_RELEASED, .code = place, .tick = tick, .scene = scene});
  }
  atomic_store_explicit(&control->posted, 0, memory_order_release);
}

/* The tolerance is for the rounding of a sum of periods. */
static bool clean_enough(const ethd_control *control) {
  double clean_time = control->plans[control->ruling].setup.limits.clean_time;
  return ethd_control_clean_time(control) >= clean_time * (1 - 1e-9);
}

static bool take_clear(ethd_control *control) {
  if (!atomic_load_explicit(&control->clear, memory_order_relaxed)) return false;
  atomic_store_explicit(&control->clear, 0, memory_order_relaxed);
  if (!control->state.fault || !clean_enough(control)) return false;
  ethd__resume(&control->plans[control->ruling], &control->state);
  push(control, &(ethd_event){.kind = ETHD_EVENT_CLEARED, .tick = (int64_t)control->state.counters.ticks});
  return true;
}

/* Clamps are frequent, so they make an event only when they last. */
#define TOLD_WHEN_GRAVE (ETHD_FAULT_BIT(ETHD_FAULT_TORQUE) | ETHD_FAULT_BIT(ETHD_FAULT_TORQUE_RATE))

/* Counts the occurrences that begin at this tick and makes their events. */
static void report(ethd_control *control, int64_t tick) {
  ethd__state *s = &control->state;
  const ethd__plan *plan = &control->plans[control->ruling];
  const ethd__fault_rows *met = &s->met.rows;
  bool same = met->faults == s->before.faults && met->grave == s->before.grave;
  if (same && (plan->setup.limits.latch || !ethd__rows_any(met))) return;
  ethd__fault_rows begun = ethd__rows_begun(plan, s);
  for (int64_t left = begun.faults | begun.grave; left; left &= left - 1) {
    int32_t row = __builtin_ctzll((uint64_t)left);
    int64_t bit = left & -left;
    double value = s->met.valued & bit ? s->met.value[row] : (met->grave & bit) != 0;
    if (begun.faults & bit) s->counters.faults[row]++;
    if (begun.grave & bit || !(bit & TOLD_WHEN_GRAVE))
      push(control, &(ethd_event){.kind = ETHD_EVENT_FAULT, .code = row, .tick = tick, .value = value});
  }
  s->before = *met;
}

static ethd_status finish(const ethd__tick *t, ethd_command *command) {
  const ethd_trace *out = t->trace;
  const ethd_guard_state *guard = &t->state->guard;
  command->torque[0] = out->tau[0];
  command->torque[1] = out->tau[1];
  /* A stop may still brake, also after ticks of zero torque; a device may disable where `safe` is set. */
  const bool stops = guard->stopping && !guard->stopped;
  command->safe = out->fault != ETHD_FAULT_NONE && !stops && out->tau[0] == 0 && out->tau[1] == 0;
  command->reserved = 0;
  return ethd__rows_status((ethd_fault)out->fault);
}

ETHD__FP_APART static ethd_status step(ethd_control *control, const ethd_sense *sense, ethd_command *command,
                                       ethd_trace *trace) {
  ethd_trace own;
  ethd__tick t;
  t.soft = take_clear(control);
  t.from = take_posted(control);
  t.plan = &control->plans[control->ruling];
  t.state = &control->state;
  t.scratch = &control->scratch;
  t.sense = sense;
  t.trace = trace ? trace : &own;
  ethd__tick_run(&t);
  if (t.from) give_back(control, t.trace->tick, t.from);
  report(control, t.trace->tick);
  return finish(&t, command);
}

ETHD__FP_APART static ethd_status step_between_modes(ethd_control *control, const ethd_sense *sense,
                                                     ethd_command *command, ethd_trace *trace) {
  const uint64_t callers = ethd__fp_take();
  const ethd_status status = step(control, sense, command, trace);
  ethd__fp_give(callers);
  return status;
}

ethd_status ethd_control_step(ethd_control *control, const ethd_sense *sense, ethd_command *command,
                              ethd_trace *trace) {
  return ethd__fp_is_own() ? step(control, sense, command, trace) : step_between_modes(control, sense, command, trace);
}

ETHD__FP_APART static ethd_status rehearse(ethd_control *control, const ethd_sense *sense, ethd_command *command) {
  ethd_trace own;
  ethd__tick t;
  memcpy(&control->scratch, &control->state, sizeof control->scratch);
  t.soft = false;
  t.from = NULL;
  t.plan = &control->plans[control->ruling];
  t.state = &control->scratch;
  t.scratch = NULL;
  t.sense = sense;
  t.trace = &own;
  ethd__tick_run(&t);
  return finish(&t, command);
}

ethd_status ethd_control_rehearse(ethd_control *control, const ethd_sense *sense, ethd_command *command) {
  const uint64_t callers = ethd__fp_take();
  const ethd_status status = rehearse(control, sense, command);
  ethd__fp_give(callers);
  return status;
}

double ethd_control_period(const ethd_control *control) { return control->period; }

ETHD__FP_APART static void reset(ethd_control *control) {
  const ethd__plan *plan = &control->plans[control->ruling];
  memset(&control->state, 0, sizeof control->state);
  control->state.finger_radius = (double)NAN;
  control->state.places[0].there = true;
  ethd__resume(plan, &control->state);
}

void ethd_control_reset(ethd_control *control) {
  const uint64_t callers = ethd__fp_take();
  reset(control);
  ethd__fp_give(callers);
}

void ethd_control_restart(ethd_control *control) {
  double heat[2], memory[ETHD_MEMORY];
  ethd_control_heat(control, heat);
  ethd_control_memory(control, memory);
  ethd_control_reset(control);
  ethd_control_set_heat(control, heat);
  ethd_control_set_memory(control, memory);
}

void ethd_control_memory(const ethd_control *control, double out[ETHD_MEMORY]) {
  memcpy(out, control->state.memory, sizeof control->state.memory);
}

void ethd_control_set_memory(ethd_control *control, const double memory[ETHD_MEMORY]) {
  memcpy(control->state.memory, memory, sizeof control->state.memory);
}

void ethd_control_heat(const ethd_control *control, double out[2]) {
  memcpy(out, control->state.guard.heat, sizeof control->state.guard.heat);
}

#define HEAT_UNKNOWN 2.0 /* hot enough for row HEAT */

void ethd_control_set_heat(ethd_control *control, const double heat[2]) {
  for (int i = 0; i < 2; i++) control->state.guard.heat[i] = isfinite(heat[i]) && heat[i] >= 0 ? heat[i] : HEAT_UNKNOWN;
}

void ethd_control_acknowledge(ethd_control *control) {
  atomic_store_explicit(&control->clear, 1, memory_order_relaxed);
}

double ethd_control_clean_time(const ethd_control *control) {
  if (!__atomic_load_n(&control->state.fault, __ATOMIC_RELAXED)) return (double)INFINITY;
  return (double)__atomic_load_n(&control->state.clean, __ATOMIC_RELAXED) * control->period;
}

const ethd_law *ethd_control_law(const ethd_control *control) {
  const ethd_law *law = ethd__fence_runs(&control->state);
  return law ? law : ethd__fence_runs(&control->scratch);
}

void ethd_control_counters(const ethd_control *control, ethd_counters *out) {
  *out = control->state.counters;
  memcpy(out->guard, control->state.guard.counts, sizeof out->guard);
}
