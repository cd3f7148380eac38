/* Several stations of one study: sessions in folders of their own, of different participants. All [main].

   What is merged is the journals; a merged folder is a session's folder like any other, and its tables follow from its
   journal. Stations may differ in whose hand tapped: it stands at each tap and participant. */
#ifndef ETHD_STUDY_STATIONS_H
#define ETHD_STUDY_STATIONS_H

#include <stddef.h>

#include "ethd/config.h"

/* Whether these folders are one study's and no participant tapped in two; refuses with a sentence that names the folder. */
ETHD_MUST_CHECK ethd_status ethd__stations_fit(const char *const *folders, size_t count,
                                               char message[ETHD_MESSAGE_MAX]);

/* Makes folder `out`, which must not be there or be empty, of these: inputs, taps, journal, tables, SHA256SUMS. What
   stands in the folders is checked by their SHA256SUMS first, and read only. *taps: how many. */
ETHD_MUST_CHECK ethd_status ethd__stations_merge(const char *const *folders, size_t count, const char *out,
                                                 size_t *taps, char message[ETHD_MESSAGE_MAX]);

#endif
