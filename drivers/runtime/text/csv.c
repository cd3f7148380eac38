#include "text/csv.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "text/error_text.h"
#include "text/text.h"

#define BYTES_MAX ((size_t)4 << 30)
#define ROWS_MAX 10000000u
#define WORD_ROWS_MAX 1000u
#define COLUMNS_MAX 1024u

typedef struct cell {
  const char *text;
  size_t length;
} cell;

typedef struct table {
  const char *at, *end; /* of the present line */
  const char *rest, *text_end;
  const char *name;
  size_t line;
  char separator; /* between cells */
  bool more;      /* cells are left in the line */
  bool words;     /* cells are words, not numbers */
  char *message;
} table;

static ethd_status refuse(const table *r, ethd_status status, const char *column, const char *what) {
  return ethd__say(r->message, status, "%s:%zu: %s%s%s", r->name, r->line, column ? column : "", column ? ": " : "",
                   what);
}

static ethd_status no_memory(const table *r) { return ethd__no_memory(r->message, r->name); }

/* ---- lines and cells ---- */

static bool next_line(table *r) {
  if (r->rest >= r->text_end) return false;
  const char *newline = memchr(r->rest, '\n', (size_t)(r->text_end - r->rest));
  r->at = r->rest;
  r->end = newline ? newline : r->text_end;
  r->rest = r->end + 1;
  if (r->end > r->at && r->end[-1] == '\r') r->end--;
  r->line++;
  r->more = true;
  return true;
}

static void trim(cell *c) {
  while (c->length && (*c->text == ' ' || *c->text == '\t')) c->text++, c->length--;
  while (c->length && (c->text[c->length - 1] == ' ' || c->text[c->length - 1] == '\t')) c->length--;
}

/* Reads a cell in quotes. A doubled quote means one but is kept as it is, since no name or number has any. */
static ethd_status quoted_cell(table *r, cell *out) {
  const char *p = r->at + 1;
  while (p < r->end && !(*p == '"' && !(p + 1 < r->end && p[1] == '"'))) p += *p == '"' ? 2 : 1;
  if (p >= r->end) return refuse(r, ETHD_E_SYNTAX, NULL, "a quote that isn't closed on its line");
  *out = (cell){r->at + 1, (size_t)(p - r->at - 1)};
  r->at = p + 1;
  if (r->at < r->end && *r->at != r->separator)
    return refuse(r, ETHD_E_SYNTAX, NULL, "text after a closing quote, a comma is allowed");
  return ETHD_OK;
}

static ethd_status next_cell(table *r, cell *out) {
  if (r->at < r->end && *r->at == '"') {
    ethd_status status = quoted_cell(r, out);
    if (status) return status;
  } else {
    const char *separator = memchr(r->at, r->separator, (size_t)(r->end - r->at));
    *out = (cell){r->at, (size_t)((separator ? separator : r->end) - r->at)};
    r->at += out->length;
  }
  trim(out);
  r->more = r->at < r->end;
  if (r->more) r->at++;
  return ETHD_OK;
}

/* ---- header ---- */

/* map[i]: the column of the i-th cell of a row; -1: the cell isn't kept. */
typedef struct layout {
  size_t cells;
  int map[COLUMNS_MAX];
  char *names[COLUMNS_MAX]; /* of every cell, for messages */
} layout;

static bool is_wanted(const char *const *wanted, const char *name) {
  if (!wanted) return true;
  for (; *wanted; wanted++)
    if (strcmp(*wanted, name) == 0) return true;
  return false;
}

static ethd_status check_name(const table *r, const cell *c, const layout *l) {
  char quote[ETHD_QUOTE_MAX];
  if (!c->length) return refuse(r, ETHD_E_SYNTAX, NULL, "a column without a name; the first line names the columns");
  for (size_t i = 0; i < l->cells; i++)
    if (strlen(l->names[i]) == c->length && memcmp(l->names[i], c->text, c->length) == 0)
      return ethd__say(r->message, ETHD_E_DUPLICATE, "%s:%zu: the column %s occurs twice", r->name, r->line,
                       ethd__quote(c->text, c->length, quote));
  return ETHD_OK;
}

