#ifndef ETHD__CORE_SWAP_H
#define ETHD__CORE_SWAP_H

#include "core/state.h"

/* Lets contacts and laws go on under a new plan: laws that were replaced begin anew, and adopt the contacts as the old
   ones leave them; contacts on surfaces of places that were replaced (bits) look for the same surface there
   (candidates.h). old: the state after the old plan's run, NULL: it had none. [rt] */
void ethd__core_swap(const ethd__core_plan *from, const ethd__core_plan *to, ethd__core *core, const ethd__core *old,
                     unsigned replaced) ETHD_RT;

/* Begins again after a reset or an acknowledged fault: no contact, no fade, the tracking law from its start. [rt] */
void ethd__core_resume(const ethd__core_plan *plan, ethd__core *core) ETHD_RT;

#endif
