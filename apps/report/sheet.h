/* A CSV file of words: one header row, cells by name. All [main]. */
#ifndef ETHD__APPS_REPORT_SHEET_H
#define ETHD__APPS_REPORT_SHEET_H

#include <stdbool.h>
#include <stddef.h>

#include "ethd/config.h"

typedef struct ethd__sheet {
  char *path, *text;
  const char **cell;    /* row 0 is the header */
  size_t rows, columns; /* rows without the header */
} ethd__sheet;

/* Reads a file. Refuses, with file:line: ragged rows, a file without a header, bytes 0, a quote that isn't closed. */
ETHD_MUST_CHECK ethd_status ethd__sheet_read(const char *path, ethd__sheet *out, char message[ETHD_MESSAGE_MAX]);
ETHD_MUST_CHECK ethd_status ethd__sheet_parse(const char *text, size_t length, const char *name, ethd__sheet *out,
                                              char message[ETHD_MESSAGE_MAX]);
void ethd__sheet_free(ethd__sheet *sheet);

/* Returns the column of that name; -1: there is none. */
int ethd__sheet_column(const ethd__sheet *sheet, const char *name);

/* Returns a cell; "" where column is -1. Rows count from 0. */
const char *ethd__sheet_cell(const ethd__sheet *sheet, size_t row, int column);

/* Reads a cell's number: NaN if the cell is empty or the column is -1. False: it holds something else. */
bool ethd__sheet_number(const ethd__sheet *sheet, size_t row, int column, double *out);

#endif
