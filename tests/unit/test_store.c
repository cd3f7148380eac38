/* A study's file: what was put is there, once; another study's, a second writer's, a stranger's or a damaged one is
   refused in one line, and stays as it is. */
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "store/schema.h"
#include "study/keep.h"
#include "study/tables.h"
#include "text/file.h"
#include "text/text.h"
#include "unit/draw.h"
#include "unit/suite.h"

#define HASH "12ab"

static char folder[64], path[96], message[ETHD_MESSAGE_MAX];
static ethd__study_store store;
static ethd__folder study;

static void setup(void) {
  strcpy(folder, "/tmp/ethd-store-XXXXXX");
  ck_assert_ptr_nonnull(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/" ETHD_STUDY_STORE, folder);
  ck_assert_msg(!ethd__protocol_parse("", 0, "x.study", ".", &study.protocol, message), "%s", message);
  study.path = folder;
  strcpy(study.hash, HASH);
}

static void teardown(void) {
  char command[96];
  ethd__protocol_free(&study.protocol);
  snprintf(command, sizeof command, "rm -rf %s", folder);
  ck_assert_int_eq(system(command), 0);
}

static void done(ethd_status status) { ck_assert_msg(!status, "%s", message); }

static void refused(ethd_status status, const char *word) {
  ck_assert_msg(status < 0, "not refused: %s", message);
  ck_assert_msg(strstr(message, word) && !strpbrk(message, "\n\r\033"), "%s", message);
  ck_assert_ptr_null(store.db);
}

static void open_store(void) { done(ethd__store_open(path, HASH, &store, message)); }

static void run(const char *sql) { done(ethd__store_do(&store, sql, message)); }

static int64_t number(const char *sql) {
  sqlite3_stmt *row = ethd__store_query(&store, sql);
  int64_t found = ethd__store_next(row) ? sqlite3_column_int64(row, 0) : -1;
  done(ethd__store_end(&store, row, message));
  return found;
}

/* As a stranger would do it: with none of our guards. */
static void as_stranger(const char *sql) {
  sqlite3 *db;
  char *why = NULL;
  ck_assert_int_eq(sqlite3_open(path, &db), SQLITE_OK);
  ck_assert_msg(!sqlite3_exec(db, sql, NULL, NULL, &why), "%s: %s", sql, why);
  sqlite3_close(db);
}

/* ---- rows ---- */

static ethd__taken taken_of(uint32_t attempt, ethd__reason reason) {
  ethd__taken t = {.turn = {.attempt = attempt, .number = 2}, .seed = UINT64_MAX, .tap = 7, .hand = ETHD_HAND_MOUSE};
  ethd__metrics *m = &t.result.metrics;
  *m = (ethd__metrics){.reason = reason, .by_ring = reason, .by_finger = ETHD_TAP_DOUBLE, .eps = -0.0, .v_of = NAN};
  m->v_rvo = 0.1;
  t.movement = "a, \"b\".csv";
  strcpy(t.utc, "2026-01-02T03:04:05Z");
  return t;
}

static void put_tap(uint32_t attempt, ethd__reason reason) {
  const ethd__taken taken = taken_of(attempt, reason);
  done(ethd__tap_put(&store, 0, &taken, message));
}

static void begin(void) {
  open_store();
  run("INSERT INTO hand VALUES ('mouse')");
}

FIXTURE(setup, teardown)

/* Every bit of a figure comes back, the sign of zero too, and seeds of 64 bits. */
TEST(test_a_tap_comes_back) {
  char *text[ETHD_TABLES];
  begin();
  put_tap(1, ETHD_TAP_OK);
  ethd__store_close(&store);
  done(ethd__store_read(path, HASH, &store, message));
  done(ethd__tables_of(&study, &store, text, message));
  ck_assert_str_eq(strchr(text[ETHD_TABLE_TAPS], '\n') + 1,
                   "P01,2,test,1,offset,low,18446744073709551615,7,1,ok,0.10000000000000001,,0,0,0,-0,0,0,0,0,0,0,"
                   "0,0,0,mouse,\"a, \"\"b\"\".csv\",2026-01-02T03:04:05Z,ok,double,\n");
  for (int i = 0; i < ETHD_TABLES; i++) free(text[i]);
  ethd__store_close(&store);
}

TEST(test_every_word_may_be_put) {
  open_store();
  for (int i = 0; i < ETHD_HAND_SOURCES; i++) {
    sqlite3_stmt *insert = ethd__store_query(&store, "INSERT INTO hand VALUES (?)");
    sqlite3_bind_text(insert, 1, ethd__hand_words[i], -1, SQLITE_STATIC);
    done(ethd__store_run(&store, insert, message));
  }
  for (int i = 0; i < ETHD_TAP_REASON_COUNT; i++) put_tap((uint32_t)i + 1, (ethd__reason)i);
  ck_assert_int_eq(number("SELECT sum(valid) FROM tap"), 1);
  ethd__store_close(&store);
}

/* What the checks of the tables refuse leaves the store as it was. */
TEST(test_what_cannot_be_put) {
  static const char *const bad[] = {"INSERT INTO hand VALUES ('paw')", "UPDATE tap SET reason = 'odd'",
                                    "UPDATE tap SET valid = 0",        "UPDATE tap SET seed = '-1'",
                                    "UPDATE tap SET by_ring = ''",     "UPDATE tap SET hand = 'device'",
                                    "UPDATE tap SET attempt = NULL"};
  begin();
  put_tap(1, ETHD_TAP_OK);
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    ck_assert_int_eq(ethd__store_do(&store, bad[i], message), ETHD_E_SYNTAX);
    ck_assert_msg(strstr(message, "constraint failed"), "%s", message);
  }
  const ethd__taken again = taken_of(1, ETHD_TAP_OK);
  ck_assert_int_eq(ethd__tap_put(&store, 0, &again, message), ETHD_E_SYNTAX);
  ck_assert_int_eq(number("SELECT count(*) FROM tap WHERE reason = 'ok'"), 1);
  ethd__store_close(&store);
}

