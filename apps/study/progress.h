/* A session's progress, from its store alone. All [main]. */
#ifndef ETHD__APPS_STUDY_PROGRESS_H
#define ETHD__APPS_STUDY_PROGRESS_H

#include "store/store.h"
#include "study/folder.h"
#include "study/source.h"

#define ETHD_STUDY_SESSION_PEOPLE 10000u

/* A block's progress. */
typedef struct ethd__progress_of {
  uint32_t taken, valid; /* valid: without the rejected ones */
  uint32_t accepted, rejected;
  bool surveyed; /* asked and confirmed */
} ethd__progress_of;

typedef struct ethd__participant {
  uint32_t person;
  ethd__progress_of
      at[ETHD_STUDY_BLOCKS + 2]; /* by block, from 1; 0 and the one behind: the questions of [before], [after] */
  bool in;                       /* the taps continue, and belong to the analysis */
  bool consented;
} ethd__participant;

/* SQL: the events that decide whether a participant is in; the last one counts. */
#define ETHD_STUDY_DECISIONS "('abort', 'undo', 'refuse', 'withdraw', 'exclude', 'include')"

/* SQL: "accepted" or "rejected" by the experimenter, of a row of tap; NULL: neither, or undone. */
#define ETHD_STUDY_CHECKED                                                                                             \
  "(SELECT CASE event WHEN 'accept' THEN 'accepted' WHEN 'reject' THEN 'rejected' END FROM event WHERE "               \
  "event.participant = tap.participant AND event.block = tap.block AND event.attempt = tap.attempt ORDER BY event.id " \
  "DESC LIMIT 1)"

/* Gives a participant's progress. */
ETHD_MUST_CHECK ethd_status ethd__participant_of(ethd__study_store *store, uint32_t person, ethd__participant *out,
                                                 char message[ETHD_MESSAGE_MAX]);

/* Answers to a question of the survey, beside 1 to 9. An answer in words counts as 1. */
enum { ETHD_ANSWER_UNASKED = -1, ETHD_ANSWER_NONE = 0 };

/* A block's answers so far; of those to [before] and [after] the blocks are 0 and the one behind the last. */
typedef struct ethd__said {
  int16_t number[ETHD_STUDY_QUESTIONS];
  char words[ETHD_STUDY_QUESTIONS][ETHD_MESSAGE_MAX]; /* "": none */
} ethd__said;

ETHD_MUST_CHECK ethd_status ethd__said_of(ethd__study_store *store, uint32_t person, size_t block, ethd__said *out,
                                          char message[ETHD_MESSAGE_MAX]);

/* Fills `out` with the hand sources in the store. A session has one source; merged stations can have several. */
ETHD_MUST_CHECK ethd_status ethd__hands_of(ethd__study_store *store, bool out[ETHD_HAND_SOURCES],
                                           char message[ETHD_MESSAGE_MAX]);

/* Opens folder/name, to write into it or to read it (store/store.h), and refuses one that contradicts the study: rows
   of unknown participants, missing attempts, answers to unknown questions; and a session of more than
   ETHD_STUDY_SESSION_PEOPLE participants. */
ETHD_MUST_CHECK ethd_status ethd__progress_open(const ethd__folder *folder, const char *name, bool write,
                                                ethd__study_store *out, char message[ETHD_MESSAGE_MAX]);

/* Returns whether a block needs no more taps. [any] */
bool ethd__block_over(const ethd__protocol *protocol, const ethd__study_block *block, uint32_t taken, uint32_t valid);

#endif
