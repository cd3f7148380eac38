/* Gives the reason why a loop didn't start, and the remedy. [main] */
#ifndef ETHD__APPS_RUN_REFUSAL_H
#define ETHD__APPS_RUN_REFUSAL_H

#include "ethd/config.h"
#include "ethd/loop.h"

/* Says in message what ethd_loop_create (`loop` is then NULL) or ethd_loop_start, which failed with `status`, left in
   `error`; returns the status. */
ethd_status ethd__start_refused(const ethd_loop *loop, ethd_status status, const ethd_error *error,
                                char message[ETHD_MESSAGE_MAX]);

#endif
