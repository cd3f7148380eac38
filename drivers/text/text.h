/* Whole files of text, in and out, and numbers in them. All [main] but ethd__number [any]. */
#ifndef ETHD_FILE_TEXT_H
#define ETHD_FILE_TEXT_H

#include <stdbool.h>
#include <stdio.h>

#include "ethd/config.h"

/* The whole file, with a 0 behind it; freed by the caller. Refuses what is missing, a folder, or over
   `most` bytes. 0 bytes within pass: callers decide. */
ETHD_MUST_CHECK ethd_status ethd_text_read(const char *path, size_t most, char **text, size_t *length,
                                           char message[ETHD_MESSAGE_MAX]);

/* Replaces or makes the file at once: a reader sees the old one or the new one. */
ETHD_MUST_CHECK ethd_status ethd_text_write(const char *path, const char *text, size_t length,
                                            char message[ETHD_MESSAGE_MAX]);

/* A file that takes its path's place when it is complete. Written beside it; straight to it when the
   path names a device or pipe. */
typedef struct ethd_replace {
  FILE *file;
  char *path, *temporary; /* temporary NULL: written in place */
} ethd_replace;

ETHD_MUST_CHECK ethd_status ethd_replace_begin(const char *path, ethd_replace *out, char message[ETHD_MESSAGE_MAX]);
/* Any failed write so far is reported here; the old file then stays. */
ETHD_MUST_CHECK ethd_status ethd_replace_commit(ethd_replace *replace, char message[ETHD_MESSAGE_MAX]);
void ethd_replace_abandon(ethd_replace *replace);

/* [+-] digits [. digits] [e [+-] digits], "inf", "+inf", "-inf" or "nan", and nothing else; a number too
   large for a double is refused. text[length] must be readable and no part of a number. */
bool ethd__number(const char *text, size_t length, double *out);

/* The end of the decimal number without a sign at p; NULL: there is none. */
const char *ethd__decimal(const char *p, const char *end);

/* folder/path, or path when it is absolute or folder is NULL or ""; NULL: no memory. */
char *ethd__path_join(const char *folder, const char *path);

/* The part of a path before its last '/', "." without one; NULL: no memory. */
char *ethd__path_folder(const char *path);

#endif
