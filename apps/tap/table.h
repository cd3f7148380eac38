/* Prints ethd-tap's tables. */
#ifndef ETHD__APPS_TAP_TABLE_H
#define ETHD__APPS_TAP_TABLE_H

#include <stdio.h>

#include "tap/summary.h"

typedef struct ethd__heading {
  const char *plant, *config; /* names as given */
  const char *movement;       /* file, NULL: the synthetic hand */
  double scale;
  bool scaled;
} ethd__heading;

/* Prints the cells; with the synthetic hand also Table 1, the fitted figures and those that aren't reproduced. */
void ethd__table_print(FILE *file, const ethd__study *study, const ethd__heading *heading, const ethd__cell *cells,
                       size_t count);

#endif
