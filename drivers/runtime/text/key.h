/* A key with its value, as a file or a command gives it: one reader of numbers and words by the rows of a table, and the
   refusals. All [main]. */
#ifndef ETHD__TEXT_KEY_H
#define ETHD__TEXT_KEY_H

#include <stddef.h>

#include "ethd/param.h"
#include "text/ini.h"

typedef struct ethd__key {
  const char *file; /* NULL: a command sets it, not a file */
  int line;
  const char *section, *key, *value;
  char *message; /* of a refusal */
} ethd__key;

static inline ethd__key ethd__key_of(const char *file, const ethd_ini_key *k, char *message) {
  return (ethd__key){file, k->line, k->section, k->key, k->value, message};
}

/* Writes "file:line: section.key: ..." and returns `status`. */
ethd_status ethd__key_refuse(const ethd__key *key, ethd_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Writes "... found "value", ALLOWED is allowed" and returns `status`. */
ethd_status ethd__key_found(const ethd__key *key, ethd_status status, const char *allowed);

/* Appends a word to "a, b, c". */
void ethd__list_add(char list[ETHD_MESSAGE_MAX], const char *word);

/* Reads a number within the row's range (a whole one in decimal, or in hexadecimal with 0x), or the index of one of its
   words. "... found "value", MIN to MAX UNIT is allowed": ETHD_E_RANGE; not one of the words: ETHD_E_UNKNOWN. */
ETHD_MUST_CHECK ethd_status ethd__key_value(const ethd__key *key, const ethd_param *row, double *out);

/* ---- tables ---- */

/* A key that fills a member of a struct. */
typedef struct ethd__key_row {
  ethd_param param;    /* its default is NaN if the key must be given */
  size_t offset;       /* of an int32_t for words, of a uint32_t for a whole number, else of a double */
  const char *section; /* NULL: the table's section */
} ethd__key_row;

typedef struct ethd__key_file {
  const ethd_ini *ini;
  const char *name;
  char *message; /* of a refusal */
} ethd__key_file;

/* Refuses a key that the table doesn't have, in `section`, or in the whole file if it is NULL; `text`: one more key that
   is allowed, or NULL. */
ETHD_MUST_CHECK ethd_status ethd__keys_known(const ethd__key_file *file, const char *section, const ethd__key_row *rows,
                                             size_t count, const char *text);

/* Fills the members of the struct at `base` with the keys' values, or with their defaults. `line` is that of the
   section; 0: not known. */
ETHD_MUST_CHECK ethd_status ethd__keys_read(const ethd__key_file *file, const char *section, int line,
                                            const ethd__key_row *rows, size_t count, void *base);

#endif
