/* The tables for people, made from a folder's store. All [main]. */
#ifndef ETHD__APPS_STUDY_TABLES_H
#define ETHD__APPS_STUDY_TABLES_H

#include "study/columns.h"
#include "study/progress.h"

/* Writes taps.csv and, of a session, survey.csv, events.csv and participants.csv, each whole. */
ETHD_MUST_CHECK ethd_status ethd__tables_write(const ethd__folder *folder, ethd__study_store *store,
                                               char message[ETHD_MESSAGE_MAX]);

/* Gives the text of these tables, freed by the caller; NULL for the tables from the folder's creation. Exit 1
   without memory. */
ETHD_MUST_CHECK ethd_status ethd__tables_of(const ethd__folder *folder, ethd__study_store *store,
                                            char *out[ETHD_TABLES], char message[ETHD_MESSAGE_MAX]);

#endif
