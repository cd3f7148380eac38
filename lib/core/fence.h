/* Foreign laws: code that isn't the library's own. Their calls are fenced: they may write only their state block, and
   must not change the processor's floating-point control. A violation is undone and fails the call (ETHD_E_FENCE,
   ETHD_E_FENV); the value of row LAW names the law's kind and the violation.

   A plan holds the steps that its ticks call: the laws' own, or the fenced ones: built-in laws have no extra cost. */
#ifndef ETHD__CORE_FENCE_H
#define ETHD__CORE_FENCE_H

#include "core/state.h"

/* Returns true for a law that isn't one of ethd_laws. [main] */
bool ethd__law_is_foreign(const ethd_law *law);

/* Fills plan->foreign and the plan's steps (track, follow, push, rule, range) from its laws. [main] */
void ethd__fence_prepare(ethd__core_plan *plan);

/* Fences the block and lets the law fill it. [rt] */
void ethd__fence_reset(const ethd_law *law, const double *p, ethd__law_block *block) ETHD_RT;

/* Zeroes the block, then lets the law fill it. [rt] */
static inline void ethd__block_reset(const ethd__core_plan *plan, const ethd_law *law, const double *p,
                                     ethd__law_block *block) ETHD_RT {
  memset(block->at, 0, sizeof block->at);
  if (plan->foreign & 1 << law->kind)
    ethd__fence_reset(law, p, block);
  else if (law->reset) /* unreachable: no built-in law has one; the next one may */
    law->reset(p, block->at);
}

/* Lets the plan's transition law, which has `adopt`, adopt a contact. [rt] */
void ethd__fence_adopt(const ethd__core_plan *plan, ethd__law_block *block, const ethd_past *past) ETHD_RT;

/* Gets from the plan's transition law, which has `range`, how far it looks ahead, m. ETHD_E_FENV. [rt] */
ethd_status ethd__fence_range(const ethd__core_plan *plan, ethd__core *core, double speed, double *range) ETHD_RT;

/* Returns the foreign law whose code runs on this state, NULL if none does. [any] */
const ethd_law *ethd__fence_runs(const ethd__core *core) ETHD_RT;

#endif
