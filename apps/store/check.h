/* Checks a store, since somebody else may have made it: as a file before SQLite opens it, and as tables before their
   contents are used. All [main]. */
#ifndef ETHD__APPS_STORE_CHECK_H
#define ETHD__APPS_STORE_CHECK_H

#include "store/store.h"

typedef struct ethd__store_file {
  bool there;
  int64_t size; /* bytes */
  bool cut;     /* its last transaction was cut short, and is rolled back when the store is opened to write */
} ethd__store_file;

/* Checks a file. Refuses a link, a pipe and the like, a file with a hole, a file for which SQLite would read a log or
   another journal, and a file that is open in another program. */
ETHD_MUST_CHECK ethd_status ethd__store_look(const char *path, ethd__store_file *out, char message[ETHD_MESSAGE_MAX]);

/* Refuses an open store whose mark, tables, rows or hash aren't those of this study. */
ETHD_MUST_CHECK ethd_status ethd__store_check(ethd__study_store *store, const char *hash,
                                              char message[ETHD_MESSAGE_MAX]);

/* Gives the first column of the first row as text, freed by the caller; NULL: none, or no memory. */
ETHD_MUST_CHECK ethd_status ethd__store_first(ethd__study_store *store, const char *sql, char **out,
                                              char message[ETHD_MESSAGE_MAX]);

#endif
