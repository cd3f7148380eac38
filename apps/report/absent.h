/* Participants whose taps are left out of the analysis, as participants.csv has them. All [main]. */
#ifndef ETHD_REPORT_ABSENT_H
#define ETHD_REPORT_ABSENT_H

#include "report/data.h"

/* Those whose column `analysed` is 0; a table without that column names nobody. */
ETHD_MUST_CHECK ethd_status ethd__absent_take(ethd__data *data, const ethd__sheet *participants,
                                              char message[ETHD_MESSAGE_MAX]);
bool ethd__absent(const ethd__data *data, const char *participant);
void ethd__absent_free(ethd__data *data);

#endif
