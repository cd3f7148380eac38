/* A tap's row in the store, and its own folder, which is made under another name and renamed once it is on the
   disk. All [main]. */
#ifndef ETHD__APPS_STUDY_KEEP_H
#define ETHD__APPS_STUDY_KEEP_H

#include "store/store.h"
#include "study/folder.h"
#include "study/source.h"

/* Makes folder/name, with the ticks. On failure nothing is left of it. */
ETHD_MUST_CHECK ethd_status ethd__tap_keep(const char *folder, const char *name, const ethd_config *config,
                                           const ethd__taken *taken, const char *words, char message[ETHD_MESSAGE_MAX]);

/* Removes a kill's remains below taps/: an unfinished folder, and the folder of a tap that isn't in the store.
   Refuses a folder with more of these, because then the store is an old one. */
ETHD_MUST_CHECK ethd_status ethd__tap_remove_torn(const ethd__folder *folder, ethd__study_store *store,
                                                  char message[ETHD_MESSAGE_MAX]);

/* Puts a tap; `point` of the grid, 0 without one. */
ETHD_MUST_CHECK ethd_status ethd__tap_put(ethd__study_store *store, size_t point, const ethd__taken *taken,
                                          char message[ETHD_MESSAGE_MAX]);

#endif
