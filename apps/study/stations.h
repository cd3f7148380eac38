/* Several stations of one study: sessions in folders of their own, of different participants. All [main].

   Stores are merged; a merged folder is a session's folder like any other, and its tables follow from its store.
   Stations may differ in the source of the hand, which is stored with each tap and participant. */
#ifndef ETHD__APPS_STUDY_STATIONS_H
#define ETHD__APPS_STUDY_STATIONS_H

#include <stddef.h>

#include "study/columns.h"

#define ETHD_STUDY_STATIONS 1000 /* largest number in a merge or report */

/* Checks that these folders belong to one study, that no participant tapped in two of them, and that their files agree
   with SHA256SUMS; refuses with a sentence that names the folder. */
ETHD_MUST_CHECK ethd_status ethd__stations_fit(const char *const *folders, size_t count,
                                               char message[ETHD_MESSAGE_MAX]);

/* Gives the text of the tables that a merged folder would hold, which the caller frees; NULL for tables without a
   source in the stores. The folders must fit. */
ETHD_MUST_CHECK ethd_status ethd__stations_tables(const char *const *folders, size_t count, char *out[ETHD_TABLES],
                                                  char message[ETHD_MESSAGE_MAX]);

/* Makes folder `out`, which must be missing or empty, from these: inputs, taps, store, tables, SHA256SUMS. The folders
   fit, and are only read. *taps: their number. */
ETHD_MUST_CHECK ethd_status ethd__stations_merge(const char *const *folders, size_t count, const char *out,
                                                 uint64_t *taps, char message[ETHD_MESSAGE_MAX]);

#endif
