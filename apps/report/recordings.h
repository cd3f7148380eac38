/* Where a study's folder keeps the ticks of its taps: a session in taps/P01-03-004, worker i of n of a simulation in
   taps-i-of-n/0-P01-03-004, after the point of the grid. All [main]. */
#ifndef ETHD__APPS_REPORT_RECORDINGS_H
#define ETHD__APPS_REPORT_RECORDINGS_H

#include "report/gather.h"
#include "text/file_name.h"

typedef struct ethd__recordings {
  char **folder;
  size_t count;
} ethd__recordings;

/* Finds which such folders there are; there may be none. Exit 1 without memory. */
void ethd__recordings_find(const ethd__stations *stations, ethd__recordings *out);
void ethd__recordings_free(ethd__recordings *recordings);

/* Gives the name that belongs to a row of taps.csv. */
void ethd__recording_name(const ethd__sheet *sheet, size_t row, char out[ETHD_FILE_NAME_MAX]);

/* Returns the folder of that name, which the caller frees; NULL: there is none. */
char *ethd__recording_path(const ethd__recordings *recordings, const char *name);

#endif
