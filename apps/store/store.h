/* A study's file, study.sqlite in its folder: the session's events, one transaction each. All [main].

     study    the hash of the study's inputs       tap      the figures of a tap
     hand     who leads the hand                   answer   to a question, as it stands now
     event    whatever isn't a tap                 survey   the answers of a block were confirmed

   An event of an attempt says that the experimenter accepted or rejected that tap.

   Participants, blocks, attempts and questions count from 1, points of a grid from 0. The inputs' data (strategy,
   speed, gains) aren't stored again. SQLite's rollback journal makes each transaction whole and puts it on the disk
   before the next step: mode DELETE, synchronous FULL. One program writes at a time. The file must be on a local disk,
   because a network file system may neither lock nor sync. */
#ifndef ETHD__APPS_STORE_STORE_H
#define ETHD__APPS_STORE_STORE_H

#include <sqlite3.h>
#include <stdbool.h>

#include "ethd/config.h"

#define ETHD_STUDY_STORE "study.sqlite"

typedef struct ethd__study_store {
  sqlite3 *db; /* NULL: none is open */
  char *path;
  int64_t until; /* ns: time limit for reading a received file; 0: none */
} ethd__study_store;

#define ETHD_STORE_NONE ((ethd__study_store){NULL, NULL, 0})
#define ETHD_STORE_MEMORY ":memory:" /* a path: of a store without a file */

/* Opens a store to write into it, and locks it against other programs; refuses one with other inputs than
   `hash`. If there is none, or one without rows, it begins one with this hash. */
ETHD_MUST_CHECK ethd_status ethd__store_open(const char *path, const char *hash, ethd__study_store *out,
                                             char message[ETHD_MESSAGE_MAX]);

/* Opens any maker's store to read it: nothing is written or run, and no link is followed. Refuses a store that a
   program is writing, or whose last transaction was cut short. */
ETHD_MUST_CHECK ethd_status ethd__store_read(const char *path, const char *hash, ethd__study_store *out,
                                             char message[ETHD_MESSAGE_MAX]);

/* Closes the store, if one is open. */
void ethd__store_close(ethd__study_store *store);

/* Prepares a statement, to which the caller binds values; ethd__store_end reports a failure. */
sqlite3_stmt *ethd__store_query(ethd__study_store *store, const char *sql);

/* Goes to the next row; false: there is none, or a failure, which ethd__store_end reports. */
bool ethd__store_next(sqlite3_stmt *query);

/* Ends a statement; NULL is allowed. Its failure leaves the store as it was before. */
ETHD_MUST_CHECK ethd_status ethd__store_end(ethd__study_store *store, sqlite3_stmt *query,
                                            char message[ETHD_MESSAGE_MAX]);

/* Runs a statement to its end, and ends it. */
ETHD_MUST_CHECK ethd_status ethd__store_run(ethd__study_store *store, sqlite3_stmt *query,
                                            char message[ETHD_MESSAGE_MAX]);

/* Runs statements without values, such as "BEGIN". */
ETHD_MUST_CHECK ethd_status ethd__store_do(ethd__study_store *store, const char *sql, char message[ETHD_MESSAGE_MAX]);

/* Returns a text cell; "" for NULL. It is valid until the next row. */
const char *ethd__store_text(sqlite3_stmt *query, int column);

/* Adds all taps, answers, confirmations, events and hands of another store, which must be readable, after this store's.
   Refuses a tap that is in both. */
ETHD_MUST_CHECK ethd_status ethd__store_add(ethd__study_store *store, const char *path, char message[ETHD_MESSAGE_MAX]);

#endif
