#ifndef ETHD__CONTROL_FACTS_H
#define ETHD__CONTROL_FACTS_H

#include "control/context.h"

/* Works out what a law that looks ahead gets to know of the device along the contact's n. [rt] */
void ethd__facts(const ethd__tick *t, const ethd_contact *c, ethd_facts *out) ETHD_RT;

#endif
