#include <string.h>

#include "core/fence.h"
#include "core/rows.h"
#include "core/swap.h"
#include "fp_mode.h"
#include "space/state.h"

static void resume(const ethd__space_plan *plan, ethd__space_state *state) {
  ethd__core_resume(&plan->core, &state->core);
  state->stopping = state->stopped = 0;
  state->stop.begun = 0;
}

static bool take_clear(ethd_space *space) {
  const ethd__space_plan *plan = &space->plans[space->mail.ruling];
  if (!ethd__mail_clear(&space->mail, &space->state.core, plan->setup.period, plan->setup.clean_time)) return false;
  resume(plan, &space->state);
  return true;
}

static ethd_status finish(const ethd__space_tick *t, ethd_space_command *command) {
  const ethd_space_trace *out = t->trace;
  const ethd__space_state *state = t->state;
  memcpy(command->value, out->command, sizeof command->value);
  ethd_vec3_put(state->facing, command->normal);
  const bool stops = state->stopping && !state->stopped,
             zero = !out->command[0] && !out->command[1] && !out->command[2];
  command->kind = t->plan->setup.kind;
  command->safe = out->fault != ETHD_FAULT_NONE && !stops && zero;
  return ethd__rows_status((ethd_fault)out->fault);
}

ETHD__FP_APART static ethd_status step(ethd_space *space, ethd__space_tick *t, ethd_space_command *command) {
  t->core.soft = take_clear(space);
  const ethd__space_plan *ruled = &space->plans[space->mail.ruling];
  t->from = ethd__mail_take(&space->mail, &space->state.core, 1) ? ruled : NULL;
  t->plan = &space->plans[space->mail.ruling];
  t->state = &space->state;
  t->scratch = &space->scratch;
  ethd__space_tick_run(t);
  if (t->from) {
    ethd__mail_push(&space->mail, &space->state.core, &(ethd_event){.kind = ETHD_EVENT_TAKEN, .tick = t->trace->tick});
    atomic_store_explicit(&space->mail.posted, 0, memory_order_release);
  }
  ethd__mail_report(&space->mail, &space->state.core, t->plan->core.latches, t->trace->tick);
  return finish(t, command);
}

ethd_status ethd_space_step(ethd_space *space, const ethd_space_sense *sense, const ethd_surface *surfaces,
                            uint32_t count, ethd_space_command *command, ethd_space_trace *trace) {
  ethd_space_trace own;
  ethd__space_tick t;
  t.sense = sense;
  t.surfaces = surfaces;
  t.count = count;
  t.trace = trace ? trace : &own;
  if (ethd__fp_is_own()) return step(space, &t, command);
  ETHD__FP_RETURN(ethd_status, step(space, &t, command));
}

ETHD__FP_APART static ethd_status rehearse(ethd_space *space, ethd__space_tick *t, ethd_space_command *command) {
  memcpy(&space->scratch, &space->state, sizeof space->scratch);
  t->core.soft = false;
  t->from = NULL;
  t->plan = &space->plans[space->mail.ruling];
  t->state = &space->scratch;
  t->scratch = NULL;
  ethd__space_tick_run(t);
  return finish(t, command);
}

ethd_status ethd_space_rehearse(ethd_space *space, const ethd_space_sense *sense, const ethd_surface *surfaces,
                                uint32_t count, ethd_space_command *command) {
  ethd_space_trace own;
  ethd__space_tick t;
  t.sense = sense;
  t.surfaces = surfaces;
  t.count = count;
  t.trace = &own;
  ETHD__FP_RETURN(ethd_status, rehearse(space, &t, command));
}

double ethd_space_period(const ethd_space *space) { return space->period; }

ethd_space_kind ethd_space_commands(const ethd_space *space) { return space->kind; }

ETHD__FP_APART static void reset(ethd_space *space) {
  memset(&space->state, 0, sizeof space->state);
  resume(&space->plans[space->mail.ruling], &space->state);
}

void ethd_space_reset(ethd_space *space) { ETHD__FP_DO(reset(space)); }

void ethd_space_restart(ethd_space *space) {
  double memory[ETHD_MEMORY];
  memcpy(memory, space->state.core.memory, sizeof memory);
  ethd_space_reset(space);
  memcpy(space->state.core.memory, memory, sizeof memory);
}

ethd_status ethd_space_poll(ethd_space *space, ethd_event *out) { return ethd__mail_poll(&space->mail, out); }

void ethd_space_acknowledge(ethd_space *space) { atomic_store_explicit(&space->mail.clear, 1, memory_order_relaxed); }

double ethd_space_clean_time(const ethd_space *space) {
  return ethd__core_clean_time(&space->state.core, space->plans[space->mail.ruling].setup.period);
}

const ethd_law *ethd_space_law(const ethd_space *space) {
  const ethd_law *law = ethd__fence_runs(&space->state.core);
  return law ? law : ethd__fence_runs(&space->scratch.core);
}

void ethd_space_counters(const ethd_space *space, ethd_counters *out) { *out = space->state.core.counters; }
