/* The one currency for what is wrong: rows of the fault table, noted where they are seen, with a value where the
   row has one. What a tick does about them (torque taken away, ring stopped), what latches, the status that the
   step returns and the events all follow from the rows that it met, in rows.c. All [rt]. */
#ifndef ETHD__CONTROL_ROWS_H
#define ETHD__CONTROL_ROWS_H

#include "control/state.h"

/* This row is met: its first reaction is due. */
static inline void ethd__note(ethd__state *state, ethd_fault row) ETHD_RT {
  state->met.rows.faults |= ETHD_FAULT_BIT(row);
}

/* Its second reaction is due. */
static inline void ethd__note_grave(ethd__state *state, ethd_fault row) ETHD_RT {
  state->met.rows.grave |= ETHD_FAULT_BIT(row);
}

/* The same as ethd__note; the row's event tells this value (fault.h). */
void ethd__note_value(ethd__state *state, ethd_fault row, double value) ETHD_RT;

/* Notes why a law's result can't be used: its status, or a number in it that isn't finite or out of its range. */
void ethd__note_law(ethd__state *state, ethd_kind kind, ethd_status status) ETHD_RT;

static inline bool ethd__law_is_good(ethd__state *state, ethd_kind kind, ethd_status status, bool finite) ETHD_RT {
  if (status >= 0 && finite) return true;
  ethd__note_law(state, kind, status);
  return false;
}

/* Takes the rows that device and loop say. */
void ethd__rows_take(ethd__state *state, const ethd_sense *sense) ETHD_RT;

/* A tick begins: nothing is met but those. */
static inline void ethd__rows_begin(ethd__state *state, const ethd_sense *sense) ETHD_RT {
  state->met.rows.faults = state->met.rows.grave = state->met.valued = 0;
  if (sense->faults | sense->grave) ethd__rows_take(state, sense);
}

static inline bool ethd__rows_any(const ethd__rows *rows) ETHD_RT { return (rows->faults | rows->grave) != 0; }

/* Rows among these whose due reaction takes the torque away. */
int64_t ethd__rows_zero(const ethd__rows *rows) ETHD_RT;

/* True where a row that was met, or the latched one, takes the torque away. */
static inline bool ethd__rows_forbid(const ethd__state *state) ETHD_RT {
  return state->fault || (ethd__rows_any(&state->met.rows) && ethd__rows_zero(&state->met.rows));
}

/* Tells the guard to stop the ring or to let it go, where a row that was met calls for it. */
void ethd__rows_stop(ethd__state *state) ETHD_RT;

/* Notes what the guard did, and latches. Returns the fault that the tick ends with. */
ethd_fault ethd__judge(const ethd__plan *plan, ethd__state *state, int64_t guard_bits, int64_t periods) ETHD_RT;

/* Occurrences that begin at this tick; grave: those whose second reaction begins at it. */
ethd__rows ethd__rows_begun(const ethd__plan *plan, const ethd__state *state) ETHD_RT;

/* What the step returns for a tick that ends with this fault. */
ethd_status ethd__rows_status(ethd_fault fault) ETHD_RT;

#endif
