#include <string.h>

#include "control/controller.h"
#include "control/tick.h"
#include "core/fence.h"
#include "core/rows.h"
#include "fp_mode.h"

/* Returns the replaced setup's scene of this place if it is no longer used; a scene of two places is returned only for
   the first. */
static const ethd_scene *released(const ethd_setup *from, const ethd_setup *now, int place) {
  const ethd_scene *scene = ethd__place_scene(from, place);
  for (int i = 0; i < ETHD__PLACES; i++)
    if (scene == ethd__place_scene(now, i) || (i < place && scene == ethd__place_scene(from, i))) return NULL;
  return scene;
}

/* Returns the old scenes and lets [main] post again, at the end of the tick, since the tick needs both plans. */
static void give_back(ethd_control *control, int64_t tick, const ethd__plan *from) {
  const ethd_setup *now = &control->plans[control->mail.ruling].setup;
  ethd__mail *mail = &control->mail;
  ethd__core *core = &control->state.core;
  const ethd_scene *scene = released(&from->setup, now, 0);
  ethd__mail_push(mail, core, &(ethd_event){.kind = ETHD_EVENT_TAKEN, .tick = tick, .scene = scene});
  for (int place = 1; place < ETHD__PLACES; place++) {
    scene = released(&from->setup, now, place);
    const ethd_event event = {.kind = ETHD_EVENT_RELEASED, .code = place, .tick = tick, .scene = scene};
    if (scene) ethd__mail_push(mail, core, &event);
  }
  atomic_store_explicit(&mail->posted, 0, memory_order_release);
}

/* Takes an acknowledgement; returns whether it counts. */
static bool take_clear(ethd_control *control) {
  const ethd__plan *plan = &control->plans[control->mail.ruling];
  if (!ethd__mail_clear(&control->mail, &control->state.core, control->period, plan->setup.limits.clean_time))
    return false;
  ethd__resume(plan, &control->state);
  return true;
}

static ethd_status finish(const ethd__tick *t, ethd_command *command) {
  const ethd_trace *out = t->trace;
  const ethd_guard_state *guard = &t->state->guard;
  command->torque[0] = out->tau[0];
  command->torque[1] = out->tau[1];
  /* A stop may still brake, also after ticks of zero torque; with `safe` set a device may disable. */
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
  const ethd__plan *ruled = &control->plans[control->mail.ruling];
  t.from = ethd__mail_take(&control->mail, &control->state.core, ETHD__PLACES) ? ruled : NULL;
  t.plan = &control->plans[control->mail.ruling];
  t.state = &control->state;
  t.scratch = &control->scratch;
  t.sense = sense;
  t.trace = trace ? trace : &own;
  ethd__tick_run(&t);
  if (t.from) give_back(control, t.trace->tick, t.from);
  ethd__mail_report(&control->mail, &control->state.core, t.plan->core.latches, t.trace->tick);
  return finish(&t, command);
}

ETHD__FP_APART static ethd_status step_between_modes(ethd_control *control, const ethd_sense *sense,
                                                     ethd_command *command, ethd_trace *trace) {
  ETHD__FP_RETURN(ethd_status, step(control, sense, command, trace));
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
  t.plan = &control->plans[control->mail.ruling];
  t.state = &control->scratch;
  t.scratch = NULL;
  t.sense = sense;
  t.trace = &own;
  ethd__tick_run(&t);
  return finish(&t, command);
}

ethd_status ethd_control_rehearse(ethd_control *control, const ethd_sense *sense, ethd_command *command) {
  ETHD__FP_RETURN(ethd_status, rehearse(control, sense, command));
}

double ethd_control_period(const ethd_control *control) { return control->period; }

ETHD__FP_APART static void reset(ethd_control *control) {
  const ethd__plan *plan = &control->plans[control->mail.ruling];
  memset(&control->state, 0, sizeof control->state);
  control->state.finger_radius = (double)NAN;
  control->state.places[0].there = true;
  ethd__resume(plan, &control->state);
}

void ethd_control_reset(ethd_control *control) { ETHD__FP_DO(reset(control)); }

void ethd_control_restart(ethd_control *control) {
  double heat[2], memory[ETHD_MEMORY];
  ethd_control_heat(control, heat);
  ethd_control_memory(control, memory);
  ethd_control_reset(control);
  ethd_control_set_heat(control, heat);
  ethd_control_set_memory(control, memory);
}

void ethd_control_memory(const ethd_control *control, double out[ETHD_MEMORY]) {
  memcpy(out, control->state.core.memory, sizeof control->state.core.memory);
}

void ethd_control_set_memory(ethd_control *control, const double memory[ETHD_MEMORY]) {
  memcpy(control->state.core.memory, memory, sizeof control->state.core.memory);
}

void ethd_control_heat(const ethd_control *control, double out[2]) {
  memcpy(out, control->state.guard.heat, sizeof control->state.guard.heat);
}

#define HEAT_UNKNOWN 2.0 /* hot enough for row HEAT */

void ethd_control_set_heat(ethd_control *control, const double heat[2]) {
  for (int i = 0; i < 2; i++) control->state.guard.heat[i] = isfinite(heat[i]) && heat[i] >= 0 ? heat[i] : HEAT_UNKNOWN;
}

void ethd_control_acknowledge(ethd_control *control) {
  atomic_store_explicit(&control->mail.clear, 1, memory_order_relaxed);
}

double ethd_control_clean_time(const ethd_control *control) {
  return ethd__core_clean_time(&control->state.core, control->period);
}

const ethd_law *ethd_control_law(const ethd_control *control) {
  const ethd_law *law = ethd__fence_runs(&control->state.core);
  return law ? law : ethd__fence_runs(&control->scratch.core);
}

void ethd_control_counters(const ethd_control *control, ethd_counters *out) {
  *out = control->state.core.counters;
  memcpy(out->guard, control->state.guard.counts, sizeof out->guard);
}

ethd_status ethd_control_poll(ethd_control *control, ethd_event *out) { return ethd__mail_poll(&control->mail, out); }