/* ---- one writer ---- */

TEST(test_one_at_a_time) {
  int pipe_of[2];
  char byte = 0, pid[32];
  ck_assert_int_eq(pipe(pipe_of), 0);
  pid_t child = fork();
  if (!child) {
    if (ethd__store_open(path, HASH, &store, message) || write(pipe_of[1], &byte, 1) != 1) _exit(1);
    for (;;) pause();
  }
  ck_assert_int_eq(read(pipe_of[0], &byte, 1), 1);
  snprintf(pid, sizeof pid, "test_store, process %d, is", (int)child);
  refused(ethd__store_open(path, HASH, &store, message), pid);
  refused(ethd__store_read(path, HASH, &store, message), pid);
  kill(child, SIGKILL);
  waitpid(child, NULL, 0);
  open_store();
  ethd__store_close(&store);
}

/* Killed in a transaction: the rows before it are there. Reading such a file is refused, and so is a journal that names
   another file, which SQLite would remove. */
TEST(test_killed_in_a_transaction) {
  char journal[128], victim[128], kept[160];
  begin();
  put_tap(1, ETHD_TAP_OK);
  run("WITH RECURSIVE n(i) AS (VALUES (1) UNION ALL SELECT i + 1 FROM n WHERE i < 9999) "
      "INSERT INTO event (utc, event, detail) SELECT '', 'note', hex(randomblob(99)) FROM n");
  ethd__store_close(&store);
  pid_t child = fork();
  if (!child) {
    if (ethd__store_open(path, HASH, &store, message) ||
        ethd__store_do(&store,
                       "PRAGMA cache_size = 1; PRAGMA cache_spill = 1; BEGIN; DELETE FROM tap; "
                       "UPDATE event SET detail = hex(randomblob(99))",
                       message))
      _exit(1);
    raise(SIGKILL);
  }
  waitpid(child, NULL, 0);
  snprintf(journal, sizeof journal, "%s-journal", path);
  snprintf(kept, sizeof kept, "cp %s %s.kept", journal, path);
  ck_assert_int_eq(system(kept), 0);
  refused(ethd__store_read(path, HASH, &store, message), "was cut short");

  snprintf(victim, sizeof victim, "%s/thesis", folder);
  done(ethd_text_write(victim, "mine", 4, message));
  FILE *file = fopen(journal, "a");
  size_t length = strlen(victim);
  unsigned sum = 0;
  for (size_t i = 0; i < length; i++) sum += (unsigned char)victim[i];
  const unsigned char numbers[] = {0,
                                   0,
                                   0,
                                   (unsigned char)length,
                                   (unsigned char)(sum >> 24),
                                   (unsigned char)(sum >> 16),
                                   (unsigned char)(sum >> 8),
                                   (unsigned char)sum};
  fwrite("\0\0\0\0", 1, 4, file);
  fwrite(victim, 1, length, file);
  fwrite(numbers, 1, sizeof numbers, file);
  fwrite("\xd9\xd5\x05\xf9\x20\xa1\x63\xd7", 1, 8, file);
  fclose(file);
  refused(ethd__store_open(path, HASH, &store, message), "isn't of a study's file");
  ck_assert_int_eq(access(victim, F_OK), 0);

  snprintf(kept, sizeof kept, "mv %s.kept %s", path, journal);
  ck_assert_int_eq(system(kept), 0);
  open_store();
  ck_assert_int_eq(number("SELECT count(*) FROM tap"), 1);
  ck_assert_int_eq(number("SELECT count(*) FROM event"), 9999);
  ethd__store_close(&store);
  ck_assert_int_ne(access(journal, F_OK), 0);
}

