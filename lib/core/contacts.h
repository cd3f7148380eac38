/* The results of the contacts: t->touched. Both return false if a law failed, which is noted. [rt] */
#ifndef ETHD__CORE_CONTACTS_H
#define ETHD__CORE_CONTACTS_H

#include "core/candidates.h"

/* Begins with no contact, and asks the transition law how far it looks ahead: t->near. */
bool ethd__contacts_begin(ethd__core_tick *t) ETHD_RT;

/* Computes the contacts of matched candidates. */
bool ethd__contacts(ethd__core_tick *t, ethd__candidates *c) ETHD_RT;

#endif
