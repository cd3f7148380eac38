/* What a search found, for people and for pictures. [main] */
#ifndef ETHD_TUNE_TABLE_H
#define ETHD_TUNE_TABLE_H

#include <stdio.h>

#include "tune/search.h"

/* The configuration's own point, the front, the choice, what each gain buys. */
void ethd__tune_print(FILE *out, const ethd__tune_search *search, const ethd__tune_entry *choice);

/* The same point's margins loop by loop, as ethd-check gives them. */
void ethd__tune_print_margins(FILE *out, const ethd__tune_rig *rig, const ethd__tune_point *point);

/* One gain of the choice at a time put back to the configuration's: what is lost. ETHD_OK once ethd__stop is set too. */
ETHD_MUST_CHECK ethd_status ethd__tune_print_gains(FILE *out, const ethd__tune_search *search,
                                                   const ethd__tune_entry *choice, char message[ETHD_MESSAGE_MAX]);

/* Every point of every round: its values, figures and goals; keeps, front, chosen as 0 or 1. */
ETHD_MUST_CHECK ethd_status ethd__tune_csv(const ethd__tune_search *search, const ethd__tune_entry *choice,
                                           const char *path, char message[ETHD_MESSAGE_MAX]);

#endif
