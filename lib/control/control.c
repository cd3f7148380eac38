#include <string.h>

#include "control/controller.h"

static const ethd_status status_of[ETHD_FAULT_COUNT] = {
    [ETHD_FAULT_NONE] = ETHD_OK,           [ETHD_FAULT_INPUT] = ETHD_E_NOT_FINITE,
    [ETHD_FAULT_LAW] = ETHD_E_LAW,         [ETHD_FAULT_FINITE] = ETHD_E_NOT_FINITE,
    [ETHD_FAULT_BUDGET] = ETHD_E_BUDGET,   [ETHD_FAULT_SPEED] = ETHD_E_RANGE,
    [ETHD_FAULT_WORKSPACE] = ETHD_E_RANGE,
};

static void push(ethd_control *control, int64_t tick, ethd_event_kind kind, int32_t code, double value,
                 const ethd_scene *scene) ETHD_RT {
  ethd_event event = {kind, code, tick, value, scene};
  if (!ethd__events_push(&control->events, &event)) control->state.counters.events_dropped++;
}

/* A posted setup is taken only while its event has room: a replaced scene is never lost. */
static const ethd__plan *take_posted(ethd_control *control) ETHD_RT {
  if (!atomic_load_explicit(&control->posted, memory_order_acquire)) return NULL;
  if (ethd__events_room(&control->events) < ETHD__PLACES) return NULL;
  const ethd__plan *from = &control->plans[control->ruling];
  control->ruling = 1 - control->ruling;
  control->state.counters.swaps++;
  return from;
}

/* The scene of a place of the replaced setup, if nothing uses it any more; a scene in two places is
   handed back once. */
static const ethd_scene *released(const ethd_setup *from, const ethd_setup *now, int place) ETHD_RT {
  const ethd_scene *scene = ethd__place_scene(from, place);
  for (int i = 0; i < ETHD__PLACES; i++)
    if (scene == ethd__place_scene(now, i) || (i < place && scene == ethd__place_scene(from, i))) return NULL;
  return scene;
}

/* [main] may free the old scenes and post again only when this tick is through with both. */
static void give_back(ethd_control *control, int64_t tick, const ethd__plan *from) ETHD_RT {
  const ethd_setup *now = &control->plans[control->ruling].setup;
  push(control, tick, ETHD_EVENT_TAKEN, 0, 0, released(&from->setup, now, 0));
  for (int place = 1; place < ETHD__PLACES; place++) {
    const ethd_scene *scene = released(&from->setup, now, place);
    if (scene) push(control, tick, ETHD_EVENT_RELEASED, place, 0, scene);
  }
  atomic_store_explicit(&control->posted, 0, memory_order_release);
}

/* Periods add up to the clean time only within rounding. */
static int clean_enough(const ethd_control *control) ETHD_RT {
  double clean_time = control->plans[control->ruling].setup.limits.clean_time;
  return ethd_control_clean(control) >= clean_time * (1 - 1e-9);
}

static int take_clear(ethd_control *control) ETHD_RT {
  if (!atomic_load_explicit(&control->clear, memory_order_relaxed)) return 0;
  atomic_store_explicit(&control->clear, 0, memory_order_relaxed);
  if (!control->state.fault || !clean_enough(control)) return 0;
  ethd__resume(&control->plans[control->ruling], &control->state);
  push(control, (int64_t)control->state.counters.ticks, ETHD_EVENT_CLEARED, 0, 0, NULL);
  return 1;
}

/* Clamps are frequent: an event when they last. */
#define TOLD_WHEN_GRAVE (ETHD_FAULT_BIT(ETHD_FAULT_TORQUE) | ETHD_FAULT_BIT(ETHD_FAULT_TORQUE_RATE))

static void report(ethd_control *control, int64_t tick, const ethd__failure *failure) ETHD_RT {
  ethd__state *s = &control->state;
  const ethd__plan *plan = &control->plans[control->ruling];
  int same = s->met.faults == s->before.faults && s->met.grave == s->before.grave;
  if (same && (plan->setup.limits.latch || !ethd__rows_any(&s->met))) return;
  ethd__rows begun = ethd__rows_begun(plan, s);
  for (int64_t left = begun.faults | begun.grave; left; left &= left - 1) {
    int32_t row = __builtin_ctzll((uint64_t)left);
    int64_t bit = left & -left;
    double value = (s->met.grave & bit) != 0;
    if (row == (int32_t)failure->fault) value = failure->value;
    if (begun.faults & bit) s->counters.faults[row]++;
    if (begun.grave & bit || !(bit & TOLD_WHEN_GRAVE)) push(control, tick, ETHD_EVENT_FAULT, row, value, NULL);
  }
  s->before = s->met;
}

static ethd_status finish(const ethd_trace *out, ethd_command *command) ETHD_RT {
  command->torque[0] = out->tau[0];
  command->torque[1] = out->tau[1];
  /* not while the guard still damps the ring: a device takes safe for zero torque */
  command->safe = out->fault != ETHD_FAULT_NONE && out->tau[0] == 0 && out->tau[1] == 0;
  command->reserved = 0;
  return out->fault && !status_of[out->fault] ? ETHD_E_DEVICE : status_of[out->fault];
}

ethd_status ethd_control_step(ethd_control *control, const ethd_sense *sense, ethd_command *command,
                              ethd_trace *trace) {
  ethd_trace own, *out = trace ? trace : &own;
  int soft = take_clear(control);
  const ethd__plan *from = take_posted(control);
  ethd__entry e = {&control->plans[control->ruling], from, soft};
  ethd__failure failure = ethd__tick(&e, &control->state, &control->scratch, sense, out);
  if (from) give_back(control, out->tick, from);
  report(control, out->tick, &failure);
  return finish(out, command);
}

ethd_status ethd_control_rehearse(ethd_control *control, const ethd_sense *sense, ethd_command *command) {
  ethd_trace out;
  memcpy(&control->scratch, &control->state, sizeof control->scratch);
  ethd__entry e = {&control->plans[control->ruling], NULL, 0};
  (void)ethd__tick(&e, &control->scratch, NULL, sense, &out);
  return finish(&out, command);
}

void ethd_control_reset(ethd_control *control) {
  const ethd__plan *plan = &control->plans[control->ruling];
  memset(&control->state, 0, sizeof control->state);
  control->state.finger_radius = (double)NAN;
  control->state.places[0].there = 1;
  ethd__resume(plan, &control->state);
}

void ethd_control_restart(ethd_control *control) {
  double heat[2];
  ethd_control_heat(control, heat);
  ethd_control_reset(control);
  ethd_control_heated(control, heat);
}

void ethd_control_heat(const ethd_control *control, double out[2]) {
  memcpy(out, control->state.guard.heat, sizeof control->state.guard.heat);
}

void ethd_control_heated(ethd_control *control, const double heat[2]) {
  memcpy(control->state.guard.heat, heat, sizeof control->state.guard.heat);
}

void ethd_control_clear(ethd_control *control) { atomic_store_explicit(&control->clear, 1, memory_order_relaxed); }

double ethd_control_clean(const ethd_control *control) {
  if (!__atomic_load_n(&control->state.fault, __ATOMIC_RELAXED)) return (double)INFINITY;
  return (double)__atomic_load_n(&control->state.clean, __ATOMIC_RELAXED) * control->period;
}

void ethd_control_counters(const ethd_control *control, ethd_counters *out) {
  *out = control->state.counters;
  memcpy(out->guard, control->state.guard.counts, sizeof out->guard);
}
