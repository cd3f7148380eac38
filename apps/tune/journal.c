#include "tune/journal.h"

#include <errno.h>
#include <search.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "text/csv.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

#define BYTES_MAX ((size_t)1 << 28)

static char *shard_path(const ethd__tune_journal *j, uint32_t index) {
  char name[64];
  snprintf(name, sizeof name, "scores-%u-of-%u.csv", index, j->count);
  return ethd__path_join(j->folder, name);
}

static int by_number(const void *a, const void *b) {
  const ethd__tune_row *x = a, *y = b;
  if (x->round != y->round) return x->round < y->round ? -1 : 1;
  return (x->number > y->number) - (x->number < y->number);
}

/* Keeps the row, unless its point has a score already. */
static ethd_status keep(ethd__tune_journal *j, const ethd__tune_row *row, char *message) {
  ethd__tune_row *own = malloc(sizeof *own);
  if (own) *own = *row;
  ethd__tune_row **found = own ? tsearch(own, &j->rows, by_number) : NULL;
  if (!found || *found != own) free(own);
  return found ? ETHD_OK : ethd__no_memory(message, j->folder);
}

/* ---- reading ---- */

/* Returns the length of the whole lines: the last line is cut off where its process was ended while writing it. */
static size_t whole_lines(const char *text, size_t length) {
  while (length && text[length - 1] != '\n') length--;
  return length;
}

static bool row_of(const ethd_csv *csv, size_t r, ethd__tune_row *out) {
  const double *v = csv->values + r * csv->columns;
  double numbers[ETHD_TUNE_FIGURE_COUNT];
  if (!(v[0] >= 0 && v[0] < UINT32_MAX && v[1] >= 0 && v[1] < UINT32_MAX)) return false;
  memcpy(numbers, v + 2, sizeof numbers);
  *out = (ethd__tune_row){.round = (uint32_t)v[0], .number = (uint32_t)v[1]};
  memcpy(&out->score, numbers, sizeof numbers);
  return true;
}

static ethd_status take_rows(ethd__tune_journal *j, const ethd_csv *csv, const char *path, char *message) {
  if (csv->columns != 2 + ETHD_TUNE_FIGURE_COUNT)
    return ethd__say(message, ETHD_E_SYNTAX, "%s: these are no scores of this version", path);
  ethd_status status = ETHD_OK;
  for (size_t r = 0; !status && r < csv->rows; r++) {
    ethd__tune_row row;
    if (!row_of(csv, r, &row)) return ethd__say(message, ETHD_E_SYNTAX, "%s:%zu: no score", path, ethd_csv_line(r));
    status = keep(j, &row, message);
  }
  return status;
}

/* Reads a shard's file. *good, unless it is NULL, becomes the length of its whole lines. */
static ethd_status read_shard(ethd__tune_journal *j, uint32_t index, size_t *good, char *message) {
  char *path = shard_path(j, index), *text = NULL;
  size_t length = 0;
  ethd_csv csv = {0};
  if (!path) return ethd__no_memory(message, j->folder);
  ethd_status status = access(path, F_OK) ? ETHD_OK : ethd_text_read(path, BYTES_MAX, &text, &length, message);
  length = text ? whole_lines(text, length) : 0;
  if (!status && length) {
    text[length] = 0;
    status = ethd_csv_parse(text, length, path, NULL, &csv, message);
    if (!status) status = take_rows(j, &csv, path, message);
    ethd_csv_free(&csv);
  }
  if (good) *good = length;
  free(text);
  free(path);
  return status;
}

ethd_status ethd__tune_journal_read(ethd__tune_journal *j, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ETHD_OK;
  for (uint32_t i = 1; j->folder && !status && i <= j->count; i++)
    if (i != j->index) status = read_shard(j, i, NULL, message);
  return status;
}

const ethd__tune_score *ethd__tune_journal_find(const ethd__tune_journal *j, uint32_t round, uint32_t number) {
  const ethd__tune_row wanted = {.round = round, .number = number};
  ethd__tune_row *const *found = tfind(&wanted, &j->rows, by_number);
  return found ? &(*found)->score : NULL;
}