/* Reads a name. Columns that the caller doesn't need may have any name, or none. */
static ethd_status header_name(const table *r, const cell *c, layout *l, const char *const *wanted, ethd_csv *out) {
  char quote[ETHD_QUOTE_MAX];
  double number;
  if (!l->cells && ethd__number(c->text, c->length, &number))
    return ethd__say(r->message, ETHD_E_SYNTAX, "%s:%zu: found %s, but the first line must name the columns", r->name,
                     r->line, ethd__quote(c->text, c->length, quote));
  if (l->cells == COLUMNS_MAX) return refuse(r, ETHD_E_RANGE, NULL, "over 1024 columns");
  char *name = strndup(c->text, c->length);
  if (!name) return no_memory(r);
  bool kept = is_wanted(wanted, name);
  ethd_status status = kept ? check_name(r, c, l) : ETHD_OK;
  if (status) {
    free(name);
    return status;
  }
  l->map[l->cells] = kept ? (int)out->columns++ : -1;
  l->names[l->cells++] = name;
  return ETHD_OK;
}

static ethd_status keep_names(const table *r, const layout *l, ethd_csv *out) {
  out->names = calloc(out->columns + 1, sizeof *out->names);
  if (!out->names) return no_memory(r);
  for (size_t i = 0; i < l->cells; i++)
    if (l->map[i] >= 0 && !(out->names[l->map[i]] = strdup(l->names[i]))) return no_memory(r);
  return ETHD_OK;
}

static char separator_of(const char *header, size_t length) {
  if (memchr(header, ',', length)) return ',';
  return memchr(header, ';', length) ? ';' : memchr(header, '\t', length) ? '\t' : ',';
}

static ethd_status read_header(table *r, layout *l, const char *const *wanted, ethd_csv *out) {
  static const char motive[] = "Format Version,"; /* of OptiTrack's motion capture */
  cell c;
  if (!next_line(r))
    return ethd__say(r->message, ETHD_E_SYNTAX, "%s: is empty; a first line that names the columns is needed", r->name);
  if ((size_t)(r->end - r->at) > sizeof motive && !memcmp(r->at, motive, sizeof motive - 1))
    return refuse(
        r, ETHD_E_SYNTAX, NULL,
        "an export of Motive; delete the lines above \"Frame,Time (Seconds)\" and the other markers' columns");
  r->separator = separator_of(r->at, (size_t)(r->end - r->at));
  while (r->more) {
    ethd_status status = next_cell(r, &c);
    if (!status) status = header_name(r, &c, l, wanted, out);
    if (status) return status;
  }
  return keep_names(r, l, out);
}

/* ---- rows ---- */

/* Between semicolons and tabs, a decimal comma is a point. */
static bool read_number(const table *r, const cell *c, double *out) {
  char text[64] = "";
  if (r->separator == ',' || c->length >= sizeof text) return ethd__number(c->text, c->length, out);
  for (size_t i = 0; i < c->length; i++) text[i] = c->text[i] == ',' ? '.' : c->text[i];
  return ethd__number(text, c->length, out);
}

static ethd_status store_word(const table *r, const cell *c, const char *column, size_t index, ethd_csv *out) {
  if (!c->length || c->length > ETHD_CSV_WORD)
    return ethd__say(r->message, ETHD_E_RANGE, "%s:%zu: %.40s: a cell of %zu bytes; 1 to %d are allowed", r->name,
                     r->line, column, c->length, ETHD_CSV_WORD);
  out->words[index] = strndup(c->text, c->length);
  return out->words[index] ? ETHD_OK : no_memory(r);
}

static ethd_status store(const table *r, const cell *c, const char *column, size_t index, ethd_csv *out) {
  char quote[ETHD_QUOTE_MAX];
  if (r->words) return store_word(r, c, column, index, out);
  if (!c->length) {
    out->values[index] = NAN;
    out->empties[index / 8] |= (unsigned char)(1u << index % 8);
    return ETHD_OK;
  }
  if (read_number(r, c, &out->values[index]) && !isinf(out->values[index])) return ETHD_OK;
  return ethd__say(r->message, ETHD_E_SYNTAX, "%s:%zu: %s: found %s, a finite decimal number is allowed", r->name,
                   r->line, column, ethd__quote(c->text, c->length, quote));
}

static ethd_status read_row(table *r, const layout *l, ethd_csv *out) {
  size_t i = 0;
  cell c;
  for (; r->more; i++) {
    ethd_status status = next_cell(r, &c);
    if (status) return status;
    if (i < l->cells && l->map[i] >= 0)
      status = store(r, &c, l->names[i], out->rows * out->columns + (size_t)l->map[i], out);
    if (status) return status;
  }
  if (i != l->cells)
    return ethd__say(r->message, ETHD_E_SYNTAX, "%s:%zu: %zu cell%s, the header names %zu column%s", r->name, r->line,
                     i, ethd__s(i), l->cells, ethd__s(l->cells));
  out->rows++;
  return ETHD_OK;
}

