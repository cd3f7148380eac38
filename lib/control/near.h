/* The surfaces of the scenes near the ring, and the contacts with them. */
#ifndef ETHD__CONTROL_NEAR_H
#define ETHD__CONTROL_NEAR_H

#include "control/context.h"
#include "control/places.h"

/* Computes the contacts of ring and finger: t->core.touched and the trace's fields of contacts. Returns false if a law
   failed, which is noted. [rt] */
bool ethd__touch(ethd__tick *t) ETHD_RT;

#endif
