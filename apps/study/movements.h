/* Files of recorded movements. [main] */
#ifndef ETHD_STUDY_MOVEMENTS_H
#define ETHD_STUDY_MOVEMENTS_H

#include "study/protocol.h"

/* `finger` alone, or every *.csv of the protocol's folder by name: an absolute path, or one within
   ethd__motion_folder. Freed by the caller, each and all. */
ETHD_MUST_CHECK ethd_status ethd__movements_find(const ethd__protocol *protocol, const char *finger, char ***files,
                                                 size_t *count, char message[ETHD_MESSAGE_MAX]);

#endif
