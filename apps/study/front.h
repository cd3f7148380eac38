/* What participant and experimenter see and say, whether at a terminal or on a screen. All [main]. */
#ifndef ETHD__APPS_STUDY_FRONT_H
#define ETHD__APPS_STUDY_FRONT_H

#include "study/phrases.h"
#include "study/source.h"

typedef enum ethd__wish {
  ETHD_WISH_GO,     /* go on with the next tap */
  ETHD_WISH_AGREE,  /* go on, with the participant's consent */
  ETHD_WISH_NOTE,   /* write the words down, ask again */
  ETHD_WISH_PAUSE,  /* write down that a pause begins, ask again; GO ends it */
  ETHD_WISH_ABORT,  /* this participant wants no more, or doesn't agree to begin */
  ETHD_WISH_UNDO,   /* the last abort, or the last accepting or rejecting, was a mistake */
  ETHD_WISH_ACCEPT, /* the experimenter has looked at the latest tap: it stays, with the words */
  ETHD_WISH_REJECT, /* it doesn't count, with the words */
  ETHD_WISH_STOP,   /* end the program; the session can be resumed */
  ETHD_WISHES
} ethd__wish;

/* A participant's turn to begin, or to go on. */
typedef struct ethd__meeting {
  const char *participant;
  bool handed_over; /* somebody else tapped before: the experimenter has to be there */
  bool consented;   /* in an earlier sitting */
  bool can_undo;    /* somebody was ended in this sitting */
} ethd__meeting;

/* How far the block is, and what the experimenter did with the latest tap. */
typedef struct ethd__tally {
  uint32_t taken, valid, wanted; /* wanted: valid ones; 0: a training */
  uint32_t accepted, rejected;
  const char *checked; /* "accept", "reject"; NULL: nothing */
} ethd__tally;

/* A question that is due; number == count: the answers are to be confirmed. */
typedef struct ethd__asked {
  const char *participant;
  const ethd__question *question; /* all of them */
  size_t count, number;
  const int16_t *answer;                  /* to each question so far, ETHD_ANSWER_UNASKED: not yet */
  const char *said[ETHD_STUDY_QUESTIONS]; /* the words of those that ask for words, "": none */
  char *words;                            /* room for ETHD_MESSAGE_MAX bytes of an answer in words */
} ethd__asked;

/* What `ask` returns besides 1 to 9 (1: `words` holds the answer, if words are asked for) and ETHD_ANSWER_NONE, both of
   which also confirm. */
enum { ETHD_ANSWER_BACK = -2, ETHD_ANSWER_STOP = -3, ETHD_ANSWER_NOBODY = -4 };

typedef struct ethd__front {
  void *self;
  /* Called before a participant's first tap in this sitting. Returns AGREE if consent was asked for and given, GO if
     nothing was asked, ABORT, UNDO or STOP. */
  ethd__wish (*meet)(void *self, const ethd__meeting *meeting);
  /* Announces a block; `rest` says that it is time for one. */
  void (*block)(void *self, const char *participant, const ethd__turn *turn, bool rest);
  /* Tells how the latest tap was, and again once the experimenter has accepted or rejected it. */
  void (*verdict)(void *self, const char *participant, const ethd__taken *taken, const ethd__tally *tally);
  /* Called before each tap, and after the block's last one (`over`), when GO goes on. `words` gets those of a note, or
     why a tap is accepted or rejected. */
  ethd__wish (*wish)(void *self, bool over, char words[ETHD_MESSAGE_MAX]);
  /* Says that the device has stopped itself. True: somebody has seen to it, and it may go on. */
  bool (*stopped)(void *self, const char *why);
  /* Asks a question. Returns an answer, ETHD_ANSWER_BACK to the question before, ETHD_ANSWER_STOP, or
     ETHD_ANSWER_NOBODY if nobody can be asked here. */
  int (*ask)(void *self, const ethd__asked *asked);
} ethd__front;

#endif
