/* Commands of ethd-run: each line of input gets one line as its answer. All [main]. */
#ifndef ETHD__APPS_RUN_COMMANDS_H
#define ETHD__APPS_RUN_COMMANDS_H

#include "run/session.h"

#define ETHD__LINE_MAX 512

typedef struct ethd__commands {
  char line[ETHD__LINE_MAX];
  size_t length;
  bool overlong, ended; /* ended: no more input */
  bool stop;            /* the command stop was given */
  double hold;          /* s on the loop's clock; the next command waits until then */
} ethd__commands;

/* Reads the available input, at most one line, and answers it. `wait_ms` is as for poll(2). */
void ethd__commands_read(ethd__commands *c, ethd__session *s, int wait_ms);

#endif
