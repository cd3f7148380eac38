/* Prints a run's results for the user. All [main]. */
#ifndef ETHD__APPS_RUN_SUMMARY_H
#define ETHD__APPS_RUN_SUMMARY_H

#include <stdio.h>

#include "run/session.h"

/* Prints the run's figures; to be called after the session's end. */
void ethd__summary_print(FILE *out, const ethd__session *s, const char *record);

/* Prints a sentence and a remedy for each refusal by the machine. */
void ethd__shortfalls_print(FILE *out, int32_t bits);

/* Prints, before any motion, the device's remarks and the machine's refusals. */
void ethd__remarks_print(FILE *out, ethd__session *s);

/* Prints one line of a histogram: p50, p99, p99.9 and max, us. */
void ethd__durations_print(FILE *out, const char *name, const ethd_histogram *h);

/* Prints the fault table as a page. */
void ethd__faults_print(FILE *out);

#endif
