/* Draws pictures with gnuplot. No other code runs it. All [main].

   gnuplot reads text as commands in many places, so all text from a file or our command line reaches it as a string:
   names and words go through its standard input as quoted assignments, no shell sees them, and the scripts read data
   files only. */
#ifndef ETHD__APPS_CLI_PICTURE_H
#define ETHD__APPS_CLI_PICTURE_H

#include <stdbool.h>

#include "ethd/config.h"

/* A variable of the script. A path is marked as one: one that begins with < or | would be a command. */
typedef struct ethd__picture_value {
  const char *name, *text;
  bool is_file;
} ethd__picture_value;

/* Refuses a machine without gnuplot, or with one that can't write PNG. */
ETHD_MUST_CHECK ethd_status ethd__picture_ready(char message[ETHD_MESSAGE_MAX]);

/* Runs a script that came with the programs ("report-boxes.gp") with these values, which a NULL name ends. Relative
   paths start at `folder`; NULL: where the program runs. */
ETHD_MUST_CHECK ethd_status ethd__picture_draw(const char *script, const char *folder,
                                               const ethd__picture_value *values, char message[ETHD_MESSAGE_MAX]);

#endif
