/* The dialogue with participant and experimenter, at a terminal or on a screen. All [main]. */
#ifndef ETHD__APPS_STUDY_FRONT_H
#define ETHD__APPS_STUDY_FRONT_H

#include "study/phrases.h"
#include "study/source.h"

typedef enum ethd__wish {
  ETHD_WISH_GO,     /* go on with the next tap */
  ETHD_WISH_AGREE,  /* go on, with the participant's consent */
  ETHD_WISH_NOTE,   /* write the words down, ask again */
  ETHD_WISH_PAUSE,  /* write down the beginning of a pause, ask again; GO ends it */
  ETHD_WISH_ABORT,  /* this participant ends, or doesn't consent */
  ETHD_WISH_UNDO,   /* the last abort, or the last accepting or rejecting, was a mistake */
  ETHD_WISH_ACCEPT, /* the experimenter accepts the latest tap, with the words */
  ETHD_WISH_REJECT, /* the experimenter rejects it, with the words */
  ETHD_WISH_STOP,   /* end the program; the session can be resumed */
  ETHD_WISHES
} ethd__wish;

/* A participant's turn to begin, or to go on. */
typedef struct ethd__meeting {
  const char *participant;
  bool handed_over; /* somebody else tapped before: the experimenter must be present */
  bool consented;   /* in an earlier sitting */
  bool can_undo;    /* a participant was ended in this sitting */
} ethd__meeting;

/* The block's progress, and the experimenter's verdict on the latest tap. */
typedef struct ethd__tally {
  uint32_t taken, valid, wanted; /* wanted: valid ones; 0: a training */
  uint32_t accepted, rejected;
  const char *checked; /* "accept", "reject"; NULL: nothing */
} ethd__tally;

/* The present question; number == count: the answers are to be confirmed. */
typedef struct ethd__asked {
  const char *participant;
  const ethd__question *question; /* all of them */
  size_t count, number;
  const int16_t *answer;                  /* to each question so far, ETHD_ANSWER_UNASKED: not yet */
  const char *said[ETHD_STUDY_QUESTIONS]; /* the words of those that ask for words, "": none */
  char *words;                            /* room for ETHD_MESSAGE_MAX bytes of an answer in words */
} ethd__asked;

/* Results of `ask` besides 1 to 9 (1: `words` holds the answer to a question for words) and ETHD_ANSWER_NONE; both also
   confirm. */
enum { ETHD_ANSWER_BACK = -2, ETHD_ANSWER_STOP = -3, ETHD_ANSWER_NOBODY = -4 };

typedef struct ethd__front {
  void *self;
  /* Called before a participant's first tap in this sitting. Returns AGREE if the participant consented, GO without a
     question, ABORT, UNDO or STOP. */
  ethd__wish (*meet)(void *self, const ethd__meeting *meeting);
  /* Announces a block; `rest`: time for a rest. */
  void (*block)(void *self, const char *participant, const ethd__turn *turn, bool rest);
  /* Shows the result of the latest tap, and again once the experimenter has accepted or rejected it. */
  void (*verdict)(void *self, const char *participant, const ethd__taken *taken, const ethd__tally *tally);
  /* Called before each tap, and after the block's last one (`over`), when GO goes on. `words` gets a note's text, or
     the reason of accepting or rejecting a tap. */
  ethd__wish (*wish)(void *self, bool over, char words[ETHD_MESSAGE_MAX]);
  /* Reports that the device has stopped itself. True: somebody has checked it, and it may continue. */
  bool (*stopped)(void *self, const char *why);
  /* Asks a question. Returns an answer, ETHD_ANSWER_BACK to the question before, ETHD_ANSWER_STOP, or
     ETHD_ANSWER_NOBODY if nobody can be asked here. */
  int (*ask)(void *self, const ethd__asked *asked);
} ethd__front;

#endif
