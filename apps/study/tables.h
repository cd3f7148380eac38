/* The tables of a folder, which follow from its journal. All [main]. */
#ifndef ETHD__APPS_STUDY_TABLES_H
#define ETHD__APPS_STUDY_TABLES_H

#include "study/columns.h"
#include "study/folder.h"
#include "study/journal.h"

/* Writes taps.csv, survey.csv, events.csv and participants.csv from the folder's journal, and SHA256SUMS of it all. */
ETHD_MUST_CHECK ethd_status ethd__tables_write(const ethd__folder *folder, char message[ETHD_MESSAGE_MAX]);

/* Gives the text of these tables, freed by the caller; NULL for those that were written as the folder was made. Exit 1
   without memory. */
ETHD_MUST_CHECK ethd_status ethd__tables_of(const ethd__folder *folder, const ethd__journal *journal,
                                            char *out[ETHD_TABLES], char message[ETHD_MESSAGE_MAX]);

#endif
