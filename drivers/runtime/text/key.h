/* A key with its value, as a file or a command gives it: one reader of numbers and words by the row of a table, and the
   refusals. All [main]. */
#ifndef ETHD__TEXT_KEY_H
#define ETHD__TEXT_KEY_H

#include <stdbool.h>

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
/* Writes "... found "value", MIN to MAX UNIT is allowed" and returns ETHD_E_RANGE. */
ethd_status ethd__key_range(const ethd__key *key, const ethd_param *row, bool whole);

/* Reads a number within the row's range, or the index of one of its words; refuses everything else. */
ETHD_MUST_CHECK ethd_status ethd__key_value(const ethd__key *key, const ethd_param *row, bool whole, double *out);

#endif
