/* Where taps come from: the interface for devices, recorded fingers and screens. All [main]. */
#ifndef ETHD__APPS_STUDY_SOURCE_H
#define ETHD__APPS_STUDY_SOURCE_H

#include "study/order.h"
#include "tap/ticks.h"

/* The source of the hand's motion. A session has one source, and so has each of its taps. */
typedef enum ethd__hand_source {
  ETHD_HAND_DEVICE,    /* a person's finger in a device's ring */
  ETHD_HAND_MOUSE,     /* a person's pointer, which leads the simulated device's hand */
  ETHD_HAND_SIMULATED, /* the plant's synthetic hand */
  ETHD_HAND_RECORDED,  /* a recorded movement */
  ETHD_HAND_SOURCES
} ethd__hand_source;

extern const char *const ethd__hand_words[ETHD_HAND_SOURCES];

/* Returns whether a person leads the hand. Other hands get no questions, and their tables have no clock, so that the
   same study gives the same bytes. [any] */
static inline bool ethd__hand_is_persons(ethd__hand_source hand) { return hand <= ETHD_HAND_MOUSE; }

/* The next tap. */
typedef struct ethd__turn {
  uint32_t person, attempt; /* person from 0, attempt from 1 */
  size_t number, of;        /* of the block within the participant's, from 1; their number */
  ethd__study_block block;
} ethd__turn;

#define ETHD_UTC_MAX 32

/* A completed tap. */
typedef struct ethd__taken {
  ethd__turn turn;
  uint64_t seed, tap; /* keys of the finger's random numbers */
  ethd__result result;
  const ethd__speed *speed;
  const ethd__stage *stage; /* its ticks, setup and law, until the next tap */
  ethd__hand_source hand;
  const char *movement;   /* the recorded movement's file, without its folder; NULL: none */
  char utc[ETHD_UTC_MAX]; /* its beginning; empty unless a person's */
} ethd__taken;

typedef struct ethd__source {
  void *self;
  ethd__hand_source hand;
  /* Makes one tap of any length. ETHD_STATUS_EMPTY: no tap, because it was stopped or the finger never left its
     place. */
  ethd_status (*tap)(void *self, const ethd__turn *turn, ethd__taken *out, char message[ETHD_MESSAGE_MAX]);
  /* Returns the reason of the device's own stop as a sentence; NULL: it runs. acknowledge lets it continue. Both are
     NULL if nothing can stop. */
  const char *(*stopped)(void *self);
  ethd_status (*acknowledge)(void *self, char message[ETHD_MESSAGE_MAX]);
  /* The finger's centre from the device, R_0; NULL: the screen's pointer is the finger. */
  ethd_vec (*finger)(void *self);
  /* Returns the loop's present time, ns; NULL: the clock's. */
  int64_t (*now)(void *self);
} ethd__source;

/* An observer of a tap. `look` is called several times a frame while the tap runs. False: the tap must end. */
typedef struct ethd__watcher {
  void *self;
  bool (*look)(void *self, double t, ethd_vec finger); /* s of the tap; NULL: nobody */
} ethd__watcher;

#endif
