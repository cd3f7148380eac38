/* A sitting: the time in which a session's folder is open. What happens in it goes into the journal. All [main]. */
#ifndef ETHD__APPS_STUDY_SITTING_H
#define ETHD__APPS_STUDY_SITTING_H

#include "study/front.h"
#include "study/progress.h"

typedef struct ethd__sitting {
  ethd__folder *folder;
  ethd__journal journal;
  ethd__session_progress progress;
  ethd__source source;
  ethd__front front;
  uint32_t first, last;    /* participants who are asked for */
  uint64_t taps;           /* done in this sitting */
  uint32_t unasked;        /* blocks after which nobody could be asked */
  ethd__participant *left; /* who was ended last in this sitting, NULL: nobody */
  bool handed_over, undone;
} ethd__sitting;

/* Opens a folder. Without a journal a new session begins; with one it goes on, if its taps are this hand's. */
ETHD_MUST_CHECK ethd_status ethd__sitting_open(ethd__folder *folder, ethd__hand_source hand, ethd__sitting *out,
                                               char message[ETHD_MESSAGE_MAX]);

/* Puts a line into the journal, and so into what is known of the session. */
ETHD_MUST_CHECK ethd_status ethd__sitting_put(ethd__sitting *s, const char *kind, const char *text,
                                              char message[ETHD_MESSAGE_MAX]);

/* Writes down something that isn't a tap. number: of the block, 0: none. participant "": nobody's. */
ETHD_MUST_CHECK ethd_status ethd__sitting_event(ethd__sitting *s, const char *participant, size_t number,
                                                const char *event, const char *detail, char message[ETHD_MESSAGE_MAX]);

/* Gives the time of day; "" for simulated hands, so that the same study leaves the same bytes. */
void ethd__sitting_now(const ethd__sitting *s, char out[ETHD_UTC_MAX]);

void ethd__sitting_close(ethd__sitting *s);

#endif
