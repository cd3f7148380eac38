/* The terminal as a study's front: lines on stdout, commands and answers on stdin. All [main]. */
#ifndef ETHD__APPS_SCREEN_CONSOLE_H
#define ETHD__APPS_SCREEN_CONSOLE_H

#include "study/front.h"

/* Returns the phrase with a tap's result for the participant, and the next action. [any] */
ethd__phrase_name ethd__advice(ethd__reason reason);

/* Does the same for a tap that the experimenter may have accepted or rejected (study/front.h). [any] */
ethd__phrase_name ethd__advised(ethd__reason reason, const char *checked);

/* Commands and answers are read when `ask` is set. */
typedef struct ethd__console {
  const ethd__protocol *protocol;
  bool ask, quiet, ended, paused;
  bool good; /* the latest tap counts: it can be accepted or rejected */
} ethd__console;

ethd__front ethd__console_front(ethd__console *console);

#endif
