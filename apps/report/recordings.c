#include "report/recordings.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "study/folder.h"
#include "text/file.h"

static bool holds_taps(const char *name) {
  unsigned index, of;
  char rest;
  return !strcmp(name, ETHD_STUDY_RECORDINGS) ||
         sscanf(name, ETHD_STUDY_RECORDINGS "-%u-of-%u%c", &index, &of, &rest) == 2;
}

static int by_name(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

static void find_in(const char *study, ethd__recordings *out) {
  DIR *folder = ethd__file_list(study);
  const struct dirent *entry;
  size_t first = out->count;
  while (folder && (entry = readdir(folder))) {
    if (!holds_taps(entry->d_name)) continue;
    char **longer = realloc(out->folder, (out->count + 1) * sizeof *longer);
    if (!longer) ethd__fail_memory();
    out->folder = longer;
    out->folder[out->count++] = ethd__folder_path(study, entry->d_name);
  }
  if (folder) closedir(folder);
  if (out->count > first) qsort(out->folder + first, out->count - first, sizeof *out->folder, by_name);
}

void ethd__recordings_find(const ethd__stations *stations, ethd__recordings *out) {
  *out = (ethd__recordings){0};
  for (size_t i = 0; i < stations->count; i++) find_in(stations->folder[i], out);
}

void ethd__recordings_free(ethd__recordings *r) {
  for (size_t i = 0; i < r->count; i++) free(r->folder[i]);
  free(r->folder);
  *r = (ethd__recordings){0};
}

void ethd__recording_name(const ethd__sheet *sheet, size_t row, char out[ETHD_FILE_NAME_MAX]) {
  char block[16], attempt[16];
  int point = ethd__sheet_column(sheet, "point");
  snprintf(block, sizeof block, "%02d", atoi(ethd__sheet_cell(sheet, row, ethd__sheet_column(sheet, "block"))));
  snprintf(attempt, sizeof attempt, "%03d", atoi(ethd__sheet_cell(sheet, row, ethd__sheet_column(sheet, "attempt"))));
  const char *words[] = {ethd__sheet_cell(sheet, row, point),
                         ethd__sheet_cell(sheet, row, ethd__sheet_column(sheet, "participant")), block, attempt, NULL};
  ethd__file_name(point < 0 ? words + 1 : words, "", out);
}

char *ethd__recording_path(const ethd__recordings *r, const char *name) {
  for (size_t i = 0; i < r->count; i++) {
    char *path = ethd__folder_path(r->folder[i], name);
    if (ethd__file_taken(path)) return path;
    free(path);
  }
  return NULL;
}
