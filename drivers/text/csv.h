/* CSV: one header row of names, then rows of numbers; ',' between, LF or CRLF at the end of each line.
   All [main]. */
#ifndef ETHD_FILE_CSV_H
#define ETHD_FILE_CSV_H

#include <stdbool.h>
#include <stdio.h>

#include "ethd/config.h"

typedef struct ethd_csv {
  size_t rows, columns;
  char **names;
  double *values;         /* values[row * columns + column]; NaN for "nan" and for an empty cell */
  unsigned char *empties; /* a bit per cell */
  char *path;             /* for messages */
} ethd_csv;

/* Every column must hold numbers. Refuses, with file:line: column: ragged and blank lines, a column
   twice, a file without a header, bytes that are no text, words, hex, trailing junk, "inf", over 1e7
   rows. An empty cell passes: ethd_csv_empty. */
ETHD_MUST_CHECK ethd_status ethd_csv_read(const char *path, ethd_csv *out, char message[ETHD_MESSAGE_MAX]);

/* The same, keeping only columns named in `wanted` (ends with NULL); the others may have any name, or
   none, and hold anything. A wanted column that the file hasn't is no error: ethd_csv_column says -1. */
ETHD_MUST_CHECK ethd_status ethd_csv_read_columns(const char *path, const char *const *wanted, ethd_csv *out,
                                                  char message[ETHD_MESSAGE_MAX]);

/* The same from text with a 0 at text[length]; `name` stands for the file; wanted NULL: all. */
ETHD_MUST_CHECK ethd_status ethd_csv_parse(const char *text, size_t length, const char *name, const char *const *wanted,
                                           ethd_csv *out, char message[ETHD_MESSAGE_MAX]);

/* Index of a column, -1 if the file hasn't it. */
int ethd_csv_column(const ethd_csv *csv, const char *name);

bool ethd_csv_empty(const ethd_csv *csv, size_t row, int column);

/* Line of the file that a row stands on. */
static inline size_t ethd_csv_line(size_t row) { return row + 2; }

void ethd_csv_free(ethd_csv *csv);

/* ---- writing: the file takes its path's place when it is closed ---- */

typedef struct ethd_csv_out ethd_csv_out;

/* header: "t_s,x_m". NULL on failure, which message explains. */
ethd_csv_out *ethd_csv_create(const char *path, const char *header, char message[ETHD_MESSAGE_MAX]);

/* The next cell of a row. Numbers have 17 significant digits; NaN leaves the cell empty. */
void ethd_csv_number(ethd_csv_out *out, double value);
void ethd_csv_integer(ethd_csv_out *out, int64_t value);
void ethd_csv_word(ethd_csv_out *out, const char *word);
/* Words for people that nothing of ours reads back: spreadsheets take a cell that begins with = + - @ for a formula,
   so an apostrophe goes before it, unless it is a number. */
void ethd_csv_text(ethd_csv_out *out, const char *text);
/* A word as a cell: in quotes when it has to be, control characters as spaces. */
void ethd__csv_put_word(FILE *file, const char *word);
/* Ends the row, which must have as many cells as the header has names. */
void ethd_csv_row(ethd_csv_out *out);

/* Puts the file in its place and frees; reports whatever went wrong while writing. */
ETHD_MUST_CHECK ethd_status ethd_csv_close(ethd_csv_out *out, char message[ETHD_MESSAGE_MAX]);
/* Frees and leaves what was there before. NULL is fine. */
void ethd_csv_abandon(ethd_csv_out *out);

#endif
