/* Pieces of a page that stands alone: no script, no other file. Whatever isn't markup of our own is escaped here, and
   nothing else writes to a page. All [main]. */
#ifndef ETHD__APPS_REPORT_HTML_H
#define ETHD__APPS_REPORT_HTML_H

#include <stdbool.h>
#include <stdio.h>

#include "ethd/config.h"

typedef struct ethd__html {
  FILE *file; /* of html.c alone */
} ethd__html;

void ethd__html_begin(ethd__html *page, const char *title);
void ethd__html_end(ethd__html *page);

/* Writes markup that stands in our source. */
void ethd__html_markup(ethd__html *page, const char *literal);

/* Appends what was written to another page. */
void ethd__html_append(ethd__html *page, const char *written, size_t length);

/* Prints like printf with %s, %d, %u, %zu, %llu, %g: the format is our markup, each %s is text and is escaped. */
void ethd__html_print(ethd__html *page, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Writes text, with &, <, > and quotes escaped, and control characters as ?. */
void ethd__html_text(ethd__html *page, const char *text);

void ethd__html_heading(ethd__html *page, const char *id, const char *text);

/* Puts the PNG itself into the page, with words for those who can't see it. False: it can't be read. */
bool ethd__html_picture(ethd__html *page, const char *path, const char *caption);

/* Begins a table with its header cells; rows follow. Each is a list that NULL ends. Cells from `numbers` on are aligned
   to the right. */
void ethd__html_table(ethd__html *page, const char *caption, const char *const *header, int numbers);
void ethd__html_row(ethd__html *page, const char *const *cells, int numbers);
/* Writes one cell over so many columns, which says what the rows below it are about. */
void ethd__html_span(ethd__html *page, const char *text, int columns);
void ethd__html_table_end(ethd__html *page);

#endif
