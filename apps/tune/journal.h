/* Keeps the scores in a folder, so that a search that was interrupted goes on, and shards in several processes or on
   several machines share the work. tune.txt says what is searched for. scores-I-of-N.csv is the file of shard I, which
   appends a line for each point. All [main]. */
#ifndef ETHD__APPS_TUNE_JOURNAL_H
#define ETHD__APPS_TUNE_JOURNAL_H

#include <stdio.h>

#include "tune/score.h"

typedef struct ethd__tune_row {
  uint32_t round, number; /* from 0 */
  ethd__tune_score score;
} ethd__tune_row;

typedef struct ethd__tune_journal {
  const char *folder; /* NULL: nothing is kept */
  uint32_t index, count;
  FILE *file; /* this shard's file */
  void *rows; /* the tree of tsearch: each ethd__tune_row, by round and number */
} ethd__tune_journal;

/* Makes the folder, or goes on in it. Refuses one in which something else is searched for (`what` differs from its
   tune.txt), another number of shards, and a shard that another process works on. */
ETHD_MUST_CHECK ethd_status ethd__tune_journal_open(const char *folder, const char *what, uint32_t index,
                                                    uint32_t count, ethd__tune_journal *out,
                                                    char message[ETHD_MESSAGE_MAX]);

/* Returns whether this shard scores the point. */
bool ethd__tune_journal_mine(const ethd__tune_journal *journal, uint32_t number);

/* Returns the score of a point of a round; NULL: no shard has it yet. */
const ethd__tune_score *ethd__tune_journal_find(const ethd__tune_journal *journal, uint32_t round, uint32_t number);

/* Keeps a score, on disk if there is a folder. */
ETHD_MUST_CHECK ethd_status ethd__tune_journal_add(ethd__tune_journal *journal, uint32_t round, uint32_t number,
                                                   const ethd__tune_score *score, char message[ETHD_MESSAGE_MAX]);

/* Reads what the other shards have written since. */
ETHD_MUST_CHECK ethd_status ethd__tune_journal_read(ethd__tune_journal *journal, char message[ETHD_MESSAGE_MAX]);

void ethd__tune_journal_close(ethd__tune_journal *journal);

#endif
