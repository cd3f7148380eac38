/* The simulated device on a desk, with simulated people or recorded fingers. All [main]. */
#ifndef ETHD__APPS_STUDY_DESK_H
#define ETHD__APPS_STUDY_DESK_H

#include "study/markers.h"
#include "tap/load.h"

typedef struct ethd__desk {
  const ethd__protocol *protocol;
  const ethd__loaded *loaded;
  ethd__markers *markers; /* NULL: none */
  char **movements;       /* files, by name */
  size_t movement_count;
  ethd__study study; /* of the present person */
  ethd__speed speeds[ETHD_STUDY_WORDS];
  ethd__gain gains[ETHD_STUDY_GAINS];
  ethd__stage stage;
  uint32_t person; /* the person of `study` */
  size_t strategy, movement;
  bool seated, open;
  const ethd_law *told; /* the law whose failure was reported last */
} ethd__desk;

/* Opens a desk, and checks everything that could make the first tap fail: strategies, speeds, gains, the wall, the
   movements. finger: one recorded movement; NULL: by the protocol. */
ETHD_MUST_CHECK ethd_status ethd__desk_open(const ethd__protocol *protocol, const ethd__loaded *loaded,
                                            const char *finger, ethd__desk *out, char message[ETHD_MESSAGE_MAX]);
void ethd__desk_close(ethd__desk *desk);

/* Uses the gains of this point of the grid from here on. */
void ethd__desk_point(ethd__desk *desk, size_t point);

/* Prepares a tap except its finger: the person's study and the strategy's stage. */
ETHD_MUST_CHECK ethd_status ethd__desk_prepare(ethd__desk *desk, const ethd__turn *turn, ethd__taken *out,
                                               char message[ETHD_MESSAGE_MAX]);

ethd__source ethd__desk_source(ethd__desk *desk);

#endif
