/* Pieces of a page that stands alone: no script, no other file. All [main]. */
#ifndef ETHD_REPORT_HTML_H
#define ETHD_REPORT_HTML_H

#include <stdbool.h>
#include <stdio.h>

#include "ethd/config.h"

void ethd__html_begin(FILE *page, const char *title);
void ethd__html_end(FILE *page);

/* &, <, >, quotes as a page needs them. */
void ethd__html_text(FILE *page, const char *text);

void ethd__html_heading(FILE *page, const char *id, const char *text);

/* The PNG itself, within the page, with words for those who can't see it. False: it can't be read. */
bool ethd__html_picture(FILE *page, const char *path, const char *caption);

/* Header cells, then rows: each a list that NULL ends. Cells from `numbers` on are set to the right. */
void ethd__html_table(FILE *page, const char *caption, const char *const *header, int numbers);
void ethd__html_row(FILE *page, const char *const *cells, int numbers);
void ethd__html_table_end(FILE *page);

#endif
