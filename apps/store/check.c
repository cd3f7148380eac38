#include "store/check.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "store/schema.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

#define JOURNAL "-journal" /* after the file's name: SQLite's own, during a transaction */

/* ---- a file ---- */

/* Returns the holder of SQLite's lock on the file; 0: none; -1: on another machine. */
static pid_t holder(int fd) {
  /* sqlite.org/fileformat2.html, the lock-byte page: bytes 2^30 to 2^30 + 511 */
  struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = 1 << 30, .l_len = 512};
  if (fcntl(fd, F_GETLK, &lock) || lock.l_type == F_UNLCK) return 0;
  return lock.l_pid ? lock.l_pid : -1;
}

static ethd_status say_held(const char *path, pid_t pid, char *message) {
  char comm[64], name[32] = "another program";
  snprintf(comm, sizeof comm, "/proc/%d/comm", (int)pid);
  FILE *file = pid > 0 ? fopen(comm, "r") : NULL;
  if (file && fgets(name, sizeof name, file)) name[strcspn(name, "\n")] = 0;
  if (file) fclose(file);
  if (pid < 0) return ethd__say(message, ETHD_E_ARGUMENT, "%s: a program of another machine is at work in it", path);
  return ethd__say(message, ETHD_E_ARGUMENT, "%s: %s, process %d, is at work in it", path, name, (int)pid);
}

/* SQLite follows a journal that names another journal: it reads and removes that file. None of ours does. */
static ethd_status look_at_journal(const char *path, bool *cut, char *message) {
  static const unsigned char names[] = {0xd9, 0xd5, 0x05, 0xf9, 0x20, 0xa1, 0x63, 0xd7}; /* of another one before it */
  unsigned char end[sizeof names];
  struct stat info;
  char journal[PATH_MAX + sizeof JOURNAL];
  snprintf(journal, sizeof journal, "%s" JOURNAL, path);
  *cut = false;
  if (ethd__file_look_at(journal, &info)) return ETHD_OK;
  int fd = ethd__file_read(journal, &info, message);
  if (fd < 0) return ETHD_E_FILE;
  *cut = info.st_size > 0;
  bool odd = info.st_size >= (off_t)sizeof end &&
             pread(fd, end, sizeof end, info.st_size - (off_t)sizeof end) == (ssize_t)sizeof end &&
             !memcmp(end, names, sizeof end);
  close(fd);
  return odd ? ethd__say(message, ETHD_E_SYNTAX, "%s: isn't of a study's file; remove both", journal) : ETHD_OK;
}

/* Where SQLite's format says that a log (-wal) belongs to the file, which none of ours has. */
static bool has_log(int fd) {
  unsigned char version[2];
  return pread(fd, version, sizeof version, 18) == (ssize_t)sizeof version && (version[0] > 1 || version[1] > 1);
}

static bool is_there(const char *path) {
  struct stat info;
  return ethd__file_look_at(path, &info) == 0;
}

ethd_status ethd__store_look(const char *path, ethd__store_file *out, char message[ETHD_MESSAGE_MAX]) {
  struct stat info;
  *out = (ethd__store_file){.there = is_there(path)};
  if (!out->there) return ETHD_OK;
  int fd = ethd__file_read(path, &info, message);
  if (fd < 0) return ETHD_E_FILE;
  pid_t pid = holder(fd);
  bool hole = ethd__file_has_hole(fd, info.st_size), odd = !S_ISREG(info.st_mode) || has_log(fd);
  close(fd);
  out->size = info.st_size;
  if (pid) return say_held(path, pid, message);
  if (odd) return ethd__say(message, ETHD_E_SYNTAX, "%s: isn't a study's file", path);
  if (hole) return ethd__say(message, ETHD_E_SYNTAX, "%s: has a hole; restore the file from a copy", path);
  return look_at_journal(path, &out->cut, message);
}

/* ---- tables ---- */

ethd_status ethd__store_first(ethd__study_store *s, const char *sql, char **out, char message[ETHD_MESSAGE_MAX]) {
  sqlite3_stmt *query = ethd__store_query(s, sql);
  *out = ethd__store_next(query) ? strdup(ethd__store_text(query, 0)) : NULL;
  return ethd__store_end(s, query, message);
}

/* The file's tables, indices and the like must be ours, to the letter. */
static ethd_status check_schema(ethd__study_store *s, char *message) {
  ETHD__FREED char *mark = NULL, *version = NULL, *text = NULL;
  char ours[32];
  snprintf(ours, sizeof ours, "%d", ETHD_STORE_APPLICATION);
  ethd_status status = ethd__store_first(s, "PRAGMA application_id", &mark, message);
  if (!status && (!mark || strcmp(mark, ours)))
    status = ethd__say(message, ETHD_E_SYNTAX, "%s: isn't a study's file", s->path);
  if (status) return status;
  status = ethd__store_first(s, "PRAGMA user_version", &version, message);
  if (!status && (!version || atoi(version) != ETHD_STORE_VERSION))
    status =
        ethd__say(message, ETHD_E_SYNTAX,
                  "%s: of version %.20s, this program reads %d: the tables (taps.csv and so on) can be read, and a new "
                  "folder is needed to go on",
                  s->path, version ? version : "?", ETHD_STORE_VERSION);
  if (!status)
    status = ethd__store_first(
        s,
        "SELECT group_concat(coalesce(sql, '') || ';', char(10)) FROM (SELECT sql FROM sqlite_schema ORDER BY rowid)",
        &text, message);
  if (!status && (!text || strcmp(text, ethd__schema)))
    status = ethd__say(message, ETHD_E_SYNTAX, "%s: its tables aren't those of a study", s->path);
  return status;
}

/* Uses integrity_check, because quick_check doesn't compare an index with its table.
   It takes no argument: SQLite 3.46 reads the 1 of pragma_integrity_check(1) as the name of a table. */
static ethd_status check_content(ethd__study_store *s, char *message) {
  static const char *const queries[] = {
      "SELECT integrity_check FROM pragma_integrity_check WHERE integrity_check <> 'ok'",
      "SELECT 'a tap of no hand' FROM pragma_foreign_key_check",
      "SELECT 'a hand' FROM hand WHERE coalesce(" ETHD_STORE_HAND_RULE ", 0) = 0",
      "SELECT 'tap ' || id FROM tap WHERE coalesce(" ETHD_STORE_TAP_RULE ", 0) = 0",
  };
  ethd_status status = ETHD_OK;
  for (size_t i = 0; !status && i < sizeof queries / sizeof *queries; i++) {
    ETHD__FREED char *found = NULL;
    status = ethd__store_first(s, queries[i], &found, message);
    if (!status && found)
      status = ethd__say(message, ETHD_E_SYNTAX, "%s: is damaged: %.80s; restore the file from a copy", s->path, found);
  }
  return status;
}

static ethd_status check_hash(ethd__study_store *s, const char *hash, char *message) {
  ETHD__FREED char *begun = NULL;
  ethd_status status = ethd__store_first(s, "SELECT group_concat(hash) FROM study", &begun, message);
  if (!status && (!begun || strcmp(begun, hash)))
    status = ethd__say(
        message, ETHD_E_SYNTAX,
        "%s: begun with other files than study.ini, config.ini, scene.scene, device.plant, conditions and movements "
        "of now; put them back",
        s->path);
  return status;
}

ethd_status ethd__store_check(ethd__study_store *s, const char *hash, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = check_schema(s, message);
  if (!status) status = check_content(s, message);
  if (!status) status = check_hash(s, hash, message);
  return status;
}
