/* Markers for other recorders of a participant, such as EEG: a line of text by UDP for each event.

     EVENT PARTICIPANT BLOCK TRIAL PART STRATEGY SPEED TIME REASON
     trial-end P02 3 4 test offset low 8123.456789012 ok

   EVENT is block-begin, trial-begin, contact (the finger's first touch in the trial), trial-end, accept, reject, uncheck or
   block-end. TRIAL is 0 at block-begin, and the latest one's number at block-end. TIME is the tick's, s of the loop's
   clock (CLOCK_MONOTONIC where time isn't virtual). REASON is the trial's result, as in taps.csv, "none" without a
   tap, else "-". */
#ifndef ETHD__APPS_STUDY_MARKERS_H
#define ETHD__APPS_STUDY_MARKERS_H

#include <stdatomic.h>

#include "study/source.h"

typedef struct ethd__markers {
  const ethd__protocol *protocol;
  const char *address; /* NULL: none */
  int socket;          /* -1: none */
  atomic_bool told;    /* a loss of markers was reported */
} ethd__markers;

/* Opens the socket to HOST:PORT; NULL: no markers. The caller sets `protocol` before the first marker. On failure there is no
   socket. [main] */
ETHD_MUST_CHECK ethd_status ethd__markers_open(const char *address, ethd__markers *out, char message[ETHD_MESSAGE_MAX]);
void ethd__markers_close(ethd__markers *markers);

/* Sends a marker without waiting. A marker that can't be sent is lost; the first loss is reported on stderr. NULL is
   allowed. [any] */
void ethd__markers_send(ethd__markers *markers, const char *event, const ethd__turn *turn, int64_t ns,
                        const char *reason);

#endif
