#ifndef ETHD__CONTROL_CONTACTS_H
#define ETHD__CONTROL_CONTACTS_H

#include "control/context.h"

/* Ring and finger -> what is touched: trace->beta, fe, fd and the row of the deepest contact; t->shift. False: a law
   failed, which is noted. [rt] */
bool ethd__contacts(ethd__tick *t) ETHD_RT;

#endif
