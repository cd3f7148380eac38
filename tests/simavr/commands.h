/* What can be told to the simulated ring while it runs, a line at a time. */
#ifndef SIMAVR_COMMANDS_H
#define SIMAVR_COMMANDS_H

#include <stdbool.h>

#include "ring.h"
#include "terminal.h"

typedef struct session {
  ring *ring;
  terminal terminal;
  bool step;   /* time stands still but for the command run */
  double wall; /* s of real time that simulating took */
  double run;  /* s that remain to be run */
  bool quit;
} session;

extern const char commands_help[];

/* True if the line was understood; else `why` says what is allowed. */
bool command(session *s, const char *line, const char **why);

#endif
