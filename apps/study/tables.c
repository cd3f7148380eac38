#include "study/tables.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "text/csv.h"
#include "text/error_text.h"
#include "text/text.h"

/* ---- rows ---- */

static void print_id(FILE *file, const ethd__protocol *p, sqlite3_stmt *row, int column) {
  char id[ETHD_STUDY_ID_MAX] = "";
  if (sqlite3_column_type(row, column) != SQLITE_NULL)
    ethd__participant_id(p, (uint32_t)sqlite3_column_int64(row, column) - 1, id);
  fputs(id, file);
}

/* The answers of a block, in the order of the questions; "" where there is none. */
static ethd_status print_answers(FILE *file, ethd__study_store *store, const ethd__protocol *p, sqlite3_stmt *block,
                                 char *message) {
  static const char select[] = "SELECT number, words FROM answer WHERE participant = ? AND block = ? AND question = ?";
  ethd_status status = ETHD_OK;
  for (size_t i = 0; !status && i < ethd__question_count(&p->questionnaire); i++) {
    sqlite3_stmt *row = ethd__store_query(store, select);
    sqlite3_bind_int64(row, 1, sqlite3_column_int64(block, 0));
    sqlite3_bind_int64(row, 2, sqlite3_column_int64(block, 1));
    sqlite3_bind_int64(row, 3, (int64_t)i + 1);
    bool there = ethd__store_next(row);
    putc(',', file);
    if (there && ethd__question_is_text(&p->questionnaire.question[i]))
      ethd__csv_put_word(file, ethd__store_text(row, 1));
    else if (there && sqlite3_column_int(row, 0) > 0)
      fprintf(file, "%d", sqlite3_column_int(row, 0));
    status = ethd__store_end(store, row, message);
  }
  return status;
}

static ethd_status print_survey(FILE *file, ethd__study_store *store, const ethd__folder *folder, char *message) {
  const ethd__protocol *p = &folder->protocol;
  ethd__study_block blocks[ETHD_STUDY_BLOCKS];
  ethd_status status = ETHD_OK;
  sqlite3_stmt *row = ethd__store_query(store, "SELECT participant, block FROM survey ORDER BY id");
  while (!status && ethd__store_next(row)) {
    (void)ethd__order_of(p, (uint32_t)sqlite3_column_int64(row, 0) - 1, blocks);
    const ethd__study_block *block = &blocks[sqlite3_column_int(row, 1) - 1];
    print_id(file, p, row, 0);
    fprintf(file, ",%d,%s,%s", sqlite3_column_int(row, 1), p->strategies.word[block->strategy],
            p->speeds.word[block->speed]);
    status = print_answers(file, store, p, row, message);
    putc('\n', file);
  }
  ethd_status ended = ethd__store_end(store, row, message);
  return status ? status : ended;
}

static ethd_status print_events(FILE *file, ethd__study_store *store, const ethd__folder *folder, char *message) {
  sqlite3_stmt *row = ethd__store_query(store, "SELECT utc, participant, block, event, detail FROM event ORDER BY id");
  while (ethd__store_next(row)) {
    ethd__csv_put_word(file, ethd__store_text(row, 0));
    putc(',', file);
    print_id(file, &folder->protocol, row, 1);
    for (int i = 2; i < 5; i++) {
      putc(',', file);
      ethd__csv_put_word(file, ethd__store_text(row, i));
    }
    putc('\n', file);
  }
  return ethd__store_end(store, row, message);
}

