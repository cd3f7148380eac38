/* Whatever is wrong is noted as a row of the fault table where it is seen, with a value if the row has one. At the end
   of the tick rows.c decides from the noted rows whether the torque goes or the ring is stopped, what latches, which
   status the step returns and which events there are. All [rt]. */
#ifndef ETHD__CONTROL_ROWS_H
#define ETHD__CONTROL_ROWS_H

#include "control/state.h"

/* Notes a row whose first reaction is due. */
static inline void ethd__note(ethd__state *state, ethd_fault row) ETHD_RT {
  state->met.rows.faults |= ETHD_FAULT_BIT(row);
}

/* Notes a row whose second reaction is due. */
static inline void ethd__note_grave(ethd__state *state, ethd_fault row) ETHD_RT {
  state->met.rows.grave |= ETHD_FAULT_BIT(row);
}

/* Notes a row whose first reaction is due, with the value that its event carries (fault.h). */
void ethd__note_value(ethd__state *state, ethd_fault row, double value) ETHD_RT;

/* Notes why a law's result can't be used: its status, or a number in it that isn't finite or is out of its range. */
void ethd__note_law(ethd__state *state, ethd_kind kind, ethd_status status) ETHD_RT;

/* Returns true if a law's result can be used, and else notes why not. */
static inline bool ethd__law_is_good(ethd__state *state, ethd_kind kind, ethd_status status, bool finite) ETHD_RT {
  if (status >= 0 && finite) return true;
  ethd__note_law(state, kind, status);
  return false;
}

/* Notes the rows that device and loop report in the sense. */
void ethd__rows_take(ethd__state *state, const ethd_sense *sense) ETHD_RT;

/* Begins a tick with no rows but those of the sense. */
static inline void ethd__rows_begin(ethd__state *state, const ethd_sense *sense) ETHD_RT {
  state->met.rows.faults = state->met.rows.grave = state->met.valued = 0;
  if (sense->faults | sense->grave) ethd__rows_take(state, sense);
}

static inline bool ethd__rows_any(const ethd__fault_rows *rows) ETHD_RT { return (rows->faults | rows->grave) != 0; }

/* Returns those of the rows whose due reaction is ZERO. */
int64_t ethd__rows_zero(const ethd__fault_rows *rows) ETHD_RT;

/* Returns true if a noted row, or the latched fault, takes the laws' torque away. */
static inline bool ethd__rows_forbid(const ethd__state *state) ETHD_RT {
  return state->fault || (ethd__rows_any(&state->met.rows) && ethd__rows_zero(&state->met.rows));
}

/* Makes the guard stop the ring, or let it go, if a noted row calls for it. */
void ethd__rows_stop(ethd__state *state) ETHD_RT;

/* Notes what the guard did and latches what must be latched. Returns the fault that the tick ends with. */
ethd_fault ethd__judge(const ethd__plan *plan, ethd__state *state, int64_t guard_bits, int64_t periods) ETHD_RT;

/* Returns the occurrences that begin at this tick, and as `grave` those whose second reaction begins at it. */
ethd__fault_rows ethd__rows_begun(const ethd__plan *plan, const ethd__state *state) ETHD_RT;

/* Returns the step's status for a tick that ends with this fault. */
ethd_status ethd__rows_status(ethd_fault fault) ETHD_RT;

#endif
