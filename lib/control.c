#include <string.h>

#include "controller.h"

static const ethd_status status_of[ETHD_FAULT_COUNT] = {
    [ETHD_FAULT_NONE] = ETHD_OK,          [ETHD_FAULT_INPUT] = ETHD_E_NOT_FINITE,
    [ETHD_FAULT_LAW] = ETHD_E_LAW,        [ETHD_FAULT_FINITE] = ETHD_E_NOT_FINITE,
    [ETHD_FAULT_BUDGET] = ETHD_E_BUDGET,  [ETHD_FAULT_SPEED] = ETHD_E_RANGE,
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

static int take_clear(ethd_control *control) ETHD_RT {
  if (!atomic_load_explicit(&control->clear, memory_order_relaxed)) return 0;
  atomic_store_explicit(&control->clear, 0, memory_order_relaxed);
  if (!control->state.fault) return 0;
  ethd__resume(&control->plans[control->ruling], &control->state);
  push(control, (int64_t)control->state.counters.ticks, ETHD_EVENT_CLEARED, 0, 0, NULL);
  return 1;
}

static void report(ethd_control *control, int64_t tick, const ethd__failure *failure) ETHD_RT {
  ethd__state *s = &control->state;
  if (failure->fault == ETHD_FAULT_NONE || s->fault) return;
  s->counters.faults[failure->fault]++;
  push(control, tick, ETHD_EVENT_FAULT, (int32_t)failure->fault, failure->value, NULL);
  if (control->plans[control->ruling].setup.limits.latch) s->fault = failure->fault;
}

static ethd_status finish(const ethd__failure *failure, const ethd_trace *out,
                          ethd_command *command) ETHD_RT {
  command->torque[0] = out->tau[0];
  command->torque[1] = out->tau[1];
  /* not while the guard still damps the ring: a device takes safe for zero torque */
  command->safe = failure->fault != ETHD_FAULT_NONE && out->tau[0] == 0 && out->tau[1] == 0;
  command->reserved = 0;
  return status_of[failure->fault];
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
  return finish(&failure, out, command);
}

ethd_status ethd_control_rehearse(ethd_control *control, const ethd_sense *sense,
                                  ethd_command *command) {
  ethd_trace out;
  memcpy(&control->scratch, &control->state, sizeof control->scratch);
  ethd__entry e = {&control->plans[control->ruling], NULL, 0};
  ethd__failure failure = ethd__tick(&e, &control->scratch, NULL, sense, &out);
  return finish(&failure, &out, command);
}

void ethd_control_reset(ethd_control *control) {
  const ethd__plan *plan = &control->plans[control->ruling];
  memset(&control->state, 0, sizeof control->state);
  control->state.finger_radius = (double)NAN;
  control->state.places[0].there = 1;
  ethd__resume(plan, &control->state);
}

void ethd_control_clear(ethd_control *control) {
  atomic_store_explicit(&control->clear, 1, memory_order_relaxed);
}

void ethd_control_counters(const ethd_control *control, ethd_counters *out) {
  *out = control->state.counters;
  memcpy(out->guard, control->state.guard.counts, sizeof out->guard);
}
