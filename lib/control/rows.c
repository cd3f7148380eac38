/* What follows from the rows of the fault table that a tick noted. The table's reactions become four masks: the rows
   that stop the ring or take the torque away by their first reaction, and those that do so by their second. */
#include "control/rows.h"

#define IF(reaction, wanted, row) (ETHD_REACTION_##reaction == ETHD_REACTION_##wanted ? ETHD_FAULT_BIT(row) : 0)
#define ALL(row, name, first, second, bound, sentence) | ETHD_FAULT_BIT(row)
#define STOP_1(row, name, first, second, bound, sentence) | IF(first, STOP, row)
#define STOP_2(row, name, first, second, bound, sentence) | IF(second, STOP, row)
#define ZERO_1(row, name, first, second, bound, sentence) | IF(first, ZERO, row)
#define ZERO_2(row, name, first, second, bound, sentence) | IF(second, ZERO, row)

static const int64_t all = 0 ETHD_FAULTS(ALL);
static const int64_t stop_1 = 0 ETHD_FAULTS(STOP_1), stop_2 = 0 ETHD_FAULTS(STOP_2);
static const int64_t zero_1 = 0 ETHD_FAULTS(ZERO_1), zero_2 = 0 ETHD_FAULTS(ZERO_2);

/* Returns those of the rows whose due reaction is STOP. */
static int64_t stops(const ethd__fault_rows *r) { return (r->faults & ~r->grave & stop_1) | (r->grave & stop_2); }

int64_t ethd__rows_zero(const ethd__fault_rows *r) { return (r->faults & ~r->grave & zero_1) | (r->grave & zero_2); }

static ethd_fault lowest(int64_t rows) { return (ethd_fault)__builtin_ctzll((uint64_t)rows); }

/* ---- noting ---- */

void ethd__note_value(ethd__state *state, ethd_fault row, double value) {
  ethd__note(state, row);
  state->met.valued |= ETHD_FAULT_BIT(row);
  state->met.value[row] = value;
}

void ethd__note_law(ethd__state *state, ethd_kind kind, ethd_status status) {
  if (status < 0)
    ethd__note_value(state, ETHD_FAULT_LAW, 100 * (int)kind - (int)status);
  else
    ethd__note_value(state, ETHD_FAULT_FINITE, (double)kind);
}

void ethd__rows_take(ethd__state *state, const ethd_sense *sense) {
  state->met.rows.faults = sense->faults & all;
  state->met.rows.grave = sense->grave & all;
}

#define CUT_MAX (0.1 + 1e-9) /* s; a torque that is cut for longer makes an event (sums of periods are rounded) */

static void note_guard(ethd__state *state, int64_t bits) {
  if (bits & ETHD_GUARD_WORKSPACE) ethd__note_grave(state, ETHD_FAULT_WORKSPACE);
  if (bits & ETHD_GUARD_FINITE) ethd__note(state, ETHD_FAULT_FINITE);
  if (bits & ETHD_GUARD_TORQUE) ethd__note(state, ETHD_FAULT_TORQUE);
  if (bits & ETHD_GUARD_TORQUE && state->guard.cut > CUT_MAX) ethd__note_grave(state, ETHD_FAULT_TORQUE);
  if (bits & ETHD_GUARD_RATE) ethd__note(state, ETHD_FAULT_TORQUE_RATE);
  if (bits & ETHD_GUARD_STEEP) ethd__note_grave(state, ETHD_FAULT_TORQUE_RATE);
  if (bits & ETHD_GUARD_MARGIN) ethd__note(state, ETHD_FAULT_WORKSPACE);
  if (bits & ETHD_GUARD_HEAT) ethd__note(state, ETHD_FAULT_HEAT);
}

/* ---- reactions ---- */

void ethd__rows_stop(ethd__state *state) {
  int64_t zero = ethd__rows_zero(&state->met.rows);
  if (!zero && !stops(&state->met.rows)) return;
  state->guard.stopping |= ETHD_GUARD_FAULT;
  if (zero) state->guard.stopped = 1;
}

/* Latches the first fault, which stays; a later ZERO ends a STOP that is still damping. Returns the latched fault. */
static ethd_fault latch(ethd__state *state, ethd_fault first, int64_t zero) {
  if (zero) ethd__rows_stop(state);
  if (!state->fault) __atomic_store_n(&state->fault, first, __ATOMIC_RELAXED);
  return (ethd_fault)state->fault;
}

ethd_fault ethd__judge(const ethd__plan *plan, ethd__state *state, int64_t guard_bits, int64_t periods) {
  if (guard_bits) note_guard(state, guard_bits);
  int64_t zero = ethd__rows_zero(&state->met.rows), calls = zero | stops(&state->met.rows);
  if (!calls) {
    __atomic_store_n(&state->clean, state->clean + periods, __ATOMIC_RELAXED);
    return (ethd_fault)state->fault;
  }
  ethd_fault first = lowest(zero ? zero : calls);
  __atomic_store_n(&state->clean, 0, __ATOMIC_RELAXED);
  /* a fault that an earlier setup latched stays latched under this one */
  if (plan->setup.limits.latch || state->fault) return latch(state, first, zero);
  state->guard.stopping = state->guard.stopped = 0; /* without latching each tick is judged on its own */
  return first;
}

/* ---- what is reported ---- */

ethd__fault_rows ethd__rows_begun(const ethd__plan *plan, const ethd__state *state) {
  const ethd__fault_rows *met = &state->met.rows, *before = &state->before;
  ethd__fault_rows begun = {(met->faults | met->grave) & ~(before->faults | before->grave),
                            met->grave & ~before->grave};
  /* without latching each tick is judged on its own */
  if (!plan->setup.limits.latch) begun.faults |= ethd__rows_zero(met) | stops(met);
  return begun;
}

ethd_status ethd__rows_status(ethd_fault fault) {
  switch (fault) {
  case ETHD_FAULT_NONE: return ETHD_OK;
  case ETHD_FAULT_INPUT:
  case ETHD_FAULT_FINITE: return ETHD_E_NOT_FINITE;
  case ETHD_FAULT_LAW: return ETHD_E_LAW;
  case ETHD_FAULT_BUDGET: return ETHD_E_BUDGET;
  case ETHD_FAULT_SPEED:
  case ETHD_FAULT_WORKSPACE: return ETHD_E_RANGE;
  default: return ETHD_E_DEVICE;
  }
}