/* ---- a stranger's ---- */

TEST(test_anothers_tables) {
  static const struct {
    const char *sql, *word;
  } cases[] = {
      {"CREATE VIEW x AS SELECT 1", "its tables aren't"},
      {"CREATE TRIGGER x AFTER INSERT ON tap BEGIN DELETE FROM event; END", "its tables aren't"},
      {"CREATE INDEX x ON tap (seed)", "its tables aren't"},
      {"DROP TABLE survey", "its tables aren't"},
      {"ALTER TABLE event ADD COLUMN x", "its tables aren't"},
      {"CREATE VIRTUAL TABLE x USING fts5(a)", "its tables aren't"},
      {"PRAGMA writable_schema = 1; UPDATE sqlite_schema SET sql = replace(sql, 'utc TEXT', 'utc BLOB')", "its tables"},
      {"PRAGMA writable_schema = 1; UPDATE sqlite_schema SET sql = 'CREATE TABLE ' || char(10, 27) WHERE name = 'tap'",
       ""},
      {"PRAGMA application_id = 1", "isn't a study's file"},
      {"PRAGMA user_version = 1", "of version 1, this program reads 2: the tables"},
      {"PRAGMA journal_mode = WAL", "isn't a study's file"},
      {"UPDATE study SET hash = 'x'", "begun with other files"},
      {"INSERT INTO study VALUES ('12ab')", "begun with other files"},
      {"DELETE FROM study", "begun with other files"},
      {"PRAGMA ignore_check_constraints = 1; UPDATE tap SET reason = '../../x'", "is damaged: "},
      {"PRAGMA ignore_check_constraints = 1; UPDATE tap SET seed = 'x'", "is damaged: "},
      {"PRAGMA ignore_check_constraints = 1; INSERT INTO hand VALUES ('paw')", "is damaged: "},
      {"UPDATE tap SET hand = 'paw'", "is damaged: a tap of no hand"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    unlink(path);
    begin();
    put_tap(1, ETHD_TAP_OK);
    ethd__store_close(&store);
    as_stranger(cases[i].sql);
    strcpy(message, cases[i].sql);
    refused(ethd__store_read(path, HASH, &store, message), cases[i].word);
    ck_assert_msg(ethd__store_open(path, HASH, &store, message) < 0 && strstr(message, cases[i].word), "%s: %s",
                  cases[i].sql, message);
  }
  unlink(path);
  refused(ethd__store_read(path, HASH, &store, message), "No such file");
  done(ethd_text_write(path, "begin hash 12ab #1234abcd\n", 26, message));
  refused(ethd__store_open(path, HASH, &store, message), "isn't a study");
}

TEST(test_no_file_of_its_own) {
  ethd__received received;
  char other[128];
  ethd__received_enter(&received, folder);
  snprintf(other, sizeof other, "%s/other", folder);
  begin();
  ethd__store_close(&store);
  ck_assert_int_eq(rename(path, other) | symlink(other, path), 0);
  refused(ethd__store_read(path, HASH, &store, message), "is a link");
  refused(ethd__store_open(path, HASH, &store, message), "is a link");
  ck_assert_int_eq(unlink(path) | mkfifo(path, 0600), 0);
  refused(ethd__store_read(path, HASH, &store, message), "is a pipe");
  refused(ethd__store_open(path, HASH, &store, message), "is a pipe");
  ck_assert_int_eq(unlink(path) | rename(other, path) | truncate(path, 1 << 30), 0);
  refused(ethd__store_read(path, HASH, &store, message), "has a hole");
  refused(ethd__store_open(path, HASH, &store, message), "has a hole");
  ethd__received_leave(&received);
}

/* A link in the way to the folder is the user's own, and the path may have any letter. */
TEST(test_any_path) {
  char link[128], way[160];
  snprintf(link, sizeof link, "%s/a link?mode=memory#%%41", folder);
  ck_assert_int_eq(symlink(".", link), 0);
  snprintf(way, sizeof way, "%s/x?y.sqlite", link);
  done(ethd__store_open(way, HASH, &store, message));
  run("INSERT INTO hand VALUES ('mouse')");
  ethd__store_close(&store);
  ck_assert_int_eq(access(way, F_OK), 0);
  done(ethd__store_read(way, HASH, &store, message));
  ck_assert_int_eq(number("SELECT count(*) FROM hand"), 1);
  refused((ethd__store_close(&store), ethd__store_read(way, "other", &store, message)), "begun with other files");
}

/* Cut, or with other bytes anywhere: read as it was put, or refused in one line; never written, and soon over. */
TEST(test_mutations) {
  enum { CASES = 3000 };
  const char *more = getenv("ETHD_FUZZ");
  uint64_t count = more ? strtoull(more, NULL, 10) : CASES, taken = 0;
  char *whole;
  size_t length;
  begin();
  for (uint32_t i = 0; i < 40; i++) put_tap(i + 1, ETHD_TAP_OK);
  ethd__store_close(&store);
  done(ethd_text_read(path, 1 << 24, &whole, &length, message));
  for (uint64_t i = 0; i < count; i++) {
    char *text = malloc(length);
    size_t n = draw_bits(64 * i) % 8 ? length : draw_bits(64 * i + 1) % length;
    memcpy(text, whole, length);
    for (uint64_t k = 0, changes = 1 + draw_bits(64 * i + 2) % 6; k < changes; k++) {
      uint64_t r = draw_bits(64 * i + 3 + k), page = (r >> 40) % (length / 4096); /* heads of pages hold the tree */
      size_t at = r & 1 ? (r >> 8) % length : page * 4096 + (r >> 8) % (page ? 12 : 112);
      text[at] = (char)(r >> 32);
    }
    FILE *file = fopen(path, "w");
    ck_assert_uint_eq(fwrite(text, 1, n, file), n);
    fclose(file);
    *message = 0;
    if (!ethd__progress_open(&study, ETHD_STUDY_STORE, false, &store, message)) {
      char *tables[ETHD_TABLES];
      (void)!ethd__tables_of(&study, &store, tables, message);
      for (int k = 0; k < ETHD_TABLES; k++) free(tables[k]);
      ethd__store_close(&store);
      taken++;
    } else {
      refused(ETHD_E_SYNTAX, "study.sqlite: ");
    }
    free(text);
  }
  ck_assert_uint_gt(taken, 0);
  ck_assert_uint_lt(taken, count);
  free(whole);
}

/* ---- several into one ---- */

TEST(test_added) {
  ethd__study_store both;
  char other[128];
  begin();
  put_tap(1, ETHD_TAP_OK);
  run("INSERT INTO event (utc, participant, event, detail) VALUES ('', 1, 'note', 'x'); INSERT INTO answer VALUES "
      "(1, 2, 1, 3, NULL); INSERT INTO survey (participant, block) VALUES (1, 2)");
  ethd__store_close(&store);
  snprintf(other, sizeof other, "%s/both.sqlite", folder);
  done(ethd__store_open(other, HASH, &both, message));
  done(ethd__store_add(&both, path, message));
  ck_assert_int_eq(ethd__store_add(&both, path, message), ETHD_E_SYNTAX); /* whole or not at all */
  ck_assert_msg(strstr(message, "UNIQUE"), "%s", message);
  store = both;
  ck_assert_int_eq(number("SELECT count(*) FROM tap"), 1);
  ck_assert_int_eq(number("SELECT count(*) FROM event"), 1);
  ck_assert_int_eq(number("SELECT sum(number) FROM answer JOIN survey USING (participant, block)"), 3);
  ck_assert_int_eq(number("SELECT count(*) FROM study JOIN hand ON word = 'mouse'"), 1);
  ethd__store_close(&both);
  store = ETHD_STORE_NONE;
}
