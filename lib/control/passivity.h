#ifndef ETHD__CONTROL_PASSIVITY_H
#define ETHD__CONTROL_PASSIVITY_H

#include "control/context.h"

/* Returns the force along n, N, that is to be added to the wall's to keep a contact passive; brake: what else acts
   along n, N. To be called once for each contact in a tick, and only where limits.energy is set. [rt] */
double ethd__passivity(const ethd__tick *t, ethd__slot *slot, const ethd_contact *c, double wall, double brake) ETHD_RT;

#endif
