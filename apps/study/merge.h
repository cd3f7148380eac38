/* Merges several folders' stores into one. All [main]. */
#ifndef ETHD__APPS_STUDY_MERGE_H
#define ETHD__APPS_STUDY_MERGE_H

#include "study/tables.h"

/* Adds the other stores to a new one. */
typedef struct ethd__merge {
  const void *self;
  ethd_status (*add)(const void *self, ethd__study_store *out, char message[ETHD_MESSAGE_MAX]);
} ethd__merge;

/* Makes study.sqlite and its tables, and replaces the present ones; on failure these stay. The caller has locked the
   folder. *taps: their number. */
ETHD_MUST_CHECK ethd_status ethd__merge_write(const ethd__folder *folder, const ethd__merge *merge, uint64_t *taps,
                                              char message[ETHD_MESSAGE_MAX]);

#endif
