/* Where taps come from: the seam for devices, recorded fingers, screens. All [main]. */
#ifndef ETHD_STUDY_SOURCE_H
#define ETHD_STUDY_SOURCE_H

#include "study/order.h"
#include "tap/ticks.h"

/* A tap that is due. */
typedef struct ethd__turn {
  uint32_t person, attempt; /* person from 0, attempt from 1 */
  size_t number;            /* of the block within the participant's, from 1 */
  ethd__block block;
} ethd__turn;

/* A tap that was done. */
typedef struct ethd__taken {
  ethd__turn turn;
  uint64_t seed, tap; /* what the finger was drawn by */
  ethd__result result;
  const ethd__speed *speed;
  const ethd__stage *stage; /* its ticks, setup and law, until the next tap */
} ethd__taken;

typedef struct ethd__source {
  void *self;
  bool simulated; /* people are: nothing is asked of them, and no clock stands in their tables */
  /* One tap, whatever it takes. ETHD_EMPTY: somebody stops it, there was none. */
  ethd_status (*tap)(void *self, const ethd__turn *turn, ethd__taken *out, char message[ETHD_MESSAGE_MAX]);
  /* Why the device has stopped itself, a sentence; NULL: it hasn't. acknowledge: it may go on. Both NULL
     where nothing stops. */
  const char *(*stopped)(void *self);
  ethd_status (*acknowledge)(void *self, char message[ETHD_MESSAGE_MAX]);
  /* The finger's centre as the device has it, R_0; NULL: the screen's pointer is the finger. */
  ethd_vec (*finger)(void *self);
} ethd__source;

/* Whoever looks on while a tap is done, some times a frame. False: it shall end. */
typedef struct ethd__watcher {
  void *self;
  bool (*look)(void *self, double t, ethd_vec finger); /* s of the tap; NULL: nobody */
} ethd__watcher;

#endif
