/* Gathers the tables of a study from its folder or from several stations' folders, and who isn't analysed. All
   [main]. */
#ifndef ETHD__APPS_REPORT_GATHER_H
#define ETHD__APPS_REPORT_GATHER_H

#include "report/sheet.h"
#include "study/columns.h"

typedef struct ethd__stations {
  const char *const *folder;
  size_t count;
} ethd__stations;

/* Reads the tables. Of one folder they are as they stand there; of several they are those that ethd-study --merge would
   make, and what it would refuse is refused. A table that isn't there is empty (columns 0). */
ETHD_MUST_CHECK ethd_status ethd__gather(const ethd__stations *stations, ethd__sheet out[ETHD_TABLES],
                                         char message[ETHD_MESSAGE_MAX]);
void ethd__gather_free(ethd__sheet sheet[ETHD_TABLES]);

/* Participants whose taps are left out of the analysis, in the order of their names. */
typedef struct ethd__absent {
  char **name;
  size_t count;
} ethd__absent;

/* Finds those whose column `analysed` is 0 in participants.csv; a table without that column names nobody. */
ETHD_MUST_CHECK ethd_status ethd__absent_of(const ethd__sheet *participants, ethd__absent *out,
                                            char message[ETHD_MESSAGE_MAX]);
bool ethd__is_absent(const ethd__absent *absent, const char *participant);
void ethd__absent_free(ethd__absent *absent);

#endif
