#include "report/absent.h"

#include <stdlib.h>
#include <string.h>

#include "text/error_text.h"

static int by_word(const void *a, const void *b) { return strcmp(*(const char *const *)a, *(const char *const *)b); }

ethd_status ethd__absent_take(ethd__data *data, const ethd__sheet *participants, char message[ETHD_MESSAGE_MAX]) {
  int id = ethd__sheet_column(participants, "participant"), analysed = ethd__sheet_column(participants, "analysed");
  data->absent = calloc(participants->rows + 1, sizeof *data->absent);
  if (!data->absent) return ethd__no_memory(message, participants->path);
  for (size_t row = 0; analysed >= 0 && row < participants->rows; row++) {
    if (strcmp(ethd__sheet_cell(participants, row, analysed), "0") != 0) continue;
    char *name = strdup(ethd__sheet_cell(participants, row, id)); /* the sheet goes first */
    if (!name) return ethd__no_memory(message, participants->path);
    data->absent[data->absent_count++] = name;
  }
  qsort(data->absent, data->absent_count, sizeof *data->absent, by_word);
  return ETHD_OK;
}

bool ethd__absent(const ethd__data *data, const char *participant) {
  return data->absent_count && bsearch(&participant, data->absent, data->absent_count, sizeof *data->absent, by_word);
}

void ethd__absent_free(ethd__data *data) {
  for (size_t i = 0; i < data->absent_count; i++) free(data->absent[i]);
  free(data->absent);
  data->absent = NULL;
  data->absent_count = 0;
}
