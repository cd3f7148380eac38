/* What of the scenes is near the ring, and what is touched of it. */
#ifndef ETHD__CONTROL_NEAR_H
#define ETHD__CONTROL_NEAR_H

#include "control/context.h"
#include "control/places.h"

/* Works out from ring and finger what is touched: t->core.touched and the trace's fields of contacts. Returns false if a
   law failed, which is noted. [rt] */
bool ethd__touch(ethd__tick *t) ETHD_RT;

#endif
