/* INI files: a strict layer above inih. What inih would cut, join or skip is an error here.

     [section]
     key = value      ; a comment        # and ; start comment lines, " ;" ends a line, but in a section of prose

   All [main]. */
#ifndef ETHD__TEXT_INI_H
#define ETHD__TEXT_INI_H

#include "ethd/config.h"

#define ETHD_INI_BYTES_MAX ((size_t)1 << 20)
#define ETHD_INI_KEYS_MAX 512u
#define ETHD_INI_SECTIONS_MAX 512u

typedef struct ethd_ini_key {
  char *section, *key, *value; /* none is empty */
  int line;
} ethd_ini_key;

typedef struct ethd_ini_section {
  char *name;
  int line;
} ethd_ini_section;

typedef struct ethd_ini {
  ethd_ini_key *keys;         /* in the order of the file */
  ethd_ini_section *sections; /* in the order of the file, with those that have no keys */
  uint32_t count, section_count;
} ethd_ini;

/* Parses text that messages call `name`. `repeats`: a "section.key" that may occur more than once, or
   NULL. `prose`: sections, " a b ", whose values are text for people: they go on to the end of the line, however long it
   is; NULL: none. Refuses, with file:line: bytes that aren't text, lines over 197 characters (without their comments),
   text after a section's ']', keys before the first section, keys without '=', empty values, a key that
   occurs twice, over 512 keys or sections. A section may be continued later. */
ETHD_MUST_CHECK ethd_status ethd_ini_parse(const char *text, size_t length, const char *name, const char *repeats,
                                           const char *prose, ethd_ini *out, char message[ETHD_MESSAGE_MAX]);

/* Returns the key's entry, NULL if the file doesn't have it. */
const ethd_ini_key *ethd_ini_find(const ethd_ini *ini, const char *section, const char *key);

void ethd_ini_free(ethd_ini *ini);

#endif
