#include "report/sheet.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "text/error_text.h"
#include "text/text.h"

#define BYTES_MAX ((size_t)1 << 32)

/* The position at which the text is split, in place. */
typedef struct scan {
  char *at, *end;
  size_t line;
  bool more, open_quote; /* more: cells in this row */
} scan;

/* Returns the next cell and ends it with a 0 byte. */
static char *next_cell(scan *s) {
  char *cell = s->at, *to = s->at;
  bool quoted = s->at < s->end && *s->at == '"';
  bool row_over = false;
  s->at += quoted;
  s->more = false;
  while (s->at < s->end) {
    char c = *s->at++;
    if (quoted && c == '"') {
      quoted = s->at < s->end && *s->at == '"';
      if (quoted) *to++ = *s->at++;
      continue;
    }
    if (!quoted && (c == ',' || c == '\n')) {
      s->more = c == ',';
      row_over = !s->more;
      break;
    }
    *to++ = c;
  }
  s->open_quote |= quoted;
  if (to > cell && to[-1] == '\r' && row_over) to--;
  *to = 0;
  return cell;
}

static size_t most_cells(const char *text, size_t length) {
  size_t n = 2;
  for (size_t i = 0; i < length; i++) n += text[i] == ',' || text[i] == '\n';
  return n;
}

static ethd_status part(ethd__sheet *sheet, size_t length, char *message) {
  scan s = {sheet->text, sheet->text + length, 0, false, false};
  size_t total = 0;
  while (s.at < s.end) {
    size_t before = total;
    s.line++;
    do sheet->cell[total++] = next_cell(&s);
    while (s.more);
    if (s.open_quote)
      return ethd__say(message, ETHD_E_SYNTAX, "%s:%zu: a quote that isn't closed", sheet->path, s.line);
    if (!sheet->columns) sheet->columns = total;
    if (total - before != sheet->columns)
      return ethd__say(message, ETHD_E_SYNTAX, "%s:%zu: %zu cell%s, the header has %zu", sheet->path, s.line,
                       total - before, ethd__s(total - before), sheet->columns);
  }
  sheet->rows = total / sheet->columns - 1;
  return ETHD_OK;
}

ethd_status ethd__sheet_parse(const char *text, size_t length, const char *name, ethd__sheet *out,
                              char message[ETHD_MESSAGE_MAX]) {
  *out = (ethd__sheet){.path = strdup(name), .text = malloc(length + 1)};
  out->cell = calloc(most_cells(text, length), sizeof *out->cell);
  ethd_status status = ETHD_OK;
  if (!out->path || !out->text || !out->cell)
    status = ethd__no_memory(message, name);
  else if (!length)
    status = ethd__say(message, ETHD_E_SYNTAX, "%s: is empty", name);
  else if (memchr(text, 0, length))
    status = ethd__say(message, ETHD_E_SYNTAX, "%s: a byte 0: this isn't text", name);
  if (!status) {
    memcpy(out->text, text, length);
    out->text[length] = 0;
    status = part(out, length, message);
  }
  if (status) ethd__sheet_free(out);
  return status;
}

ethd_status ethd__sheet_read(const char *path, ethd__sheet *out, char message[ETHD_MESSAGE_MAX]) {
  char *text;
  size_t length;
  *out = (ethd__sheet){0};
  ethd_status status = ethd_text_read(path, BYTES_MAX, &text, &length, message);
  if (!status) status = ethd__sheet_parse(text, length, path, out, message);
  free(text);
  return status;
}

void ethd__sheet_free(ethd__sheet *sheet) {
  free(sheet->path);
  free(sheet->text);
  free(sheet->cell);
  *sheet = (ethd__sheet){0};
}

int ethd__sheet_column(const ethd__sheet *sheet, const char *name) {
  for (size_t i = 0; i < sheet->columns; i++)
    if (!strcmp(sheet->cell[i], name)) return (int)i;
  return -1;
}

const char *ethd__sheet_cell(const ethd__sheet *sheet, size_t row, int column) {
  return column < 0 ? "" : sheet->cell[(row + 1) * sheet->columns + (size_t)column];
}

bool ethd__sheet_number(const ethd__sheet *sheet, size_t row, int column, double *out) {
  const char *cell = ethd__sheet_cell(sheet, row, column);
  *out = NAN;
  return !*cell || ethd__number(cell, strlen(cell), out);
}
