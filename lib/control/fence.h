/* Foreign laws: code that isn't the library's own. Their calls are fenced: they may write their state block and
   nothing around it, and leave the processor's floating-point control as it was. What is found fails the call
   (ETHD_E_FENCE, ETHD_E_FENV), so the fault table's row LAW names the kind of law and what it did, and what was
   changed is put back.

   A plan holds the steps that its ticks call: the laws' own, or the fenced ones. So built-in laws pay nothing. */
#ifndef ETHD__CONTROL_FENCE_H
#define ETHD__CONTROL_FENCE_H

#include "control/state.h"

/* True for a law that isn't one of ethd_laws. [main] */
bool ethd__law_is_foreign(const ethd_law *law);

/* Fills plan->foreign and the three steps from its setup. [main] */
void ethd__fence_prepare(ethd__plan *plan);

/* Fences the block and lets the law fill it. [rt] */
void ethd__fence_reset(const ethd_law *law, const double *p, ethd__block *block) ETHD_RT;

/* Zeroes the block, then lets the law fill it. [rt] */
static inline void ethd__block_reset(const ethd__plan *plan, const ethd_law *law, const double *p,
                                     ethd__block *block) ETHD_RT {
  memset(block->at, 0, sizeof block->at);
  if (plan->foreign & 1 << law->kind)
    ethd__fence_reset(law, p, block);
  else if (law->reset)
    law->reset(p, block->at);
}

/* The foreign law whose code runs on this state, NULL: none. [any] */
const ethd_law *ethd__fence_runs(const ethd__state *state) ETHD_RT;

#endif
