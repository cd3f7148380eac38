/* A participant's name, and a tap's row in the store. All [main]. */
#ifndef ETHD__APPS_STUDY_ROW_H
#define ETHD__APPS_STUDY_ROW_H

#include "store/store.h"
#include "study/source.h"

#define ETHD_STUDY_ID_MAX 16

/* Writes P01, P02, .. with as many digits as the number of participants needs, two at least. */
void ethd__participant_id(const ethd__protocol *protocol, uint32_t person, char out[ETHD_STUDY_ID_MAX]);

/* Puts a tap; `point` of the grid, 0 without one. */
ETHD_MUST_CHECK ethd_status ethd__tap_put(ethd__study_store *store, size_t point, const ethd__taken *taken,
                                          char message[ETHD_MESSAGE_MAX]);

#endif
