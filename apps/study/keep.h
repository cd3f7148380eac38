/* A tap's own folder, which is made under another name and gets its final one once it is on the disk. All [main]. */
#ifndef ETHD__APPS_STUDY_KEEP_H
#define ETHD__APPS_STUDY_KEEP_H

#include "study/source.h"

/* Makes folder/name, with the ticks and tap.csv with `row`. On failure nothing is left of it. */
ETHD_MUST_CHECK ethd_status ethd__tap_keep(const char *folder, const char *name, const ethd_config *config,
                                           const ethd__taken *taken, const char *words, const char *row,
                                           char message[ETHD_MESSAGE_MAX]);

/* Gives the row of a tap that is there already, which the caller frees; NULL: it isn't. A half-made tap is removed. */
ETHD_MUST_CHECK ethd_status ethd__tap_kept(const char *folder, const char *name, char **row,
                                           char message[ETHD_MESSAGE_MAX]);

#endif