/* Everybody has a row who has tapped or about whom something was decided, then with its reason. */
static ethd_status print_participant(FILE *file, ethd__study_store *store, const ethd__protocol *p,
                                     const ethd__participant *who, char *message) {
  static const char select[] =
      "SELECT (SELECT detail FROM event WHERE participant = ?1 AND event IN "
      "('abort', 'undo', 'refuse', 'withdraw', 'exclude', 'include') ORDER BY id DESC LIMIT 1),"
      "(SELECT hand FROM tap WHERE point = 0 AND participant = ?1 LIMIT 1),"
      "(SELECT utc FROM tap WHERE point = 0 AND participant = ?1 ORDER BY id LIMIT 1),"
      "(SELECT utc FROM tap WHERE point = 0 AND participant = ?1 ORDER BY id DESC LIMIT 1)";
  ethd__study_block blocks[ETHD_STUDY_BLOCKS];
  char id[ETHD_STUDY_ID_MAX];
  uint32_t taps = 0, valid = 0;
  for (size_t i = 0, count = ethd__order_of(p, who->person, blocks); i < count; i++) {
    taps += blocks[i].training ? 0 : who->at[i].taken;
    valid += blocks[i].training ? 0 : who->at[i].valid;
  }
  sqlite3_stmt *row = ethd__store_query(store, select);
  sqlite3_bind_int64(row, 1, who->person + 1);
  if (ethd__store_next(row) &&
      (sqlite3_column_type(row, 0) != SQLITE_NULL || sqlite3_column_type(row, 1) != SQLITE_NULL)) {
    ethd__participant_id(p, who->person, id);
    fprintf(file, "%s,%s,%d,", id,
            who->standing != ETHD_STANDING_IN ? ethd__standing_words[who->standing]
            : ethd__participant_over(p, who)  ? "complete"
                                              : "incomplete",
            who->standing == ETHD_STANDING_IN);
    ethd__csv_put_word(file, ethd__store_text(row, 0));
    fprintf(file, ",%s,%u,%u,", ethd__store_text(row, 1), taps, valid);
    ethd__csv_put_word(file, ethd__store_text(row, 2));
    putc(',', file);
    ethd__csv_put_word(file, ethd__store_text(row, 3));
    putc('\n', file);
  }
  return ethd__store_end(store, row, message);
}

static ethd_status print_participants(FILE *file, ethd__study_store *store, const ethd__folder *folder, char *message) {
  ethd__participant who;
  ethd_status status = ETHD_OK;
  for (uint32_t i = 0; !status && i < folder->protocol.participants; i++) {
    status = ethd__participant_of(store, i, &who, message);
    if (!status) status = print_participant(file, store, &folder->protocol, &who, message);
  }
  return status;
}

/* ---- tables ---- */

/* NULL: the table was written as the folder was made. */
static ethd_status (*const print_rows[ETHD_TABLES])(FILE *file, ethd__study_store *store, const ethd__folder *folder,
                                                    char message[ETHD_MESSAGE_MAX]) = {
    [ETHD_TABLE_TAPS] = ethd__taps_print,
    [ETHD_TABLE_SURVEY] = print_survey,
    [ETHD_TABLE_EVENTS] = print_events,
    [ETHD_TABLE_PARTICIPANTS] = print_participants};

/* A simulation has but taps. */
static bool has(const ethd__folder *folder, ethd__study_table table) {
  return print_rows[table] && (!folder->simulated || table == ETHD_TABLE_TAPS);
}

static ethd_status print_table(FILE *file, ethd__study_store *store, const ethd__folder *folder,
                               ethd__study_table table, char *message) {
  char *header =
      folder->simulated ? ethd__simulation_header(&folder->protocol) : ethd__table_header(table, &folder->protocol);
  fprintf(file, "%s\n", header);
  free(header);
  return print_rows[table](file, store, folder, message);
}

ethd_status ethd__tables_of(const ethd__folder *folder, ethd__study_store *store, char *out[ETHD_TABLES],
                            char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  for (int i = 0; i < ETHD_TABLES; i++) {
    size_t length;
    out[i] = NULL;
    if (status || !has(folder, (ethd__study_table)i)) continue;
    FILE *file = open_memstream(&out[i], &length);
    if (!file) ethd__fail_memory();
    status = print_table(file, store, folder, (ethd__study_table)i, message);
    if (fclose(file)) ethd__fail_memory();
  }
  return status;
}

static ethd_status write_table(const ethd__folder *folder, ethd__study_store *store, ethd__study_table table,
                               char *message) {
  char name[32];
  snprintf(name, sizeof name, "%s.csv", ethd__table_names[table]);
  char *path = ethd__folder_path(folder->path, name);
  ethd_replace replace;
  ethd_status status = ethd_replace_begin(path, &replace, message);
  free(path);
  if (status) return status;
  status = print_table(replace.file, store, folder, table, message);
  if (!status) return ethd_replace_commit(&replace, message);
  ethd_replace_abandon(&replace);
  return status;
}

ethd_status ethd__tables_write(const ethd__folder *folder, ethd__study_store *store, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  for (int i = 0; !status && i < ETHD_TABLES; i++)
    if (has(folder, (ethd__study_table)i)) status = write_table(folder, store, (ethd__study_table)i, message);
  return status;
}
