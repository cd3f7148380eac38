/* What participant and experimenter see and say: the seam for a screen. All [main]. */
#ifndef ETHD_STUDY_FRONT_H
#define ETHD_STUDY_FRONT_H

#include "study/source.h"

typedef enum ethd__wish {
  ETHD_WISH_GO,    /* on with the next tap */
  ETHD_WISH_NOTE,  /* write the words down, ask again */
  ETHD_WISH_PAUSE, /* write down that a pause begins, ask again; GO ends it */
  ETHD_WISH_ABORT, /* this participant wants no more */
  ETHD_WISH_STOP   /* end the program; the session can be resumed */
} ethd__wish;

typedef struct ethd__front {
  void *self;
  void (*block)(void *self, const char *participant, const ethd__turn *turn);
  /* Judged at once: valid of wanted so far; a training tap has no number wanted: 0. */
  void (*verdict)(void *self, const char *participant, const ethd__taken *taken, uint32_t valid, uint32_t wanted);
  /* Before each tap. words: of a note. */
  ethd__wish (*wish)(void *self, char words[ETHD_MESSAGE_MAX]);
  /* The device has stopped itself. True: somebody has seen to it, and it may go on. */
  bool (*stopped)(void *self, const char *why);
  /* 1 to 5 each; false: no answers. */
  bool (*survey)(void *self, const ethd__turn *turn, int answers[3]);
} ethd__front;

/* Shows the participant what to do. [any] */
const char *ethd__advice(ethd__reason reason);

/* Lines on stdout, commands and answers on stdin when `ask`. */
typedef struct ethd__console {
  const ethd__protocol *protocol;
  bool ask, quiet, ended, paused;
} ethd__console;

ethd__front ethd__console_front(ethd__console *console);

#endif
