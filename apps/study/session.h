/* A session: people tap, block by block, and nothing of it is lost. All [main].

   A tap's ticks are on the disk in a folder of its own before its figures are put into the store, with which it counts.
   Whatever ends the program between two instants, the next one finds the whole tap or removes what is there of it. */
#ifndef ETHD__APPS_STUDY_SESSION_H
#define ETHD__APPS_STUDY_SESSION_H

#include "study/sitting.h"

/* Runs until all is done, somebody stops it or ethd__stop is set. *over: all is done. */
ETHD_MUST_CHECK ethd_status ethd__sitting_run(ethd__sitting *s, bool *over, char message[ETHD_MESSAGE_MAX]);

/* Writes down a decision; nobody taps. About a participant: withdraw, exclude or include; about a valid tap: accept or
   reject. */
ETHD_MUST_CHECK ethd_status ethd__session_decide(const char *folder, ethd__about about, const char *event,
                                                 const char *reason, char message[ETHD_MESSAGE_MAX]);

#endif
