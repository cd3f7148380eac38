#include "report/gather.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "study/folder.h"
#include "text/error_text.h"
#include "text/text.h"

#define BYTES_MAX ((size_t)1 << 32)

/* The text of folder/name, NULL without such a file. */
static ethd_status read_text(const char *folder, const char *name, char **text, size_t *length, char *message) {
  char *path = ethd__folder_path(folder, name);
  *text = NULL;
  ethd_status status = access(path, F_OK) == 0 ? ethd_text_read(path, BYTES_MAX, text, length, message) : ETHD_OK;
  free(path);
  return status;
}

static size_t header_of(const char *text, size_t length) {
  const char *end = memchr(text, '\n', length);
  return end ? (size_t)(end - text) + 1 : length;
}

/* Adds a table below those that there are; the first one with its header. */
static ethd_status add(FILE *all, const char *folder, const char *name, char **first, char *message) {
  char *text;
  size_t length;
  ethd_status status = read_text(folder, name, &text, &length, message);
  if (status || !text) return status;
  size_t header = header_of(text, length);
  if (!*first) {
    *first = strndup(text, header);
    if (!*first) ethd__fail_memory();
    fwrite(text, 1, length, all);
  } else if (header != strlen(*first) || memcmp(*first, text, header) != 0) {
    status = ethd__say(message, ETHD_E_SYNTAX, "%s/%s: its columns are other ones than those of the first folder",
                       folder, name);
  } else {
    fwrite(text + header, 1, length - header, all);
  }
  free(text);
  return status;
}

ethd_status ethd__gather(const ethd__stations *stations, const char *name, ethd__sheet *out,
                         char message[ETHD_MESSAGE_MAX]) {
  char *text = NULL, *first = NULL;
  size_t length = 0;
  ethd_status status = ETHD_OK;
  FILE *all = open_memstream(&text, &length);
  if (!all) ethd__fail_memory();
  *out = (ethd__sheet){0};
  for (size_t i = 0; !status && i < stations->count; i++) status = add(all, stations->folder[i], name, &first, message);
  if (fclose(all)) ethd__fail_memory();
  char *path = ethd__folder_path(stations->folder[0], name);
  if (!status && first) status = ethd__sheet_parse(text, length, path, out, message);
  free(path);
  free(text);
  free(first);
  return status;
}

/* ---- one participant, one folder ---- */

typedef struct tapped_at {
  const char *id;
  size_t folder;
} tapped_at;

static int by_id(const void *a, const void *b) {
  return strcmp(((const tapped_at *)a)->id, ((const tapped_at *)b)->id);
}

/* Each folder's participants once; their names belong to the sheets. */
static size_t list_people(const ethd__sheet *sheet, size_t folder, tapped_at *out) {
  int column = ethd__sheet_column(sheet, "participant");
  size_t n = 0;
  for (size_t row = 0; row < sheet->rows; row++) {
    const char *id = ethd__sheet_cell(sheet, row, column);
    if (!n || strcmp(out[n - 1].id, id)) out[n++] = (tapped_at){id, folder};
  }
  return n;
}

ethd_status ethd__gather_check(const ethd__stations *stations, const char *name, char message[ETHD_MESSAGE_MAX]) {
  ethd__sheet *sheet = calloc(stations->count, sizeof *sheet);
  size_t rows = 0, n = 0;
  ethd_status status = ETHD_OK;
  if (!sheet) ethd__fail_memory();
  for (size_t i = 0; !status && i < stations->count; i++) {
    const ethd__stations one = {&stations->folder[i], 1};
    status = ethd__gather(&one, name, &sheet[i], message);
    rows += sheet[i].rows;
  }
  tapped_at *all = malloc((rows + 1) * sizeof *all);
  if (!all) ethd__fail_memory();
  for (size_t i = 0; !status && i < stations->count; i++) n += list_people(&sheet[i], i, all + n);
  qsort(all, n, sizeof *all, by_id);
  for (size_t i = 1; !status && i < n; i++)
    if (!strcmp(all[i].id, all[i - 1].id) && all[i].folder != all[i - 1].folder)
      status = ethd__say(message, ETHD_E_DUPLICATE,
                         "%s and %s: participant %s has tapped in both; one participant, one folder",
                         stations->folder[all[i - 1].folder], stations->folder[all[i].folder], all[i].id);
  free(all);
  for (size_t i = 0; i < stations->count; i++) ethd__sheet_free(&sheet[i]);
  free(sheet);
  return status;
}
