#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study/row.h"
#include "study/session.h"
#include "text/text.h"

static const struct {
  const char *file, *header, *kind;
} tables[] = {
    {ETHD_STUDY_TAPS, ETHD_STUDY_TAPS_HEADER, "tap"},
    {ETHD_STUDY_SURVEY, ETHD_STUDY_SURVEY_HEADER, "survey"},
    {ETHD_STUDY_EVENTS, ETHD_STUDY_EVENTS_HEADER, "event"},
};

static ethd_status write_table(const char *folder, int table, const ethd__journal *journal, char *message) {
  char *path = ethd__folder_path(folder, tables[table].file);
  ethd_replace replace;
  ethd_status status = ethd_replace_begin(path, &replace, message);
  free(path);
  if (status) return status;
  fprintf(replace.file, "%s\n", tables[table].header);
  for (size_t i = 0; i < journal->count; i++)
    if (!strcmp(journal->lines[i].kind, tables[table].kind)) fprintf(replace.file, "%s\n", journal->lines[i].text);
  return ethd_replace_commit(&replace, message);
}

ethd_status ethd__tables_write(const char *folder, char message[ETHD_MESSAGE_MAX]) {
  ethd__journal journal;
  char *path = ethd__folder_path(folder, ETHD_STUDY_JOURNAL);
  ethd_status status = ethd__journal_read(path, &journal, message);
  free(path);
  if (status) return status;
  for (int i = 0; !status && i < (int)(sizeof tables / sizeof *tables); i++)
    status = write_table(folder, i, &journal, message);
  ethd__journal_close(&journal);
  return status;
}
