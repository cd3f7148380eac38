/* A folder's store that is made of several others. All [main]. */
#ifndef ETHD__APPS_STUDY_MERGE_H
#define ETHD__APPS_STUDY_MERGE_H

#include "study/tables.h"

/* What adds the others to a store that is new. */
typedef struct ethd__merge {
  const void *self;
  ethd_status (*add)(const void *self, ethd__study_store *out, char message[ETHD_MESSAGE_MAX]);
} ethd__merge;

/* Makes study.sqlite and its tables, in the place of those that are there; a failure leaves these. The caller has
   claimed the folder. *taps: how many there are. */
ETHD_MUST_CHECK ethd_status ethd__merge_write(const ethd__folder *folder, const ethd__merge *merge, uint64_t *taps,
                                              char message[ETHD_MESSAGE_MAX]);

#endif
