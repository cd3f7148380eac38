/* The questions of ethd_conform about the end of a torque. All [main]. */
#ifndef ETHD__CONFORM_LETTING_GO_H
#define ETHD__CONFORM_LETTING_GO_H

#include "conform/conform_rig.h"

/* A torque that is not renewed ends. */
ethd_verdict ethd__conform_watchdog(const ethd_conform_def *def, ethd_conform_answer *a);

/* A device that gets no message at all removes the torque by itself. */
ethd_verdict ethd__conform_silence(const ethd_conform_def *def, ethd_conform_answer *a);

/* A device stays safe after `safe`, whatever is written. */
ethd_verdict ethd__conform_safe(const ethd_conform_def *def, ethd_conform_answer *a);

/* A start remembers no torque from before. */
ethd_verdict ethd__conform_restart(const ethd_conform_def *def, ethd_conform_answer *a);

#endif