static size_t count_lines(const char *p, const char *end) {
  size_t n = 0;
  for (; p < end; n++) {
    const char *newline = memchr(p, '\n', (size_t)(end - p));
    p = newline ? newline + 1 : end;
  }
  return n;
}

static ethd_status read_rows(table *r, const layout *l, ethd_csv *out) {
  size_t room = count_lines(r->rest, r->text_end);
  const unsigned most = r->words ? WORD_ROWS_MAX : ROWS_MAX;
  if (room > most)
    return ethd__say(r->message, ETHD_E_RANGE, "%s: %zu rows, at most %u are allowed", r->name, room, most);
  out->values = malloc((room * out->columns + 1) * sizeof *out->values);
  out->empties = calloc(room * out->columns / 8 + 1, 1);
  if (r->words) out->words = calloc((room + 1) * out->columns + 1, sizeof *out->words);
  if (!out->values || !out->empties || (r->words && !out->words)) return no_memory(r);
  while (next_line(r)) {
    if (r->at == r->end && l->cells > 1) return refuse(r, ETHD_E_SYNTAX, NULL, "a blank line");
    ethd_status status = read_row(r, l, out);
    if (status) return status;
  }
  return ETHD_OK;
}

/* ---- files ---- */

static ethd_status check_text(const table *r) {
  const char *zero = memchr(r->rest, 0, (size_t)(r->text_end - r->rest));
  if (!zero) return ETHD_OK;
  return ethd__say(r->message, ETHD_E_SYNTAX, "%s:%zu: a byte 0: this isn't text", r->name,
                   count_lines(r->rest, zero) + (zero == r->rest || zero[-1] == '\n'));
}

static ethd_status parse(const char *text, size_t length, const char *name, const char *const *wanted, bool words,
                         ethd_csv *out, char *message) {
  table r = {.rest = text, .text_end = text + length, .name = name, .words = words, .message = message};
  ETHD__FREED layout *l = calloc(1, sizeof *l);
  *out = (ethd_csv){.path = strdup(name)};
  ethd_status status = l && out->path ? check_text(&r) : no_memory(&r);
  if (length >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) r.rest += 3;
  if (!status) status = read_header(&r, l, wanted, out);
  if (!status) status = read_rows(&r, l, out);
  for (size_t i = 0; l && i < l->cells; i++) free(l->names[i]);
  if (status) ethd_csv_free(out);
  return status;
}

ethd_status ethd_csv_parse(const char *text, size_t length, const char *name, const char *const *wanted, ethd_csv *out,
                           char message[ETHD_MESSAGE_MAX]) {
  return parse(text, length, name, wanted, false, out, message);
}

static ethd_status read_file(const char *path, const char *const *wanted, bool words, ethd_csv *out, char *message) {
  ETHD__FREED char *text = NULL;
  size_t length;
  *out = (ethd_csv){0};
  ethd_status status = ethd_text_read(path, BYTES_MAX, &text, &length, message);
  return status ? status : parse(text, length, path, wanted, words, out, message);
}

ethd_status ethd_csv_read_columns(const char *path, const char *const *wanted, ethd_csv *out,
                                  char message[ETHD_MESSAGE_MAX]) {
  return read_file(path, wanted, false, out, message);
}

ethd_status ethd_csv_read_words(const char *path, ethd_csv *out, char message[ETHD_MESSAGE_MAX]) {
  return read_file(path, NULL, true, out, message);
}

int ethd_csv_column(const ethd_csv *csv, const char *name) {
  for (size_t i = 0; i < csv->columns; i++)
    if (strcmp(csv->names[i], name) == 0) return (int)i;
  return -1;
}

void ethd_csv_free(ethd_csv *csv) {
  for (size_t i = 0; csv->names && i < csv->columns; i++) free(csv->names[i]);
  free(csv->names);
  for (size_t i = 0; csv->words && i < (csv->rows + 1) * csv->columns; i++) free(csv->words[i]);
  free(csv->words);
  free(csv->values);
  free(csv->empties);
  free(csv->path);
  *csv = (ethd_csv){0};
}
