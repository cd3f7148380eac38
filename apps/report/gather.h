/* The tables of a study, of its folder or of several stations' folders, and who of it isn't analysed. All [main]. */
#ifndef ETHD_REPORT_GATHER_H
#define ETHD_REPORT_GATHER_H

#include "report/sheet.h"
#include "study/columns.h"

typedef struct ethd__stations {
  const char *const *folder;
  size_t count;
} ethd__stations;

/* One folder: its tables as they stand there. Several: the tables that ethd-study --merge would make of them, refused
   where it would refuse. A table that isn't there is empty (columns 0). */
ETHD_MUST_CHECK ethd_status ethd__gather(const ethd__stations *stations, ethd__sheet out[ETHD_TABLES],
                                         char message[ETHD_MESSAGE_MAX]);
void ethd__gather_free(ethd__sheet sheet[ETHD_TABLES]);

/* Participants whose taps are left out of the analysis, in the order of their names. */
typedef struct ethd__absent {
  char **name;
  size_t count;
} ethd__absent;

/* Those whose column `analysed` is 0 in participants.csv; a table without that column names nobody. */
ETHD_MUST_CHECK ethd_status ethd__absent_of(const ethd__sheet *participants, ethd__absent *out,
                                            char message[ETHD_MESSAGE_MAX]);
bool ethd__is_absent(const ethd__absent *absent, const char *participant);
void ethd__absent_free(ethd__absent *absent);

#endif
