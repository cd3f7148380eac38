/* Prints the result of a search, and writes it as a table for pictures. [main] */
#ifndef ETHD__APPS_TUNE_TABLE_H
#define ETHD__APPS_TUNE_TABLE_H

#include <stdio.h>

#include "tune/search.h"

/* Prints the configuration's own point, the front and the choice. */
void ethd__tune_print(FILE *out, const ethd__tune_search *search, const ethd__tune_entry *choice);

/* Prints the point's margins without a hand, as ethd-check prints them; returns how many of its loops are unstable. */
int ethd__tune_print_margins(const ethd__tune_rig *rig, const ethd__tune_point *point);

/* Effect of each gain: every goal's figure with this gain alone at the configuration's value, over the choice's figure.
   Over 1 the chosen value is better, under 1 it is worse. */
typedef struct ethd__tune_worths {
  double times[ETHD_TUNE_KEYS_MAX][ETHD_TUNE_GOALS];
} ethd__tune_worths;

ETHD_MUST_CHECK ethd_status ethd__tune_weigh(const ethd__tune_search *search, const ethd__tune_entry *choice,
                                             ethd__tune_worths *out, char message[ETHD_MESSAGE_MAX]);

void ethd__tune_print_worths(FILE *out, const ethd__tune_space *space, const ethd__tune_point *choice,
                             const ethd__tune_worths *worths);

/* Writes every point of every round: its values, figures and goals; keeps, front and chosen are 0 or 1. */
ETHD_MUST_CHECK ethd_status ethd__tune_csv(const ethd__tune_search *search, const ethd__tune_entry *choice,
                                           const char *path, char message[ETHD_MESSAGE_MAX]);

#endif
