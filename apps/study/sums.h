/* SHA256SUMS of a study's folder: a line a file, "SUM  PATH", as sha256sum writes and checks it. All [main].

   What is written once, inputs and taps, keeps the sum that it got first, so that nothing which was changed later gets
   a new one; the store and the tables that follow from it get theirs anew each time. Left out: hidden files, what is
   unfinished (*.new, *.sqlite-journal), and the report. */
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

/* Writes the folder's SHA256SUMS, or brings it up to date. */
ETHD_MUST_CHECK ethd_status ethd__sums_write(const char *folder, char message[ETHD_MESSAGE_MAX]);

/* Compares every file with it; *files: how many. Refuses, in one sentence that names the first and says how many there
   are: files that differ, are missing, or aren't in it; and ETHD_STATUS_EMPTY, with a sentence, where the folder has no
   SHA256SUMS: its session never came to an end. */
ETHD_MUST_CHECK ethd_status ethd__sums_check(const char *folder, size_t *files, char message[ETHD_MESSAGE_MAX]);

/* Calls `each` for every file that the folder's SHA256SUMS lists, by path, until one fails. */
ETHD_MUST_CHECK ethd_status ethd__sums_each(const char *folder, ethd_status (*each)(void *user, const char *path),
                                            void *user, char message[ETHD_MESSAGE_MAX]);

/* Returns whether a file changes as a session goes on, as the store and the tables that follow from it do. [any] */
bool ethd__sums_grows(const char *path);

#endif
