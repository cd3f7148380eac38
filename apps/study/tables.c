#include "study/tables.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "store/schema.h"
#include "text/csv.h"
#include "text/text.h"

/* ---- what SQL asks of the study ---- */

/* The study, and the order of the last requested participant; rows often come participant by participant. */
typedef struct study_view {
  const ethd__protocol *protocol;
  int64_t participant; /* from 1; 0: none yet */
  size_t count;
  ethd__study_block blocks[ETHD_STUDY_BLOCKS];
} study_view;

static const ethd__protocol *protocol_of(sqlite3_context *context) {
  return ((const study_view *)sqlite3_user_data(context))->protocol;
}

/* id(participant): P01, .. */
static void sql_id(sqlite3_context *context, int count, sqlite3_value **value) {
  char id[ETHD_STUDY_ID_MAX];
  (void)count;
  if (sqlite3_value_type(*value) == SQLITE_NULL) return; /* an event of nobody */
  ethd__participant_id(protocol_of(context), (uint32_t)sqlite3_value_int64(*value) - 1, id);
  sqlite3_result_text(context, id, -1, SQLITE_TRANSIENT);
}

/* Returns a block by the arguments (participant, block); the first one if there is no such block. */
static ethd__study_block block_of(sqlite3_context *context, sqlite3_value **value) {
  study_view *view = sqlite3_user_data(context);
  const int64_t participant = sqlite3_value_int64(value[0]), number = sqlite3_value_int64(value[1]);
  if (participant != view->participant) {
    view->count = ethd__order_of(view->protocol, (uint32_t)participant - 1, view->blocks);
    view->participant = participant;
  }
  return view->blocks[number >= 1 && (uint64_t)number <= view->count ? number - 1 : 0];
}

static void sql_part(sqlite3_context *context, int count, sqlite3_value **value) {
  (void)count;
  const bool training = block_of(context, value).training;
  sqlite3_result_text(context, training ? "training" : "test", -1, SQLITE_STATIC);
}

static void sql_transition(sqlite3_context *context, int count, sqlite3_value **value) {
  (void)count;
  const size_t strategy = block_of(context, value).strategy;
  sqlite3_result_text(context, protocol_of(context)->strategies.word[strategy], -1, SQLITE_STATIC);
}

static void sql_speed(sqlite3_context *context, int count, sqlite3_value **value) {
  (void)count;
  const size_t speed = block_of(context, value).speed;
  sqlite3_result_text(context, protocol_of(context)->speeds.word[speed], -1, SQLITE_STATIC);
}

/* gain(point, axis) */
static void sql_gain(sqlite3_context *context, int count, sqlite3_value **value) {
  size_t point = (size_t)sqlite3_value_int64(value[0]), axis = (size_t)sqlite3_value_int64(value[1]);
  (void)count;
  sqlite3_result_text(context, ethd__protocol_value(protocol_of(context), point, axis), -1, SQLITE_STATIC);
}

static void add_functions(ethd__study_store *store, study_view *view) {
  static const struct {
    const char *name;
    int arguments;
    void (*call)(sqlite3_context *context, int count, sqlite3_value **value);
  } functions[] = {{"id", 1, sql_id},
                   {"part", 2, sql_part},
                   {"transition", 2, sql_transition},
                   {"speed", 2, sql_speed},
                   {"gain", 2, sql_gain}};
  for (size_t i = 0; i < sizeof functions / sizeof *functions; i++)
    if (sqlite3_create_function(store->db, functions[i].name, functions[i].arguments, SQLITE_UTF8 | SQLITE_DIRECTONLY,
                                view, functions[i].call, NULL, NULL))
      ethd__fail_memory();
}

/* ---- each table's rows ---- */

/* A simulation's taps are sorted by grid point. A row begins with the study and the point, and ends with the gains. */
static void select_taps(FILE *sql, const ethd__folder *folder) {
  fputs("SELECT ", sql);
  if (folder->simulated) fprintf(sql, "'%.12s', point, ", folder->hash);
  fputs("id(participant), block, part(participant, block), attempt, transition(participant, block), speed(participant, "
        "block), "
        "seed, tap, valid, reason, " ETHD_STORE_FIGURES
        ", hand, movement, utc, by_ring, by_finger, " ETHD_STUDY_CHECKED,
        sql);
  for (size_t i = 0; folder->simulated && i < folder->protocol.axis_count; i++) fprintf(sql, ", gain(point, %zu)", i);
  fputs(folder->simulated ? " FROM tap ORDER BY point, participant, block, attempt" : " FROM tap ORDER BY id", sql);
}

/* The columns of answers to these questions; 0: none was given. */
static void select_answers(FILE *sql, const ethd__question *list, const char *participant, const char *block) {
  for (size_t i = 1; i <= ethd__question_count(list); i++)
    fprintf(
        sql,
        ", (SELECT coalesce(words, nullif(number, 0)) FROM answer WHERE answer.participant = %s AND answer.block = %s "
        "AND question = %zu)",
        participant, block, i);
}

static void select_survey(FILE *sql, const ethd__folder *folder) {
  fputs("SELECT id(participant), block, transition(participant, block), speed(participant, block)", sql);
  ethd__study_block blocks[ETHD_STUDY_BLOCKS];
  select_answers(sql, folder->protocol.questionnaire.question[ETHD_ASK_BLOCK], "survey.participant", "survey.block");
  fprintf(sql, " FROM survey WHERE block BETWEEN 1 AND %zu ORDER BY id", ethd__order_of(&folder->protocol, 0, blocks));
}

static void select_events(FILE *sql, const ethd__folder *folder) {
  (void)folder;
  fputs("SELECT utc, id(participant), block, attempt, event, detail FROM event ORDER BY id", sql);
}

