/* A session: people tap, block by block, and nothing of it is lost. All [main].

   A tap counts once its folder has its final name; the journal tells of it next. Whatever ends the program
   between two instants, the next one finds either no trace of the tap or the whole of it. */
#ifndef ETHD_STUDY_SESSION_H
#define ETHD_STUDY_SESSION_H

#include "study/folder.h"
#include "study/front.h"
#include "study/journal.h"

#define ETHD_STUDY_SESSION_PEOPLE 10000u

/* How far a block has come. */
typedef struct ethd__progress_of {
  uint32_t taken, valid;
  bool surveyed;
} ethd__progress_of;

typedef struct ethd__sitting {
  ethd__folder *folder;
  ethd__journal journal;
  ethd__progress_of (*at)[ETHD_STUDY_BLOCKS]; /* by participant and block */
  bool *aborted;
  ethd__source source;
  ethd__front front;
  uint32_t first, last; /* participants that are asked for */
  uint64_t taps;        /* done by this program */
} ethd__sitting;

/* A folder without a journal: a new session; with one: goes on. */
ETHD_MUST_CHECK ethd_status ethd__sitting_open(ethd__folder *folder, ethd__sitting *out,
                                               char message[ETHD_MESSAGE_MAX]);

/* Runs until all is done, somebody stops it or ethd__stop is set. *over: all is done. */
ETHD_MUST_CHECK ethd_status ethd__sitting_run(ethd__sitting *s, bool *over, char message[ETHD_MESSAGE_MAX]);

void ethd__sitting_close(ethd__sitting *s);

/* taps.csv, survey.csv, events.csv from the folder's journal. */
ETHD_MUST_CHECK ethd_status ethd__tables_write(const char *folder, char message[ETHD_MESSAGE_MAX]);

/* A block that needs no more taps. */
bool ethd__block_over(const ethd__protocol *protocol, const ethd__block *block, uint32_t taken, uint32_t valid);

#endif
