/* The orders of a study before it begins: who gets what when, and how well that is balanced. All [main]. */
#ifndef ETHD__APPS_STUDY_PLAN_H
#define ETHD__APPS_STUDY_PLAN_H

#include <stdio.h>

#include "study/order.h"

#define ETHD_STUDY_PLANNED 10000u /* participants whose orders are printed at most */

/* Returns the text of orders.csv, which the caller frees. */
char *ethd__plan_table(const ethd__protocol *protocol);

/* For people: each participant's order, the balance at every number of participants, and a warning where the study's
   own number isn't balanced, with the next one that is. Balanced: at each speed each strategy is as often the first, as
   often the last, and as often directly behind each other one. */
void ethd__plan_print(FILE *file, const ethd__protocol *protocol);

#endif