/* A row for every participant with a tap, an answer, or a decision, with the decision's reason. */
static void select_participants(FILE *sql, const ethd__folder *folder) {
  const ethd__protocol *p = &folder->protocol;
  ethd__study_block blocks[ETHD_STUDY_BLOCKS];
  const size_t count = ethd__order_of(p, 0, blocks);
  char behind[24];
  snprintf(behind, sizeof behind, "%zu", count + 1);
  fprintf(
      sql,
      "WITH decided AS (SELECT participant, event, detail FROM event WHERE id IN (SELECT max(id) FROM event WHERE "
      "participant NOTNULL AND event IN " ETHD_STUDY_DECISIONS " GROUP BY participant)),"
      " done AS (SELECT participant, part(participant, block) = 'test' AS test, count(*) AS taken, "
      "sum(valid AND checked IS NOT 'rejected') AS valid, sum(checked IS 'accepted') AS accepted, "
      "sum(checked IS 'rejected') AS rejected FROM (SELECT participant, block, valid, " ETHD_STUDY_CHECKED
      " AS checked FROM tap) GROUP BY participant, block),"
      " tapped AS (SELECT participant, sum(taken * test) AS taps, sum(valid * test) AS valid, "
      "sum(accepted * test) AS accepted, sum(rejected * test) AS rejected, "
      "sum(iif(test, valid >= %u OR taken >= %u, taken >= %u)) AS over FROM done GROUP BY participant)"
      " SELECT id(participant), CASE event WHEN 'abort' THEN 'aborted' WHEN 'refuse' THEN 'refused' WHEN 'withdraw' "
      "THEN 'withdrawn' WHEN 'exclude' THEN 'excluded' ELSE iif(over = %zu, 'complete', 'incomplete') END,"
      " coalesce(event IN ('undo', 'include'), 1), detail,"
      " (SELECT hand FROM tap WHERE point = 0 AND tap.participant = people.participant LIMIT 1),"
      " coalesce(taps, 0), coalesce(valid, 0), coalesce(accepted, 0), coalesce(rejected, 0),"
      " (SELECT utc FROM tap WHERE point = 0 AND tap.participant = people.participant ORDER BY id LIMIT 1),"
      " (SELECT utc FROM tap WHERE point = 0 AND tap.participant = people.participant ORDER BY id DESC LIMIT 1)",
      ethd__block_taps(p), ethd__block_attempts(p), p->training, count);
  select_answers(sql, p->questionnaire.question[ETHD_ASK_BEFORE], "people.participant", "0");
  select_answers(sql, p->questionnaire.question[ETHD_ASK_AFTER], "people.participant", behind);
  fputs(" FROM (SELECT participant FROM tapped UNION SELECT participant FROM decided UNION SELECT participant FROM "
        "answer) "
        "AS people LEFT JOIN tapped USING (participant) LEFT JOIN decided USING (participant) ORDER BY participant",
        sql);
}

/* NULL: the table was written as the folder was made. */
static void (*const select_rows[ETHD_TABLES])(FILE *sql, const ethd__folder *folder) = {
    [ETHD_TABLE_TAPS] = select_taps,
    [ETHD_TABLE_SURVEY] = select_survey,
    [ETHD_TABLE_EVENTS] = select_events,
    [ETHD_TABLE_PARTICIPANTS] = select_participants};

/* A simulation has taps only. */
static bool has(const ethd__folder *folder, ethd__study_table table) {
  return select_rows[table] && (!folder->simulated || table == ETHD_TABLE_TAPS);
}

/* ---- tables ---- */

static void print_row(FILE *file, sqlite3_stmt *row) {
  for (int i = 0; i < sqlite3_column_count(row); i++) {
    if (i) putc(',', file);
    if (sqlite3_column_type(row, i) == SQLITE_FLOAT)
      fprintf(file, "%.17g", sqlite3_column_double(row, i));
    else
      ethd__csv_put_word(file, ethd__store_text(row, i));
  }
  putc('\n', file);
}

static ethd_status print_table(FILE *file, ethd__study_store *store, const ethd__folder *folder,
                               ethd__study_table table, char *message) {
  ETHD__FREED char *header =
      folder->simulated ? ethd__simulation_header(&folder->protocol) : ethd__table_header(table, &folder->protocol);
  ethd__printed sql;
  select_rows[table](ethd__print_begin(&sql), folder);
  fprintf(file, "%s\n", header);
  study_view view = {.protocol = &folder->protocol};
  add_functions(store, &view);
  sqlite3_stmt *row = ethd__store_query(store, ethd__print_end(&sql));
  while (ethd__store_next(row)) print_row(file, row);
  free(sql.text);
  return ethd__store_end(store, row, message);
}

ethd_status ethd__tables_of(const ethd__folder *folder, ethd__study_store *store, char *out[ETHD_TABLES],
                            char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  for (int i = 0; i < ETHD_TABLES; i++) {
    ethd__printed table;
    out[i] = NULL;
    if (status || !has(folder, (ethd__study_table)i)) continue;
    status = print_table(ethd__print_begin(&table), store, folder, (ethd__study_table)i, message);
    out[i] = ethd__print_end(&table);
  }
  return status;
}

static ethd_status write_table(const ethd__folder *folder, ethd__study_store *store, ethd__study_table table,
                               char *message) {
  char name[32];
  snprintf(name, sizeof name, "%s.csv", ethd__table_names[table]);
  ETHD__FREED char *path = ethd__folder_path(folder->path, name);
  ethd_replace replace;
  ethd_status status = ethd_replace_begin(path, &replace, message);
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
