/* Pictures by gnuplot. All [main]. */
#ifndef ETHD_REPORT_PICTURE_H
#define ETHD_REPORT_PICTURE_H

#include "ethd/config.h"

/* Refuses a machine without gnuplot, or with one that can't write PNG. */
ETHD_MUST_CHECK ethd_status ethd__picture_ready(char message[ETHD_MESSAGE_MAX]);

/* Runs a script that came with the programs ("report-boxes.gp") after the settings, "name='value'; ..". */
ETHD_MUST_CHECK ethd_status ethd__picture_draw(const char *script, const char *settings,
                                               char message[ETHD_MESSAGE_MAX]);

/* The word as gnuplot's '..' takes it, appended to "name='"; freed by the caller, NULL: no memory. */
char *ethd__picture_quote(const char *text);

#endif
