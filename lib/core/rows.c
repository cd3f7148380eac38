/* Reactions to the noted rows of a tick. The table's reactions become four masks: the rows that stop the ring or remove
   the torque by their first reaction, and those that do so by their second. */
#include "core/rows.h"

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

void ethd__note_value(ethd__core *core, ethd_fault row, double value) {
  ethd__note(core, row);
  core->met.valued |= ETHD_FAULT_BIT(row);
  core->met.value[row] = value;
}

void ethd__note_law(ethd__core *core, ethd_kind kind, ethd_status status) {
  if (status < 0)
    ethd__note_value(core, ETHD_FAULT_LAW, 100 * (int)kind - (int)status);
  else
    ethd__note_value(core, ETHD_FAULT_FINITE, (double)kind);
}

void ethd__rows_take(ethd__core *core, int64_t faults, int64_t grave) {
  core->met.rows.faults = faults & all;
  core->met.rows.grave = grave & all;
}

#define CUT_MAX (0.1 + 1e-9) /* s; a torque cut for longer makes an event (sums of periods are rounded) */

void ethd__note_guard(ethd__core *core, int64_t bits, double cut) {
  if (bits & ETHD_GUARD_WORKSPACE) ethd__note_grave(core, ETHD_FAULT_WORKSPACE);
  if (bits & ETHD_GUARD_FINITE) ethd__note(core, ETHD_FAULT_FINITE);
  if (bits & ETHD_GUARD_TORQUE) ethd__note(core, ETHD_FAULT_TORQUE);
  if (bits & ETHD_GUARD_TORQUE && cut > CUT_MAX) ethd__note_grave(core, ETHD_FAULT_TORQUE);
  if (bits & ETHD_GUARD_RATE) ethd__note(core, ETHD_FAULT_TORQUE_RATE);
  if (bits & ETHD_GUARD_STEEP) ethd__note_grave(core, ETHD_FAULT_TORQUE_RATE);
  if (bits & ETHD_GUARD_MARGIN) ethd__note(core, ETHD_FAULT_WORKSPACE);
  if (bits & ETHD_GUARD_HEAT) ethd__note(core, ETHD_FAULT_HEAT);
}

/* ---- reactions ---- */

void ethd__rows_stop(const ethd__core *core, ethd__halt halt) {
  int64_t zero = ethd__rows_zero(&core->met.rows);
  if (!zero && !stops(&core->met.rows)) return;
  *halt.stopping |= ETHD_GUARD_FAULT;
  if (zero) *halt.stopped = 1;
}

/* Latches the first fault, which stays; a later ZERO ends a STOP that is still braking. Returns the latched fault. */
static ethd_fault latch(ethd__core *core, ethd__halt halt, ethd_fault first, int64_t zero) {
  if (zero) ethd__rows_stop(core, halt);
  if (!core->fault) __atomic_store_n(&core->fault, first, __ATOMIC_RELAXED);
  return (ethd_fault)core->fault;
}

ethd_fault ethd__judge(ethd__core *core, bool latches, ethd__halt halt, int64_t periods) {
  int64_t zero = ethd__rows_zero(&core->met.rows), calls = zero | stops(&core->met.rows);
  if (!calls) {
    __atomic_store_n(&core->clean, core->clean + periods, __ATOMIC_RELAXED);
    return (ethd_fault)core->fault;
  }
  ethd_fault first = lowest(zero ? zero : calls);
  __atomic_store_n(&core->clean, 0, __ATOMIC_RELAXED);
  /* a fault that an earlier setup latched stays latched under this one */
  if (latches || core->fault) return latch(core, halt, first, zero);
  *halt.stopping = *halt.stopped = 0; /* without latching each tick is judged on its own */
  return first;
}

/* ---- reports ---- */

ethd__fault_rows ethd__rows_begun(const ethd__core *core, bool latches) {
  const ethd__fault_rows *met = &core->met.rows, *before = &core->before;
  ethd__fault_rows begun = {(met->faults | met->grave) & ~(before->faults | before->grave),
                            met->grave & ~before->grave};
  /* without latching each tick is judged on its own */
  if (!latches) begun.faults |= ethd__rows_zero(met) | stops(met);
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
