/* Tables of one study that stand in several folders, a station's each. All [main]. */
#ifndef ETHD_REPORT_GATHER_H
#define ETHD_REPORT_GATHER_H

#include "report/sheet.h"

typedef struct ethd__stations {
  const char *const *folder;
  size_t count;
} ethd__stations;

/* folder/name of all that have it, one under the other; `out` is empty (columns 0) where none has. Refuses tables whose
   headers differ. */
ETHD_MUST_CHECK ethd_status ethd__gather(const ethd__stations *stations, const char *name, ethd__sheet *out,
                                         char message[ETHD_MESSAGE_MAX]);

/* Refuses a participant who stands in that table of two folders. */
ETHD_MUST_CHECK ethd_status ethd__gather_check(const ethd__stations *stations, const char *name,
                                               char message[ETHD_MESSAGE_MAX]);

#endif
