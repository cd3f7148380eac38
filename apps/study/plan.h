/* The participants' orders before a study begins, and their balance. All [main]. */
#ifndef ETHD__APPS_STUDY_PLAN_H
#define ETHD__APPS_STUDY_PLAN_H

#include <stdio.h>

#include "study/order.h"

#define ETHD_STUDY_PLANNED 10000u /* participants whose orders are printed at most */

/* Returns the text of orders.csv, which the caller frees. */
char *ethd__plan_table(const ethd__protocol *protocol);

/* For people: each participant's order, the balance at every number of participants, and a warning if the study's own
   number isn't balanced, with the next balanced one. Balanced: at each speed all strategies are equally often first,
   equally often last, and equally often directly after each other strategy. */
void ethd__plan_print(FILE *file, const ethd__protocol *protocol);

#endif
