/* Rows of study.sqlite that are put, and those of the tables for people. All [main]. */
#ifndef ETHD__APPS_STUDY_ROW_H
#define ETHD__APPS_STUDY_ROW_H

#include "store/store.h"
#include "study/folder.h"
#include "study/source.h"

#define ETHD_STUDY_ID_MAX 16

/* Writes P01, P02, .. with as many digits as the number of participants needs, two at least. */
void ethd__participant_id(const ethd__protocol *protocol, uint32_t person, char out[ETHD_STUDY_ID_MAX]);

/* Puts a tap; `point` of the grid, 0 without one. */
ETHD_MUST_CHECK ethd_status ethd__tap_put(ethd__study_store *store, size_t point, const ethd__taken *taken,
                                          char message[ETHD_MESSAGE_MAX]);

/* Prints all taps as rows of taps.csv. In a simulation those of a point stand together, and the study and the point
   before each row, its gains behind; in a session they come as they were done. */
ETHD_MUST_CHECK ethd_status ethd__taps_print(FILE *file, ethd__study_store *store, const ethd__folder *folder,
                                             char message[ETHD_MESSAGE_MAX]);

#endif
