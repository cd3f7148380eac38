#include "report/gather.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "study/folder.h"
#include "study/stations.h"
#include "text/error_text.h"
#include "text/file.h"

/* ---- tables ---- */

static char *path_of(const char *folder, int table) {
  char name[40];
  snprintf(name, sizeof name, "%s.csv", ethd__table_names[table]);
  return ethd__folder_path(folder, name);
}

static ethd_status read_folder(const char *folder, ethd__sheet *out, char *message) {
  ethd_status status = ETHD_OK;
  for (int i = 0; !status && i < ETHD_TABLES; i++) {
    char *path = path_of(folder, i);
    if (ethd__file_taken(path)) status = ethd__sheet_read(path, &out[i], message);
    free(path);
  }
  return status;
}

static ethd_status read_stations(const ethd__stations *stations, ethd__sheet *out, char *message) {
  char *text[ETHD_TABLES] = {NULL};
  ethd_status status = ethd__stations_fit(stations->folder, stations->count, message);
  if (!status) status = ethd__stations_tables(stations->folder, stations->count, text, message);
  for (int i = 0; i < ETHD_TABLES; i++) {
    char *path = path_of(stations->folder[0], i);
    if (!status && text[i]) status = ethd__sheet_parse(text[i], strlen(text[i]), path, &out[i], message);
    free(path);
    free(text[i]);
  }
  return status;
}

ethd_status ethd__gather(const ethd__stations *stations, ethd__sheet out[ETHD_TABLES], char message[ETHD_MESSAGE_MAX]) {
  memset(out, 0, ETHD_TABLES * sizeof *out);
  ethd_status status =
      stations->count > 1 ? read_stations(stations, out, message) : read_folder(stations->folder[0], out, message);
  if (status) ethd__gather_free(out);
  return status;
}

void ethd__gather_free(ethd__sheet sheet[ETHD_TABLES]) {
  for (int i = 0; i < ETHD_TABLES; i++) ethd__sheet_free(&sheet[i]);
}

/* ---- who isn't analysed ---- */

static int by_word(const void *a, const void *b) { return strcmp(*(const char *const *)a, *(const char *const *)b); }

ethd_status ethd__absent_of(const ethd__sheet *participants, ethd__absent *out, char message[ETHD_MESSAGE_MAX]) {
  int id = ethd__sheet_column(participants, "participant"), analysed = ethd__sheet_column(participants, "analysed");
  *out = (ethd__absent){.name = calloc(participants->rows + 1, sizeof *out->name)};
  if (!out->name) return ethd__no_memory(message, participants->path);
  for (size_t row = 0; analysed >= 0 && row < participants->rows; row++) {
    if (strcmp(ethd__sheet_cell(participants, row, analysed), "0") != 0) continue;
    char *name = strdup(ethd__sheet_cell(participants, row, id)); /* the sheet goes first */
    if (!name) return ethd__no_memory(message, participants->path);
    out->name[out->count++] = name;
  }
  qsort(out->name, out->count, sizeof *out->name, by_word);
  return ETHD_OK;
}

bool ethd__is_absent(const ethd__absent *absent, const char *participant) {
  return absent->count && bsearch(&participant, absent->name, absent->count, sizeof *absent->name, by_word);
}

void ethd__absent_free(ethd__absent *absent) {
  for (size_t i = 0; i < absent->count; i++) free(absent->name[i]);
  free(absent->name);
  *absent = (ethd__absent){0};
}
