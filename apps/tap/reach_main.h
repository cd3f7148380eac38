/* ethd-tap with an arm. [main] */
#ifndef ETHD__APPS_TAP_REACH_MAIN_H
#define ETHD__APPS_TAP_REACH_MAIN_H

#include "tap/options.h"

/* Runs the command of the options and returns the exit code; exits 2 on bad input. */
int ethd__reach_main(const ethd__tap_options *options);

#endif
