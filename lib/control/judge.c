/* From the rows of the fault table that a tick met to what is done: the table's reactions as masks. */
#include "control/control.h"

#define IF(reaction, wanted, row) (ETHD_REACTION_##reaction == ETHD_REACTION_##wanted ? ETHD_FAULT_BIT(row) : 0)
#define ALL(row, name, first, second, bound, sentence) | ETHD_FAULT_BIT(row)
#define STOP_1(row, name, first, second, bound, sentence) | IF(first, STOP, row)
#define STOP_2(row, name, first, second, bound, sentence) | IF(second, STOP, row)
#define ZERO_1(row, name, first, second, bound, sentence) | IF(first, ZERO, row)
#define ZERO_2(row, name, first, second, bound, sentence) | IF(second, ZERO, row)

static const int64_t all = 0 ETHD_FAULTS(ALL);
static const int64_t stop_1 = 0 ETHD_FAULTS(STOP_1), stop_2 = 0 ETHD_FAULTS(STOP_2);
static const int64_t zero_1 = 0 ETHD_FAULTS(ZERO_1), zero_2 = 0 ETHD_FAULTS(ZERO_2);

static int64_t stops(const ethd__rows *r) ETHD_RT { return (r->faults & ~r->grave & stop_1) | (r->grave & stop_2); }
static int64_t zeros(const ethd__rows *r) ETHD_RT { return (r->faults & ~r->grave & zero_1) | (r->grave & zero_2); }

static ethd_fault lowest(int64_t rows) ETHD_RT { return (ethd_fault)__builtin_ctzll((uint64_t)rows); }

void ethd__rows_take(ethd__rows *rows, const ethd_sense *sense) {
  rows->faults = sense->faults & all;
  rows->grave = sense->grave & all;
}

ethd_fault ethd__rows_zero(const ethd__rows *rows) {
  int64_t zero = zeros(rows);
  return zero ? lowest(zero) : ETHD_FAULT_NONE;
}

/* Prepares the guard for what this tick calls for. */
void ethd__rows_stop(const ethd__rows *rows, ethd_guard_state *guard) {
  int64_t zero = zeros(rows);
  if (!zero && !stops(rows)) return;
  guard->stopping |= ETHD_GUARD_FAULT;
  if (zero) guard->stopped = 1;
}

/* Rows of what the guard did. */
static void add_guard(ethd__rows *rows, const ethd_guard_state *guard, int64_t bits) ETHD_RT {
  if (bits & ETHD_GUARD_SPEED) rows->faults |= ETHD_FAULT_BIT(ETHD_FAULT_SPEED);
  if (bits & ETHD_GUARD_WORKSPACE) rows->grave |= ETHD_FAULT_BIT(ETHD_FAULT_WORKSPACE);
  if (bits & ETHD_GUARD_FINITE) rows->faults |= ETHD_FAULT_BIT(ETHD_FAULT_FINITE);
  if (bits & ETHD_GUARD_TORQUE) ethd__rows_cut(rows, guard);
  if (bits & ETHD_GUARD_RATE) rows->faults |= ETHD_FAULT_BIT(ETHD_FAULT_TORQUE_RATE);
  if (bits & ETHD_GUARD_STEEP) rows->grave |= ETHD_FAULT_BIT(ETHD_FAULT_TORQUE_RATE);
  if (bits & ETHD_GUARD_MARGIN) rows->faults |= ETHD_FAULT_BIT(ETHD_FAULT_WORKSPACE);
  if (bits & ETHD_GUARD_HEAT) rows->faults |= ETHD_FAULT_BIT(ETHD_FAULT_HEAT);
}

static void unlatch(ethd_guard_state *guard) ETHD_RT { guard->stopping = guard->stopped = 0; }

ethd_fault ethd__judge(const ethd__plan *plan, ethd__state *state, int64_t bits, int64_t periods) {
  ethd__rows *met = &state->met;
  if (bits) add_guard(met, &state->guard, bits);
  int64_t zero = zeros(met), calls = zero | stops(met);
  if (!calls) {
    __atomic_store_n(&state->clean, state->clean + periods, __ATOMIC_RELAXED);
    return (ethd_fault)state->fault;
  }
  ethd_fault first = lowest(zero ? zero : calls);
  __atomic_store_n(&state->clean, 0, __ATOMIC_RELAXED);
  if (plan->setup.limits.latch) {
    if (zero) ethd__rows_stop(met, &state->guard);
    if (!state->fault) __atomic_store_n(&state->fault, first, __ATOMIC_RELAXED);
    return (ethd_fault)state->fault;
  }
  unlatch(&state->guard);
  return first;
}

ethd__rows ethd__rows_begun(const ethd__plan *plan, const ethd__state *state) {
  const ethd__rows *met = &state->met, *before = &state->before;
  ethd__rows begun = {(met->faults | met->grave) & ~(before->faults | before->grave), met->grave & ~before->grave};
  if (!plan->setup.limits.latch) begun.faults |= zeros(met) | stops(met); /* each tick alone */
  return begun;
}
