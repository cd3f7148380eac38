/* Gives the reason why a loop didn't start, and the remedy. [main] */
#ifndef ETHD__APPS_RUN_REFUSAL_H
#define ETHD__APPS_RUN_REFUSAL_H

#include "ethd/config.h"
#include "ethd/loop.h"

/* Explains in message why ethd_loop_create (`loop` is then NULL) or ethd_loop_start failed with `status` and `error`;
   returns the status. */
ethd_status ethd__start_refused(const ethd_loop *loop, ethd_status status, const ethd_error *error,
                                char message[ETHD_MESSAGE_MAX]);

#endif
