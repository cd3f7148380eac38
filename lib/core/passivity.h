#ifndef ETHD__CORE_PASSIVITY_H
#define ETHD__CORE_PASSIVITY_H

#include "core/tick.h"

/* Returns the force along n, N, to add to the wall's so that a contact stays passive; brake: other forces along n, N.
   To be called once for each contact in a tick, and only if limits.energy is set. [rt] */
double ethd__passivity(const ethd__core_tick *t, ethd__slot *slot, const ethd_contact *c, double wall,
                       double brake) ETHD_RT;

#endif