/* ---- writing ---- */

static ethd_status refuse(const char *path, char *message) {
  return ethd__say(message, ETHD_E_FILE, "%s: %s", path, strerror(errno));
}

static void put_header(FILE *file) {
  fputs("round,number", file);
  for (size_t i = 0; i < ETHD_TUNE_FIGURE_COUNT; i++) fprintf(file, ",%s", ethd__tune_figure_names[i]);
  putc('\n', file);
}

static ethd_status open_own(ethd__tune_journal *j, char *message) {
  size_t good = 0;
  char *path = shard_path(j, j->index);
  if (!path) return ethd__no_memory(message, j->folder);
  int fd = ethd__file_edit(path, true, message);
  j->file = fd < 0 ? NULL : fdopen(fd, "ab");
  ethd_status status = fd < 0 ? ETHD_E_FILE : j->file ? ETHD_OK : refuse(path, message);
  if (!status && flock(fileno(j->file), LOCK_EX | LOCK_NB))
    status = ethd__say(message, ETHD_E_FILE, "%s: another process works on this shard", path);
  if (!status) status = read_shard(j, j->index, &good, message);
  if (!status && ftruncate(fileno(j->file), (off_t)good)) status = refuse(path, message);
  if (!status && !good) put_header(j->file);
  free(path);
  return status;
}

/* tune.txt says what is searched for; the first shard that comes writes it, the others compare. */
static ethd_status check_what(const ethd__tune_journal *j, const char *what, char *message) {
  char *path = ethd__path_join(j->folder, "tune.txt"), *there = NULL;
  size_t length = 0;
  if (!path) return ethd__no_memory(message, j->folder);
  ethd_status status;
  if (access(path, F_OK))
    status = ethd_text_write(path, what, strlen(what), message);
  else if (!(status = ethd_text_read(path, BYTES_MAX, &there, &length, message)) && strcmp(there, what) != 0)
    status = ethd__say(message, ETHD_E_DIFFERS,
                       "%s: something else was searched for in this folder; another --work is needed", j->folder);
  free(there);
  free(path);
  return status;
}

ethd_status ethd__tune_journal_open(const char *folder, const char *what, uint32_t index, uint32_t count,
                                    ethd__tune_journal *out, char message[ETHD_MESSAGE_MAX]) {
  *out = (ethd__tune_journal){.folder = folder, .index = index, .count = count};
  if (!folder) return ETHD_OK;
  if (mkdir(folder, 0777) && errno != EEXIST) return refuse(folder, message);
  ethd_status status = check_what(out, what, message);
  if (!status) status = open_own(out, message);
  if (!status) status = ethd__tune_journal_read(out, message);
  return status;
}

bool ethd__tune_journal_mine(const ethd__tune_journal *j, uint32_t number) { return number % j->count == j->index - 1; }

ethd_status ethd__tune_journal_add(ethd__tune_journal *j, uint32_t round, uint32_t number,
                                   const ethd__tune_score *score, char message[ETHD_MESSAGE_MAX]) {
  const ethd__tune_row row = {round, number, *score};
  double numbers[ETHD_TUNE_FIGURE_COUNT];
  ethd_status status = keep(j, &row, message);
  if (status || !j->file) return status;
  memcpy(numbers, score, sizeof numbers);
  fprintf(j->file, "%u,%u", round, number);
  for (size_t i = 0; i < ETHD_TUNE_FIGURE_COUNT; i++) fprintf(j->file, ",%.17g", numbers[i]);
  putc('\n', j->file);
  if (!fflush(j->file)) return ETHD_OK;
  (void)!refuse(j->folder, message);
  return ETHD_E_UNFINISHED;
}

void ethd__tune_journal_close(ethd__tune_journal *j) {
  if (j->file) fclose(j->file);
  tdestroy(j->rows, free);
  *j = (ethd__tune_journal){0};
}
