/* Finds files of recorded movements. [main] */
#ifndef ETHD__APPS_STUDY_MOVEMENTS_H
#define ETHD__APPS_STUDY_MOVEMENTS_H

#include "study/protocol.h"
#include "tap/placement.h"

/* Lists the files of `finger`, as ethd__movements_list does; if it is NULL, the files of the protocol's folder, which
   is an absolute path or one within ethd__motion_folder. */
ETHD_MUST_CHECK ethd_status ethd__movements_find(const ethd__protocol *protocol, const char *finger, char ***files,
                                                 size_t *count, char message[ETHD_MESSAGE_MAX]);

#endif
