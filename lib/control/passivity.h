#ifndef ETHD__CONTROL_PASSIVITY_H
#define ETHD__CONTROL_PASSIVITY_H

#include "control/context.h"

/* The force along n that keeps a contact passive, N, to be added to the wall's force; brake: what else acts there,
   N. Once a tick and contact, only where limits.energy is set. [rt] */
double ethd__passivity(const ethd__tick *t, ethd__slot *slot, const ethd_contact *c, double wall, double brake) ETHD_RT;

#endif
