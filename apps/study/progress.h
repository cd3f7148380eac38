/* How far a session has come, by its journal alone. All [main]. */
#ifndef ETHD__APPS_STUDY_PROGRESS_H
#define ETHD__APPS_STUDY_PROGRESS_H

#include "study/folder.h"
#include "study/journal.h"
#include "study/source.h"

#define ETHD_STUDY_SESSION_PEOPLE 10000u

/* Answers to a question of the survey, beside 1 to 9. An answer in words counts as 1. */
enum { ETHD_ANSWER_UNASKED = -1, ETHD_ANSWER_NONE = 0 };

/* How far a block has come. */
typedef struct ethd__progress_of {
  uint32_t taken, valid;
  bool surveyed;                        /* asked and confirmed */
  int16_t answer[ETHD_STUDY_QUESTIONS]; /* so far, ETHD_ANSWER_UNASKED: not yet */
} ethd__progress_of;

/* Whether a participant's taps go on and belong to the analysis: of IN alone. */
typedef enum ethd__standing {
  ETHD_STANDING_IN,
  ETHD_STANDING_ABORTED,
  ETHD_STANDING_REFUSED,
  ETHD_STANDING_WITHDRAWN,
  ETHD_STANDING_EXCLUDED,
  ETHD_STANDINGS
} ethd__standing;

extern const char *const ethd__standing_words[ETHD_STANDINGS];

typedef struct ethd__participant {
  ethd__progress_of at[ETHD_STUDY_BLOCKS]; /* by block */
  ethd__standing standing;
  bool consented, tapped;
  ethd__hand_source hand; /* once tapped */
  uint32_t taps, valid;   /* test taps */
  char *reason;           /* of the standing, or of its return to IN; NULL: none */
  char first[ETHD_UTC_MAX], last[ETHD_UTC_MAX];
} ethd__participant;

/* An answer in words. */
typedef struct ethd__said {
  const ethd__progress_of *at;
  size_t question;
  char *words;
  struct ethd__said *before; /* what was said before it; NULL: nothing */
} ethd__said;

typedef struct ethd__session_progress {
  const ethd__protocol *protocol;
  ethd__participant *person;
  ethd__said *said;             /* the last one */
  bool hand[ETHD_HAND_SOURCES]; /* of the session; of several stations, of each */
} ethd__session_progress;

/* Begins with nothing done. Refuses more than ETHD_STUDY_SESSION_PEOPLE participants. */
ETHD_MUST_CHECK ethd_status ethd__progress_begin(const ethd__protocol *protocol, ethd__session_progress *out,
                                                 char message[ETHD_MESSAGE_MAX]);
void ethd__progress_free(ethd__session_progress *progress);

/* Takes one line of the journal. False: it is no line of this study. */
bool ethd__progress_take(ethd__session_progress *progress, const char *kind, const char *text);

/* Returns the words that answer this block's question; "": there are none. [any] */
const char *ethd__progress_words(const ethd__session_progress *progress, const ethd__progress_of *at, size_t question);

/* Takes a whole journal; `hash` is the study's. Refuses the journal of another study, and lines that aren't its own. */
ETHD_MUST_CHECK ethd_status ethd__progress_read(const ethd__journal *journal, const char *hash,
                                                ethd__session_progress *progress, char message[ETHD_MESSAGE_MAX]);

/* Returns whether a block needs no more taps. [any] */
bool ethd__block_over(const ethd__protocol *protocol, const ethd__study_block *block, uint32_t taken, uint32_t valid);

/* Returns whether all blocks of a participant are over. */
bool ethd__participant_over(const ethd__session_progress *progress, uint32_t person);

#endif
