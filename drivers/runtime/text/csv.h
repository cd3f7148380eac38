/* CSV: a header row of names, then rows of numbers, with LF or CRLF at the end of each line. Cells are separated by
   commas; if the header has no comma, by semicolons or tabs, and numbers may have a decimal comma. All [main]. */
#ifndef ETHD__TEXT_CSV_H
#define ETHD__TEXT_CSV_H

#include <stdbool.h>
#include <stdio.h>

#include "ethd/config.h"

typedef struct ethd_csv {
  size_t rows, columns;
  char **names;
  double *values;         /* values[row * columns + column]; NaN for "nan" and for an empty cell */
  unsigned char *empties; /* a bit per cell */
  char **words;           /* of ethd_csv_read_words, in the place of values */
  char *path;             /* for messages */
} ethd_csv;

/* Reads the columns named in `wanted` (ends with NULL), which hold numbers; the others may have any name, or none, and
   hold anything. A wanted column may be missing: ethd_csv_column then returns -1. NULL: all columns. Refuses, with
   file:line: column: ragged and blank lines, a column that occurs twice, a file without a header, bytes that aren't text,
   words, hex, trailing junk, "inf", over 1e7 rows. A cell may be empty: ethd_csv_empty. */
ETHD_MUST_CHECK ethd_status ethd_csv_read_columns(const char *path, const char *const *wanted, ethd_csv *out,
                                                  char message[ETHD_MESSAGE_MAX]);

static inline ETHD_MUST_CHECK ethd_status ethd_csv_read(const char *path, ethd_csv *out,
                                                        char message[ETHD_MESSAGE_MAX]) {
  return ethd_csv_read_columns(path, NULL, out, message);
}

/* Reads from text with a 0 at text[length]; messages call it `name`; wanted NULL: all columns. */
ETHD_MUST_CHECK ethd_status ethd_csv_parse(const char *text, size_t length, const char *name, const char *const *wanted,
                                           ethd_csv *out, char message[ETHD_MESSAGE_MAX]);

/* Reads a file whose columns all hold words of at most ETHD_CSV_WORD bytes; refuses longer and empty cells, too,
   and over 1000 rows. */
#define ETHD_CSV_WORD 64
ETHD_MUST_CHECK ethd_status ethd_csv_read_words(const char *path, ethd_csv *out, char message[ETHD_MESSAGE_MAX]);

/* Returns the index of a column, -1 if the file doesn't have it. */
int ethd_csv_column(const ethd_csv *csv, const char *name);

static inline bool ethd_csv_empty(const ethd_csv *csv, size_t row, int column) {
  size_t index = row * csv->columns + (size_t)column;
  return csv->empties[index / 8] >> index % 8 & 1;
}

/* Returns the line of the file on which a row is. */
static inline size_t ethd_csv_line(size_t row) { return row + 2; }

void ethd_csv_free(ethd_csv *csv);

/* ---- writing: the file takes its path's place when it is closed ---- */

typedef struct ethd_csv_out ethd_csv_out;

/* Creates a file with this header ("t_s,x_m"); returns NULL on failure, which message explains. */
ethd_csv_out *ethd_csv_create(const char *path, const char *header, char message[ETHD_MESSAGE_MAX]);

/* Writes a number, with 17 significant digits, as the next cell of a row; NaN leaves the cell empty. */
void ethd_csv_number(ethd_csv_out *out, double value);
void ethd_csv_integer(ethd_csv_out *out, int64_t value);
void ethd_csv_word(ethd_csv_out *out, const char *word);
/* Writes words for people, which no program of ours reads back. Spreadsheets take a cell that begins with = + - @ for a
   formula, so an apostrophe is put before it unless it is a number. */
void ethd_csv_text(ethd_csv_out *out, const char *text);
/* Writes a word as a cell, in quotes if necessary and with control characters as spaces. */
void ethd__csv_put_word(FILE *file, const char *word);
/* Ends the row, which must have as many cells as the header has names. */
void ethd_csv_row(ethd_csv_out *out);

/* Puts the file in its place and frees; reports whatever went wrong while writing. */
ETHD_MUST_CHECK ethd_status ethd_csv_close(ethd_csv_out *out, char message[ETHD_MESSAGE_MAX]);
/* Frees and leaves what was there before; NULL is allowed. */
void ethd_csv_abandon(ethd_csv_out *out);

#endif
