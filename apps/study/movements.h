/* Finds files of recorded movements. [main] */
#ifndef ETHD__APPS_STUDY_MOVEMENTS_H
#define ETHD__APPS_STUDY_MOVEMENTS_H

#include "study/protocol.h"

/* Lists the file alone, or every *.csv of a folder by name; ethd__movements_free frees the list. */
ETHD_MUST_CHECK ethd_status ethd__movements_list(const char *path, char ***files, size_t *count,
                                                 char message[ETHD_MESSAGE_MAX]);

/* Lists those of `finger`, a file or a folder; if it is NULL, those of the protocol's folder, which is an absolute path
   or one within ethd__motion_folder. */
ETHD_MUST_CHECK ethd_status ethd__movements_find(const ethd__protocol *protocol, const char *finger, char ***files,
                                                 size_t *count, char message[ETHD_MESSAGE_MAX]);
void ethd__movements_free(char **files, size_t count);

#endif
