/* A sitting: a session's folder from opening to closing. All events go into the store. All [main]. */
#ifndef ETHD__APPS_STUDY_SITTING_H
#define ETHD__APPS_STUDY_SITTING_H

#include "study/front.h"
#include "study/markers.h"
#include "study/progress.h"

typedef struct ethd__sitting {
  ethd__folder *folder;
  ethd__study_store store;
  ethd__participant who; /* the participant who taps */
  ethd__source source;
  ethd__markers *markers; /* NULL: none */
  ethd__front front;
  uint32_t first, last; /* participants of this sitting */
  uint64_t taps;        /* done in this sitting */
  uint32_t unasked;     /* questionnaires that could not be asked */
  uint32_t left;        /* the participant who was aborted last in this sitting, from 1; 0: nobody */
  ethd__taken latest;   /* this participant's latest tap in this sitting, without its ticks; attempt 0: none */
  const char *checked;  /* "accept" or "reject": what the experimenter did with it; NULL: nothing */
  bool handed_over, undone, again; /* again: a block that was over has a tap to come */
} ethd__sitting;

/* Opens a folder. Where nothing has happened yet a new session begins; else it goes on, if its taps are this hand's. A
   tap's folder whose tap isn't in the store, which a kill leaves behind, is removed. */
ETHD_MUST_CHECK ethd_status ethd__sitting_open(ethd__folder *folder, ethd__hand_source hand, ethd__sitting *out,
                                               char message[ETHD_MESSAGE_MAX]);

/* Selects the participant who taps next. */
ETHD_MUST_CHECK ethd_status ethd__sitting_turn(ethd__sitting *s, uint32_t person, char message[ETHD_MESSAGE_MAX]);

/* Runs an INSERT on the store, then updates the participant's progress from it. */
ETHD_MUST_CHECK ethd_status ethd__sitting_put(ethd__sitting *s, sqlite3_stmt *insert, char message[ETHD_MESSAGE_MAX]);

/* What an event is about. */
typedef struct ethd__about {
  uint32_t participant; /* from 1, 0: nobody */
  size_t block;         /* from 1, 0: none */
  uint32_t attempt;     /* from 1, 0: none */
} ethd__about;

/* Records an event that isn't a tap. */
ETHD_MUST_CHECK ethd_status ethd__sitting_event(ethd__sitting *s, ethd__about about, const char *event,
                                                const char *detail, char message[ETHD_MESSAGE_MAX]);

/* Gives the time of day; "" for simulated hands, so that the same study leaves the same tables. */
void ethd__sitting_now(const ethd__sitting *s, char out[ETHD_UTC_MAX]);

void ethd__sitting_close(ethd__sitting *s);

#endif
