#include "study/tables.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "study/progress.h"
#include "study/row.h"
#include "study/sums.h"
#include "text/csv.h"
#include "text/error_text.h"
#include "text/text.h"

/* The journal as it stands, and what follows from it. */
typedef struct ledger {
  const ethd__folder *folder;
  ethd__journal journal;
  ethd__session_progress progress;
} ledger;

static ethd_status read_progress(ledger *l, char *message) {
  ethd_status status = ethd__progress_begin(&l->folder->protocol, &l->progress, message);
  return status ? status : ethd__progress_read(&l->journal, l->folder->hash, &l->progress, message);
}

static ethd_status read_ledger(const ethd__folder *folder, ledger *out, char *message) {
  char *path = ethd__folder_path(folder->path, ETHD_STUDY_JOURNAL);
  *out = (ledger){.folder = folder, .journal = {.fd = -1}};
  ethd_status status = ethd__journal_read(path, &out->journal, message);
  if (!status) status = read_progress(out, message);
  free(path);
  return status;
}

static void close_ledger(ledger *l) {
  ethd__journal_close(&l->journal);
  ethd__progress_free(&l->progress);
}

/* ---- rows ---- */

/* The journal's lines of this kind. */
static void put_lines(const ledger *l, const char *kind, FILE *file) {
  for (size_t i = 0; i < l->journal.count; i++)
    if (!strcmp(l->journal.lines[i].kind, kind)) fprintf(file, "%s\n", l->journal.lines[i].text);
}

/* Rows of an earlier version get empty cells for the columns that they lack. */
static void put_taps(const ledger *l, FILE *file) {
  for (size_t i = 0; i < l->journal.count; i++) {
    const char *row = l->journal.lines[i].text;
    if (!strcmp(l->journal.lines[i].kind, "tap")) fprintf(file, "%s%s\n", row, ethd__tap_row_is_short(row) ? ",," : "");
  }
}

static void put_survey(const ledger *l, FILE *file) { put_lines(l, "survey", file); }
static void put_events(const ledger *l, FILE *file) { put_lines(l, "event", file); }

/* Everybody has a row who has tapped or about whom something was decided. */
static void put_participants(const ledger *l, FILE *file) {
  const ethd__protocol *p = &l->folder->protocol;
  char id[ETHD_STUDY_ID_MAX];
  for (uint32_t i = 0; i < p->participants; i++) {
    const ethd__participant *who = &l->progress.person[i];
    if (!who->tapped && who->standing == ETHD_STANDING_IN && !who->reason) continue;
    ethd__participant_id(p, i, id);
    fprintf(file, "%s,%s,%d,", id,
            who->standing != ETHD_STANDING_IN         ? ethd__standing_words[who->standing]
            : ethd__participant_over(&l->progress, i) ? "complete"
                                                      : "incomplete",
            who->standing == ETHD_STANDING_IN);
    ethd__csv_put_word(file, who->reason ? who->reason : "");
    fprintf(file, ",%s,%u,%u,%s,%s\n", who->tapped ? ethd__hand_words[who->hand] : "", who->taps, who->valid,
            who->first, who->last);
  }
}

/* NULL: the table was written as the folder was made. */
static void (*const put_rows[ETHD_TABLES])(const ledger *l,
                                           FILE *file) = {[ETHD_TABLE_TAPS] = put_taps,
                                                          [ETHD_TABLE_SURVEY] = put_survey,
                                                          [ETHD_TABLE_EVENTS] = put_events,
                                                          [ETHD_TABLE_PARTICIPANTS] = put_participants};

static void put_table(const ledger *l, ethd__study_table table, FILE *file) {
  char *header = ethd__table_header(table, &l->folder->protocol);
  fprintf(file, "%s\n", header);
  free(header);
  put_rows[table](l, file);
}

/* ---- tables in memory ---- */

ethd_status ethd__tables_of(const ethd__folder *folder, const ethd__journal *journal, char *out[ETHD_TABLES],
                            char message[ETHD_MESSAGE_MAX]) {
  ledger l = {.folder = folder, .journal = *journal};
  ethd_status status = read_progress(&l, message);
  for (int i = 0; i < ETHD_TABLES; i++) {
    size_t length;
    out[i] = NULL;
    if (status || !put_rows[i]) continue;
    FILE *file = open_memstream(&out[i], &length);
    if (!file) ethd__fail_memory();
    put_table(&l, (ethd__study_table)i, file);
    if (fclose(file)) ethd__fail_memory();
  }
  ethd__progress_free(&l.progress);
  return status;
}

/* ---- files ---- */

static ethd_status write_table(const ledger *l, ethd__study_table table, char *message) {
  char name[32];
  if (!put_rows[table]) return ETHD_OK;
  snprintf(name, sizeof name, "%s.csv", ethd__table_names[table]);
  char *path = ethd__folder_path(l->folder->path, name);
  ethd_replace replace;
  ethd_status status = ethd_replace_begin(path, &replace, message);
  free(path);
  if (status) return status;
  put_table(l, table, replace.file);
  return ethd_replace_commit(&replace, message);
}

ethd_status ethd__tables_write(const ethd__folder *folder, char message[ETHD_MESSAGE_MAX]) {
  ledger l;
  ethd_status status = read_ledger(folder, &l, message);
  for (int i = 0; !status && i < ETHD_TABLES; i++) status = write_table(&l, (ethd__study_table)i, message);
  close_ledger(&l);
  return status ? status : ethd__sums_write(folder->path, message);
}
