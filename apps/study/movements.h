/* Files of recorded movements. [main] */
#ifndef ETHD_STUDY_MOVEMENTS_H
#define ETHD_STUDY_MOVEMENTS_H

#include "study/protocol.h"

/* The file alone, or every *.csv of a folder by name. Freed by ethd__movements_free. */
ETHD_MUST_CHECK ethd_status ethd__movements_list(const char *path, char ***files, size_t *count,
                                                 char message[ETHD_MESSAGE_MAX]);

/* Those of `finger`, a file or a folder, or where it is NULL of the protocol's folder: an absolute path, or one within
   ethd__motion_folder. */
ETHD_MUST_CHECK ethd_status ethd__movements_find(const ethd__protocol *protocol, const char *finger, char ***files,
                                                 size_t *count, char message[ETHD_MESSAGE_MAX]);
void ethd__movements_free(char **files, size_t count);

#endif
