/* The controller's memory: two plans, the state, a copy of it for rehearsals and swaps, data between threads. */
#ifndef ETHD__CONTROL_CONTROLLER_H
#define ETHD__CONTROL_CONTROLLER_H

#include "control/state.h"
#include "core/mail.h"

struct ethd_control {
  double period; /* of any plan */
  ethd__plan plans[2];
  ethd__state state, scratch;
  ethd__mail mail;
};

#endif
