/* Code that detects a fault notes its row of the fault table, with a value if the row has one. At the end of the tick
   rows.c decides from the noted rows whether the torque is removed or the ring is stopped, what latches, which status
   the step returns and which events there are. All [rt]. */
#ifndef ETHD__CORE_ROWS_H
#define ETHD__CORE_ROWS_H

#include "core/state.h"

/* Notes a row whose first reaction is due. */
static inline void ethd__note(ethd__core *core, ethd_fault row) ETHD_RT {
  core->met.rows.faults |= ETHD_FAULT_BIT(row);
}

/* Notes a row whose second reaction is due. */
static inline void ethd__note_grave(ethd__core *core, ethd_fault row) ETHD_RT {
  core->met.rows.grave |= ETHD_FAULT_BIT(row);
}

/* Notes a row whose first reaction is due, with the value that its event carries (fault.h). */
void ethd__note_value(ethd__core *core, ethd_fault row, double value) ETHD_RT;

/* Notes why a law's result can't be used: its status, or a number in it that isn't finite or is out of its range. */
void ethd__note_law(ethd__core *core, ethd_kind kind, ethd_status status) ETHD_RT;

/* Returns true if a law's result can be used, and else notes why not. */
static inline bool ethd__law_is_good(ethd__core *core, ethd_kind kind, ethd_status status, bool finite) ETHD_RT {
  if (status >= 0 && finite) return true;
  ethd__note_law(core, kind, status);
  return false;
}

/* Begins a tick with the rows that device and loop report in the sense. */
void ethd__rows_take(ethd__core *core, int64_t faults, int64_t grave) ETHD_RT;

static inline void ethd__rows_begin(ethd__core *core, int64_t faults, int64_t grave) ETHD_RT {
  core->met.rows.faults = core->met.rows.grave = core->met.valued = 0;
  if (faults | grave) ethd__rows_take(core, faults, grave);
}

static inline bool ethd__rows_any(const ethd__fault_rows *rows) ETHD_RT { return (rows->faults | rows->grave) != 0; }

/* Returns those of the rows whose due reaction is ZERO. */
int64_t ethd__rows_zero(const ethd__fault_rows *rows) ETHD_RT;

/* Returns true if a noted row, or the latched fault, takes the laws' torque away. */
static inline bool ethd__rows_forbid(const ethd__core *core) ETHD_RT {
  return core->fault || (ethd__rows_any(&core->met.rows) && ethd__rows_zero(&core->met.rows));
}

/* The guard's flags that rows set: the reasons to stop the effector, and that it has stopped (ethd_guard_state). */
typedef struct ethd__halt {
  int32_t *stopping, *stopped;
} ethd__halt;

/* Makes the guard stop the effector, or remove its torque, if a noted row calls for it. */
void ethd__rows_stop(const ethd__core *core, ethd__halt halt) ETHD_RT;

/* Notes the guard's actions (bits; a command was cut for `cut` s). */
void ethd__note_guard(ethd__core *core, int64_t bits, double cut) ETHD_RT;

/* Latches the faults that must latch. Returns the fault with which the tick ends. */
ethd_fault ethd__judge(ethd__core *core, bool latches, ethd__halt halt, int64_t periods) ETHD_RT;

/* Returns the occurrences that begin at this tick, and as `grave` those whose second reaction begins at it. */
ethd__fault_rows ethd__rows_begun(const ethd__core *core, bool latches) ETHD_RT;

/* Returns the step's status for a tick that ends with this fault. */
ethd_status ethd__rows_status(ethd_fault fault) ETHD_RT;

#endif
