#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "text/csv.h"
#include "text/error_text.h"
#include "text/text.h"

struct ethd_csv_out {
  ethd_replace replace;
  size_t columns, cell, row;
  bool ragged;
};

ethd_csv_out *ethd_csv_create(const char *path, const char *header, char message[ETHD_MESSAGE_MAX]) {
  ethd_csv_out *out = calloc(1, sizeof *out);
  if (!out) {
    (void)ethd__no_memory(message, path);
    return NULL;
  }
  if (ethd_replace_begin(path, &out->replace, message)) {
    free(out);
    return NULL;
  }
  out->columns = 1;
  for (const char *p = header; *p; p++) out->columns += *p == ',';
  fprintf(out->replace.file, "%s\n", header);
  return out;
}

static FILE *next_cell(ethd_csv_out *out) {
  if (out->cell++) putc(',', out->replace.file);
  return out->replace.file;
}

void ethd_csv_number(ethd_csv_out *out, double value) {
  FILE *file = next_cell(out);
  if (!isnan(value)) fprintf(file, "%.17g", value);
}

void ethd_csv_integer(ethd_csv_out *out, int64_t value) { fprintf(next_cell(out), "%" PRId64, value); }

static bool is_control(char c) { return (unsigned char)c < ' ' || c == 0x7f; }

static bool needs_quotes(const char *word) {
  for (; *word; word++)
    if (strchr(",\"", *word) || is_control(*word)) return true;
  return false;
}

void ethd__csv_put_word(FILE *file, const char *word) {
  if (!needs_quotes(word)) {
    fputs(word, file);
    return;
  }
  putc('"', file);
  for (; *word; word++) {
    if (*word == '"') putc('"', file);
    putc(is_control(*word) ? ' ' : *word, file);
  }
  putc('"', file);
}

void ethd_csv_word(ethd_csv_out *out, const char *word) { ethd__csv_put_word(next_cell(out), word); }

void ethd_csv_text(ethd_csv_out *out, const char *text) {
  ETHD__FREED char *plain = NULL;
  double number;
  if (!*text || !text[1] || ethd__number(text, strlen(text), &number) || !strchr("=+-@", *text) ||
      asprintf(&plain, "'%s", text) < 0) {
    ethd_csv_word(out, text);
    return;
  }
  ethd_csv_word(out, plain);
}

void ethd_csv_row(ethd_csv_out *out) {
  out->ragged |= out->cell != out->columns;
  out->cell = 0;
  out->row++;
  putc('\n', out->replace.file);
}

ethd_status ethd_csv_close(ethd_csv_out *out, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status;
  if (out->ragged || out->cell) {
    status = ethd__say(message, ETHD_E_ARGUMENT, "%s: a row without the %zu cells of the header",
                       out->replace.path ? out->replace.path : "output", out->columns);
    ethd_replace_abandon(&out->replace);
  } else {
    status = ethd_replace_commit(&out->replace, message);
  }
  free(out);
  return status;
}

void ethd_csv_abandon(ethd_csv_out *out) {
  if (!out) return;
  ethd_replace_abandon(&out->replace);
  free(out);
}
