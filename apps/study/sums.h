/* SHA256SUMS of a study's folder: a line a file, "SUM  PATH", as sha256sum writes and checks it. All [main].

   Inputs and taps are written once and keep their first sum, so that a later change doesn't get a new one. The store
   and the tables from it get a new sum each time. Left out: hidden files, unfinished files (*.new, *.sqlite-journal),
   and the report. */
#ifndef ETHD__APPS_STUDY_SUMS_H
#define ETHD__APPS_STUDY_SUMS_H

#include <stdbool.h>
#include <stddef.h>

#include "ethd/config.h"
#include "text/sha256.h"

#define ETHD_STUDY_SUMS "SHA256SUMS"

/* Gives the sum of a file's bytes. */
ETHD_MUST_CHECK ethd_status ethd__sum_of_file(const char *path, char out[ETHD_SHA256_TEXT],
                                              char message[ETHD_MESSAGE_MAX]);

/* Writes or updates the folder's SHA256SUMS. */
ETHD_MUST_CHECK ethd_status ethd__sums_write(const char *folder, char message[ETHD_MESSAGE_MAX]);

/* Compares every file with it; *files: their number. Refuses files that differ, are missing or unlisted, in one
   sentence with the first one's name and their number; ETHD_STATUS_EMPTY, with a sentence: the folder has no
   SHA256SUMS, its session never ended. */
ETHD_MUST_CHECK ethd_status ethd__sums_check(const char *folder, size_t *files, char message[ETHD_MESSAGE_MAX]);

/* Calls `each` for every file that the folder's SHA256SUMS lists, by path, until one fails. */
ETHD_MUST_CHECK ethd_status ethd__sums_each(const char *folder, ethd_status (*each)(void *user, const char *path),
                                            void *user, char message[ETHD_MESSAGE_MAX]);

/* Returns whether a file changes during a session, as the store and the tables from it do. [any] */
bool ethd__sums_grows(const char *path);

#endif
