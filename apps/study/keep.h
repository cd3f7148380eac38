/* A tap's own folder: made beside its final name, on the disk before it gets it. All [main]. */
#ifndef ETHD_STUDY_KEEP_H
#define ETHD_STUDY_KEEP_H

#include "study/source.h"

/* folder/name holds the ticks and tap.csv with `row`. On failure nothing is left of it. */
ETHD_MUST_CHECK ethd_status ethd__tap_keep(const char *folder, const char *name, const ethd_config *config,
                                           const ethd__taken *taken, const char *words, const char *row,
                                           char message[ETHD_MESSAGE_MAX]);

/* The row of a tap that is there already, NULL: it isn't. Freed by the caller. A half-made one is removed. */
ETHD_MUST_CHECK ethd_status ethd__tap_kept(const char *folder, const char *name, char **row,
                                           char message[ETHD_MESSAGE_MAX]);

#endif
