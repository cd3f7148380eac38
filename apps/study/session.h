/* A session: people tap, block by block, and nothing of it is lost. All [main].

   A tap counts once its folder has its final name; the journal tells of it next. Whatever ends the program
   between two instants, the next one finds either no trace of the tap or the whole of it. */
#ifndef ETHD_STUDY_SESSION_H
#define ETHD_STUDY_SESSION_H

#include "study/columns.h"
#include "study/front.h"
#include "study/progress.h"

typedef struct ethd__sitting {
  ethd__folder *folder;
  ethd__journal journal;
  ethd__session_progress progress;
  ethd__source source;
  ethd__front front;
  uint32_t first, last;    /* participants that are asked for */
  uint64_t taps;           /* done by this program */
  uint32_t unasked;        /* blocks after which nobody could be asked */
  ethd__participant *left; /* who was ended last in this sitting, NULL: nobody */
  bool handed_over, undone;
} ethd__sitting;

/* A folder without a journal: a new session; with one: goes on, if its taps are this hand's. */
ETHD_MUST_CHECK ethd_status ethd__sitting_open(ethd__folder *folder, ethd__hand_source hand, ethd__sitting *out,
                                               char message[ETHD_MESSAGE_MAX]);

/* Into the journal, and so into what is known of the session. */
ETHD_MUST_CHECK ethd_status ethd__sitting_put(ethd__sitting *s, const char *kind, const char *text,
                                              char message[ETHD_MESSAGE_MAX]);

/* Writes down something that isn't a tap; number: of the block, 0: none. participant "": nobody's. */
ETHD_MUST_CHECK ethd_status ethd__sitting_event(ethd__sitting *s, const char *participant, size_t number,
                                                const char *event, const char *detail, char message[ETHD_MESSAGE_MAX]);

/* Runs until all is done, somebody stops it or ethd__stop is set. *over: all is done. */
ETHD_MUST_CHECK ethd_status ethd__sitting_run(ethd__sitting *s, bool *over, char message[ETHD_MESSAGE_MAX]);

void ethd__sitting_close(ethd__sitting *s);

/* Whether questions are to be asked after this block, and asking them: each answer reaches the journal before the next
   question. *stop: somebody ended it meanwhile. */
bool ethd__survey_due(const ethd__sitting *s, const ethd__turn *turn);
ETHD_MUST_CHECK ethd_status ethd__survey_run(ethd__sitting *s, const char *id, const ethd__turn *turn, bool *stop,
                                             char message[ETHD_MESSAGE_MAX]);

/* Takes a participant out of the analysis or back: event is withdraw, exclude or include. Nobody taps. */
ETHD_MUST_CHECK ethd_status ethd__session_decide(const char *folder, uint32_t person, const char *event,
                                                 const char *reason, char message[ETHD_MESSAGE_MAX]);

/* taps.csv, survey.csv, events.csv and participants.csv from the folder's journal, and SHA256SUMS of it all. */
ETHD_MUST_CHECK ethd_status ethd__tables_write(const ethd__folder *folder, char message[ETHD_MESSAGE_MAX]);

/* The text of these tables, freed by the caller; NULL for those that were written as the folder was made. Exit 1
   without memory. */
ETHD_MUST_CHECK ethd_status ethd__tables_of(const ethd__folder *folder, const ethd__journal *journal,
                                            char *out[ETHD_TABLES], char message[ETHD_MESSAGE_MAX]);

#endif
