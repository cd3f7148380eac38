#include "store/store.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "clock.h"
#include "store/check.h"
#include "store/schema.h"
#include "text/error_text.h"
#include "text/text.h"

#define READ_ONLY "?mode=ro&immutable=1" /* no lock, no journal: nothing is written, for any contents */
#define CELL_MAX (1 << 24)               /* bytes of a cell, or of a statement in the file */
#define PATIENCE 5 /* s: time limit for reading a received file, plus one for each PATIENCE_BYTES */
#define PATIENCE_BYTES 10000000
#define BEAT 10000 /* steps of SQLite between two readings of the clock */

/* ---- failures ---- */

static ethd_status status_of(int code) {
  switch (code & 0xff) {
  case SQLITE_NOMEM: return ETHD_E_MEMORY;
  case SQLITE_FULL:
  case SQLITE_IOERR:
  case SQLITE_BUSY:
  case SQLITE_CANTOPEN:
  case SQLITE_READONLY: return ETHD_E_FILE;
  default: return ETHD_E_SYNTAX;
  }
}

/* For a full disk SQLite keeps no reason of the system's, and for other failures of the disk it may lose it; errno, which
   is 0 before a statement, still has it. */
static const char *why(sqlite3 *db, int code) {
  int reason = sqlite3_system_errno(db) ? sqlite3_system_errno(db) : errno;
  if ((code & 0xff) == SQLITE_FULL) return strerror(ENOSPC);
  if ((code & 0xff) == SQLITE_BUSY) return "another program is at work in it";
  if ((code & 0xff) == SQLITE_INTERRUPT) return "takes too long to read for a study of its size";
  if (((code & 0xff) == SQLITE_IOERR || (code & 0xff) == SQLITE_CANTOPEN) && reason) return strerror(reason);
  return sqlite3_errmsg(db);
}

static ethd_status refuse(const ethd__study_store *s, int code, char *message) {
  return ethd__say(message, status_of(code), "%s: %s", s->path, why(s->db, code));
}

/* ---- statements ---- */

sqlite3_stmt *ethd__store_query(ethd__study_store *s, const char *sql) {
  sqlite3_stmt *query = NULL;
  errno = 0;
  (void)sqlite3_prepare_v2(s->db, sql, -1, &query, NULL);
  return query;
}

bool ethd__store_next(sqlite3_stmt *query) { return query && sqlite3_step(query) == SQLITE_ROW; }

ethd_status ethd__store_end(ethd__study_store *s, sqlite3_stmt *query, char message[ETHD_MESSAGE_MAX]) {
  int code = query ? sqlite3_finalize(query) : sqlite3_errcode(s->db);
  return code ? refuse(s, code, message) : ETHD_OK;
}

ethd_status ethd__store_run(ethd__study_store *s, sqlite3_stmt *query, char message[ETHD_MESSAGE_MAX]) {
  while (ethd__store_next(query)) continue;
  return ethd__store_end(s, query, message);
}

ethd_status ethd__store_do(ethd__study_store *s, const char *sql, char message[ETHD_MESSAGE_MAX]) {
  errno = 0;
  int code = sqlite3_exec(s->db, sql, NULL, NULL, NULL);
  return code ? refuse(s, code, message) : ETHD_OK;
}

const char *ethd__store_text(sqlite3_stmt *query, int column) {
  const char *text = (const char *)sqlite3_column_text(query, column);
  return text ? text : "";
}

/* ---- a limit of time ---- */

static void limit(ethd__study_store *s, int64_t size) {
  s->until = ethd__clock_now() + (PATIENCE + size / PATIENCE_BYTES) * 1000000000;
}

static int is_late(void *self) {
  const ethd__study_store *s = self;
  return s->until && ethd__clock_now() > s->until;
}

/* ---- opening ---- */

static void put_path(FILE *file, const char *path) {
  for (; *path; path++) fprintf(file, strchr("%?#", *path) ? "%%%02x" : "%c", (unsigned char)*path);
}

/* Returns the path as a URI. Links in the folders before it, which the user may have, are followed here, because SQLite
   refuses any. NULL: there is no such folder, or no memory. */
static char *uri_of(const char *path, const char *query) {
  ETHD__FREED char *folder = ethd__path_folder(path), *real = folder ? realpath(folder, NULL) : NULL;
  char *uri = NULL;
  const char *name = strrchr(path, '/');
  if (real) {
    ethd__printed text;
    FILE *file = ethd__print_begin(&text);
    fputs("file:", file);
    put_path(file, real);
    putc('/', file);
    put_path(file, name ? name + 1 : path);
    fputs(query, file);
    uri = ethd__print_end(&text);
  }
  return uri;
}

/* Rules for every connection: nothing in a file is run, believed or followed. */
static ethd_status guard(ethd__study_store *s, char *message) {
  sqlite3_limit(s->db, SQLITE_LIMIT_LENGTH, CELL_MAX);
  sqlite3_db_config(s->db, SQLITE_DBCONFIG_DEFENSIVE, 1, NULL);
  sqlite3_db_config(s->db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, NULL);
  sqlite3_db_config(s->db, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, NULL);
  sqlite3_progress_handler(s->db, BEAT, is_late, s);
  return ethd__store_do(s, "PRAGMA cell_size_check = ON; PRAGMA foreign_keys = ON", message);
}

