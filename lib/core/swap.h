#ifndef ETHD__CORE_SWAP_H
#define ETHD__CORE_SWAP_H

#include "core/state.h"

/* Continues contacts and laws under a new plan. New laws begin anew and adopt the contacts as the old laws leave them.
   Contacts on surfaces of replaced places (bits) search for the same surface there (candidates.h). old: the state after
   the old plan's run, NULL: there was none. [rt] */
void ethd__core_swap(const ethd__core_plan *from, const ethd__core_plan *to, ethd__core *core, const ethd__core *old,
                     unsigned replaced) ETHD_RT;

/* Begins again after a reset or an acknowledged fault: no contact, no fade, a reset tracking law. [rt] */
void ethd__core_resume(const ethd__core_plan *plan, ethd__core *core) ETHD_RT;

#endif
