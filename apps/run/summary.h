/* What a run was, for people. [main]. */
#ifndef ETHD_APPS_RUN_SUMMARY_H
#define ETHD_APPS_RUN_SUMMARY_H

#include <stdio.h>

#include "run/session.h"

/* After the session's end. */
void ethd__summary_print(FILE *out, const ethd__session *s, const char *record);

/* What the machine refused, a sentence each and what mends it; nothing when nothing was. */
void ethd__shortfalls_print(FILE *out, int32_t bits);

/* What people should know before anything moves: the device's remarks, what the machine refuses. */
void ethd__remarks_print(FILE *out, ethd__session *s);

/* A line of a histogram: p50, p99, p99.9, max in us. */
void ethd__durations_print(FILE *out, const char *name, const ethd_histogram *h);

/* The fault table as a page. */
void ethd__faults_print(FILE *out);

#endif