static ethd_status connect(const char *path, const char *query, int flags, ethd__study_store *out, char *message) {
  *out = (ethd__study_store){.path = strdup(path)};
  ETHD__FREED char *uri = strcmp(path, ETHD_STORE_MEMORY) ? uri_of(path, query) : strdup(path);
  if (!out->path || !uri) {
    ethd_status status = ethd__say(message, ETHD_E_FILE, "%s: %s", path, strerror(errno));
    ethd__store_close(out);
    return status;
  }
  int code =
      sqlite3_open_v2(uri, &out->db, flags | SQLITE_OPEN_URI | SQLITE_OPEN_NOFOLLOW | SQLITE_OPEN_EXRESCODE, NULL);
  ethd_status status = code ? refuse(out, code, message) : guard(out, message);
  if (status) ethd__store_close(out);
  return status;
}

void ethd__store_close(ethd__study_store *s) {
  sqlite3_close(s->db);
  free(s->path);
  *s = ETHD_STORE_NONE;
}

/* ---- to write ---- */

/* Begins an empty store in one transaction. */
static ethd_status begin(ethd__study_store *s, const char *hash, char *message) {
  char marks[96];
  snprintf(marks, sizeof marks, "PRAGMA application_id = %d; PRAGMA user_version = %d", ETHD_STORE_APPLICATION,
           ETHD_STORE_VERSION);
  ethd_status status = ethd__store_do(s, ethd__schema, message);
  if (!status) status = ethd__store_do(s, marks, message);
  sqlite3_stmt *query = status ? NULL : ethd__store_query(s, "INSERT INTO study VALUES (?)");
  if (status) return status;
  sqlite3_bind_text(query, 1, hash, -1, SQLITE_STATIC);
  return ethd__store_run(s, query, message);
}

/* Takes the lock, which lasts until the store is closed, and rolls back an unfinished transaction. */
static ethd_status prepare(ethd__study_store *s, const char *hash, char *message) {
  static const char settings[] = "PRAGMA locking_mode = EXCLUSIVE; PRAGMA journal_mode = DELETE;"
                                 "PRAGMA journal_size_limit = 0; PRAGMA synchronous = FULL; BEGIN EXCLUSIVE";
  ETHD__FREED char *tables = NULL;
  ethd_status status = ethd__store_do(s, settings, message);
  if (!status) status = ethd__store_first(s, "SELECT max(rowid) FROM sqlite_schema", &tables, message);
  if (!status) status = tables && *tables ? ethd__store_check(s, hash, message) : begin(s, hash, message);
  return status ? status : ethd__store_do(s, "COMMIT", message);
}

ethd_status ethd__store_open(const char *path, const char *hash, ethd__study_store *out,
                             char message[ETHD_MESSAGE_MAX]) {
  ethd__store_file file = {0};
  *out = ETHD_STORE_NONE;
  ethd_status status = strcmp(path, ETHD_STORE_MEMORY) ? ethd__store_look(path, &file, message) : ETHD_OK;
  if (!status) status = connect(path, "", SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, out, message);
  if (status) return status;
  limit(out, file.size);
  status = prepare(out, hash, message);
  out->until = 0;
  if (status) ethd__store_close(out);
  return status;
}

/* ---- to read ---- */

ethd_status ethd__store_read(const char *path, const char *hash, ethd__study_store *out,
                             char message[ETHD_MESSAGE_MAX]) {
  ethd__store_file file;
  *out = ETHD_STORE_NONE;
  ethd_status status = ethd__store_look(path, &file, message);
  if (!status && !file.there) status = ethd__say(message, ETHD_E_FILE, "%s: %s", path, strerror(ENOENT));
  if (!status && file.cut)
    status =
        ethd__say(message, ETHD_E_SYNTAX, "%s: its last change was cut short; ethd-study --resume completes it", path);
  if (!status) status = connect(path, READ_ONLY, SQLITE_OPEN_READONLY, out, message);
  if (status) return status;
  limit(out, file.size);
  status = ethd__store_do(out, "PRAGMA query_only = ON", message);
  if (!status) status = ethd__store_check(out, hash, message);
  if (status) ethd__store_close(out);
  return status;
}

/* ---- several into one ---- */

ethd_status ethd__store_add(ethd__study_store *s, const char *path, char message[ETHD_MESSAGE_MAX]) {
  static const char insert[] =
      "BEGIN; INSERT OR IGNORE INTO hand SELECT word FROM part.hand;"
      "INSERT INTO tap (" ETHD_STORE_TAP ") SELECT " ETHD_STORE_TAP " FROM part.tap ORDER BY id;"
      "INSERT INTO answer SELECT * FROM part.answer;"
      "INSERT INTO survey (participant, block) SELECT participant, block FROM part.survey ORDER BY id;"
      "INSERT INTO event (utc, participant, block, attempt, event, detail) SELECT utc, participant, block, attempt, "
      "event, "
      "detail FROM part.event ORDER BY id; COMMIT";
  ETHD__FREED char *uri = uri_of(path, READ_ONLY);
  char unsaid[ETHD_MESSAGE_MAX];
  sqlite3_stmt *query = ethd__store_query(s, "ATTACH ? AS part");
  sqlite3_bind_text(query, 1, uri, -1, SQLITE_STATIC);
  ethd_status status = uri ? ethd__store_run(s, query, message) : ethd__no_memory(message, path);
  if (status) return status;
  status = ethd__store_do(s, insert, message);
  if (status) (void)!ethd__store_do(s, "ROLLBACK", unsaid);
  ethd_status detached = ethd__store_do(s, "DETACH part", unsaid);
  return status ? status : detached ? ethd__say(message, detached, "%s", unsaid) : ETHD_OK;
}
