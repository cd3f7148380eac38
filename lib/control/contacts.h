#ifndef ETHD__CONTROL_CONTACTS_H
#define ETHD__CONTROL_CONTACTS_H

#include "control/context.h"

/* Works out from ring and finger what is touched: trace->beta, fe and fd, t->shift, and the trace's fields of the
   deepest contact. Returns false if a law failed, which is noted. [rt] */
bool ethd__contacts(ethd__tick *t) ETHD_RT;

#endif
