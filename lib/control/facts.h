#ifndef ETHD__CONTROL_FACTS_H
#define ETHD__CONTROL_FACTS_H

#include "control/context.h"

/* Computes the facts about the device along the contact's n, for a law that looks ahead. [rt] */
void ethd__facts(const ethd__tick *t, const ethd_contact *c, ethd_facts *out) ETHD_RT;

#endif
