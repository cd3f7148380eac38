/* A session's journal: what has happened, in order, a line each; whatever else is in the folder follows from it.

     KIND TEXT #8 hex digits        of the SHA-256 of "KIND TEXT"

   begin    the hash of the study's inputs        tap      a row of taps.csv
   hand     who leads the hand                    answer   participant,block,question,answer
   event    a row of events.csv                   survey   a row of survey.csv: its answers were confirmed

   Lines are appended whole and reach the disk before the next step is taken. A line that a crash has torn is
   the last one: it is cut off. A broken line before good ones is damage, and refused. All [main]. */
#ifndef ETHD__APPS_STUDY_JOURNAL_H
#define ETHD__APPS_STUDY_JOURNAL_H

#include <stdbool.h>
#include <stdio.h>

#include "ethd/config.h"

typedef struct ethd__journal_line {
  const char *kind, *text;
} ethd__journal_line;

typedef struct ethd__journal {
  int fd;
  char *path, *text; /* text: what stood there when it was opened; the lines point into it */
  ethd__journal_line *lines;
  size_t count;
  uint64_t length; /* bytes of the file that count */
  bool cut;        /* a torn line was cut off */
} ethd__journal;

/* Creates a new journal, whose file must not exist, and locks it against other programs. */
ETHD_MUST_CHECK ethd_status ethd__journal_create(const char *path, ethd__journal *out, char message[ETHD_MESSAGE_MAX]);

/* Opens a journal to go on with it, and locks it likewise. */
ETHD_MUST_CHECK ethd_status ethd__journal_open(const char *path, ethd__journal *out, char message[ETHD_MESSAGE_MAX]);

/* Opens the journal for reading only: lines that come later are missing, nothing is cut or locked. */
ETHD_MUST_CHECK ethd_status ethd__journal_read(const char *path, ethd__journal *out, char message[ETHD_MESSAGE_MAX]);

/* Reads a journal from text, which becomes the journal's own; messages call it `name`. */
ETHD_MUST_CHECK ethd_status ethd__journal_parse(char *text, size_t length, const char *name, ethd__journal *out,
                                                char message[ETHD_MESSAGE_MAX]);

/* Appends a line; `text` has no line ends. On failure the file is as it was. */
ETHD_MUST_CHECK ethd_status ethd__journal_append(ethd__journal *journal, const char *kind, const char *text,
                                                 char message[ETHD_MESSAGE_MAX]);

/* Writes such a line into another file, which will be a journal. */
void ethd__journal_print(FILE *file, const char *kind, const char *text);

void ethd__journal_close(ethd__journal *journal);

#endif
