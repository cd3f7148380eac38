/* Reads the keys of a study file, one at a time. */
#ifndef ETHD__APPS_STUDY_PROTOCOL_KEYS_H
#define ETHD__APPS_STUDY_PROTOCOL_KEYS_H

#include "study/protocol.h"
#include "text/ini.h"

/* The present key. */
typedef struct ethd__entry {
  const char *file;
  const ethd_ini_key *key;
  ethd__protocol *out;
  char *message;
} ethd__entry;

/* Writes "file:line: section.key: ..." and returns `status`. */
ethd_status ethd__entry_refuse(const ethd__entry *e, ethd_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

ETHD_MUST_CHECK ethd_status ethd__entry_set(const ethd__entry *e);

/* Returns whether study files have this section. */
bool ethd__entry_section(const char *section);

/* Gives the word's index, and adds a missing word; false: no room for it. */
bool ethd__word_list_put(ethd__word_list *words, const char *word, size_t *index);

void ethd__word_list_free(ethd__word_list *words);

#endif
