/* What participant and experimenter see and say: the seam for a screen. All [main]. */
#ifndef ETHD_STUDY_FRONT_H
#define ETHD_STUDY_FRONT_H

#include "study/phrases.h"
#include "study/source.h"

typedef enum ethd__wish {
  ETHD_WISH_GO,    /* on with the next tap */
  ETHD_WISH_AGREE, /* on, with the participant's consent */
  ETHD_WISH_NOTE,  /* write the words down, ask again */
  ETHD_WISH_PAUSE, /* write down that a pause begins, ask again; GO ends it */
  ETHD_WISH_ABORT, /* this participant wants no more, or doesn't agree to begin */
  ETHD_WISH_UNDO,  /* the last abort was a mistake */
  ETHD_WISH_STOP,  /* end the program; the session can be resumed */
  ETHD_WISHES
} ethd__wish;

/* A participant's turn to begin, or to go on. */
typedef struct ethd__meeting {
  const char *participant;
  bool handed_over; /* somebody else tapped before: the experimenter has to be there */
  bool consented;   /* in a sitting before */
  bool can_undo;    /* somebody was ended in this sitting */
} ethd__meeting;

/* A question that is due; number == the count of questions: the answers are to be confirmed. */
typedef struct ethd__asked {
  const char *participant;
  const ethd__turn *turn;
  size_t number;
  const int16_t *answer;                  /* to each question so far, ETHD_ANSWER_UNASKED: not yet */
  const char *said[ETHD_STUDY_QUESTIONS]; /* the words of those that ask for words, "": none */
  char *words;                            /* room for ETHD_MESSAGE_MAX bytes of an answer in words */
} ethd__asked;

/* What `ask` says, beside 1 to 9 (1: `words` holds the answer, where words are asked for) and ETHD_ANSWER_NONE; any of
   these two confirms. */
enum { ETHD_ANSWER_BACK = -2, ETHD_ANSWER_STOP = -3, ETHD_ANSWER_NOBODY = -4 };

typedef struct ethd__front {
  void *self;
  /* Before a participant's first tap in this sitting: AGREE where consent was asked for and given, GO where nothing was
     asked, ABORT, UNDO, STOP. */
  ethd__wish (*meet)(void *self, const ethd__meeting *meeting);
  /* rest: it is time for one. */
  void (*block)(void *self, const char *participant, const ethd__turn *turn, bool rest);
  /* Judged at once: valid of wanted so far; a training tap has no number wanted: 0. */
  void (*verdict)(void *self, const char *participant, const ethd__taken *taken, uint32_t valid, uint32_t wanted);
  /* Before each tap. words: of a note. */
  ethd__wish (*wish)(void *self, char words[ETHD_MESSAGE_MAX]);
  /* The device has stopped itself. True: somebody has seen to it, and it may go on. */
  bool (*stopped)(void *self, const char *why);
  /* An answer, ETHD_ANSWER_BACK to the question before, ETHD_ANSWER_STOP, or ETHD_ANSWER_NOBODY: nobody can be asked
     here. */
  int (*ask)(void *self, const ethd__asked *asked);
} ethd__front;

/* What tells the participant how a tap was, and what to do. [any] */
ethd__phrase_name ethd__advice(ethd__reason reason);

/* Lines on stdout, commands and answers on stdin when `ask`. */
typedef struct ethd__console {
  const ethd__protocol *protocol;
  bool ask, quiet, ended, paused;
} ethd__console;

ethd__front ethd__console_front(ethd__console *console);

#endif
