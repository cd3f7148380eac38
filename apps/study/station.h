/* A station where people tap: a device under ethd-run's loop, which runs between the taps too. All [main].

     prepare   enable          the wall is met    + 0.15 s
        |---------|-----------------|-----------------|        a tap: rows of the loop from its enabling on
     the ring follows the finger from tap to tap

   Each tap begins with a new enabling of the device: its own rows hold all data for its replay. */
#ifndef ETHD__APPS_STUDY_STATION_H
#define ETHD__APPS_STUDY_STATION_H

#include <pthread.h>
#include <stdatomic.h>

#include "run/session.h"
#include "study/desk.h"

typedef enum ethd__phase { ETHD_PHASE_IDLE, ETHD_PHASE_DUE, ETHD_PHASE_TAP, ETHD_PHASE_OVER } ethd__phase;

typedef struct ethd__station {
  ethd__desk *desk; /* the study's speeds, strategies and wall */
  ethd__session session;
  ethd__stage stage; /* the present tap's; no simulation */
  ethd__watcher watcher;
  double slack; /* m: largest distance of a touching finger from the ring, by radius and filter */

  pthread_mutex_t lock; /* for the following members, of the present tap */
  ethd__phase phase;
  ethd__rule rule;
  ethd__turn turn;
  bool touched;
  ethd__approach approach;
  size_t last; /* the last row known so far */
  int64_t begin_ns;
  ethd_status status; /* of its rows */

  pthread_t keeper; /* passes the program's beat and the signal to end to the loop */
  atomic_int end;
  bool kept;
} ethd__station;

/* Opens and starts the configuration's device. folder: where its relative paths start, NULL: beside the
   configuration. is_virtual: in lock-step, as fast as possible. On failure nothing runs. */
ETHD_MUST_CHECK ethd_status ethd__station_open(ethd__desk *desk, const char *config, const char *folder,
                                               bool is_virtual, ethd__station *out, char message[ETHD_MESSAGE_MAX]);

/* Damps the ring until it is still, disables, closes. */
ETHD_MUST_CHECK ethd_status ethd__station_close(ethd__station *station, char message[ETHD_MESSAGE_MAX]);

ethd__source ethd__station_source(ethd__station *station);

#endif
