/* Reads and writes whole files of text, and reads numbers in them. All [main] except ethd__number, which is [any]. */
#ifndef ETHD__TEXT_TEXT_H
#define ETHD__TEXT_TEXT_H

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "ethd/config.h"
#include "text/freed.h"

/* Returns what stands behind a noun after its number: "" for 1, else "s". [any] */
static inline const char *ethd__s(uint64_t count) { return count == 1 ? "" : "s"; }

/* Reads a whole file, skips a byte order mark of UTF-8, and appends a 0; the caller frees it. Refuses a file that is
   missing, a folder, a device, or over `most` bytes; a pipe may have 1 GiB at most, and a signal ends the wait for it.
   A file's holes take no memory. The text may have 0 bytes: callers decide. */
ETHD_MUST_CHECK ethd_status ethd_text_read(const char *path, size_t most, char **text, size_t *length,
                                           char message[ETHD_MESSAGE_MAX]);

/* Replaces or makes the file in one step: a reader sees the old one or the new one. */
ETHD_MUST_CHECK ethd_status ethd_text_write(const char *path, const char *text, size_t length,
                                            char message[ETHD_MESSAGE_MAX]);

/* A file that is written beside its path and takes the path's place when it is complete. Only a regular file, or
   nothing, is replaced: behind a link to one, the one that it leads to (not below a received folder, see text/file.h).
   A pipe, a terminal or another character device is written directly, and so is a descriptor that the program was
   started with, under the names /dev/stdout, /dev/stderr, /dev/fd/N and /proc/self/fd/N. All else is refused. */
typedef struct ethd_replace {
  FILE *file;
  char *path, *temporary; /* temporary NULL: it is written directly */
} ethd_replace;

ETHD_MUST_CHECK ethd_status ethd_replace_begin(const char *path, ethd_replace *out, char message[ETHD_MESSAGE_MAX]);
/* Puts the file in its place. If any write failed so far, reports that, and the old file stays. */
ETHD_MUST_CHECK ethd_status ethd_replace_commit(ethd_replace *replace, char message[ETHD_MESSAGE_MAX]);
void ethd_replace_abandon(ethd_replace *replace);

/* Reads [+-] digits [. digits] [e [+-] digits], "inf", "+inf", "-inf" or "nan", and nothing else; a number too
   large for a double is refused. text[length] must be readable and not part of a number. */
bool ethd__number(const char *text, size_t length, double *out);

/* Reads a whole number: decimal as above, or "0x" and 1 to 8 hexadecimal digits. */
bool ethd__whole(const char *text, size_t length, double *out);

/* Returns whether min <= value <= max. A NaN isn't, and raises no floating-point trap, as a plain comparison would.
   [any] */
static inline bool ethd__is_within(double value, double min, double max) {
  return isgreaterequal(value, min) && islessequal(value, max);
}

/* Return whether a plugin's text, which may be NULL or unterminated, has 1 to `most` characters: only characters of
   `letters`; one line of printable ASCII without control characters. */
bool ethd__text_is_word(const char *text, size_t most, const char *letters);
bool ethd__text_is_line(const char *text, size_t most);

/* The letter that the text begins with; its bytes, 0: this isn't UTF-8. [any] */
size_t ethd__letter_of(const char *text, uint32_t *out);

/* Returns the end of the decimal number without a sign at p, NULL if there is none. */
const char *ethd__decimal(const char *p, const char *end);

/* Returns folder/path, or path if it is absolute or folder is NULL or ""; NULL: no memory. */
char *ethd__path_join(const char *folder, const char *path);

/* Returns the part of a path before its last '/', "." if it has none; NULL: no memory. */
char *ethd__path_folder(const char *path);

#endif
