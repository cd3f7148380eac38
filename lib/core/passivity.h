#ifndef ETHD__CORE_PASSIVITY_H
#define ETHD__CORE_PASSIVITY_H

#include "core/tick.h"

/* Returns the force along n, N, that is to be added to the wall's to keep a contact passive; brake: what else acts
   along n, N. To be called once for each contact in a tick, and only where limits.energy is set. [rt] */
double ethd__passivity(const ethd__core_tick *t, ethd__slot *slot, const ethd_contact *c, double wall,
                       double brake) ETHD_RT;

#endif
