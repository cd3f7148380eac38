/* The questions after a block, before the first and after the last one. All [main]. */
#ifndef ETHD__APPS_STUDY_SURVEY_H
#define ETHD__APPS_STUDY_SURVEY_H

#include "study/sitting.h"

/* Returns whether questions are to be asked after this block; block 0 and the one after the last: the questions
   of [before] and [after]. */
bool ethd__survey_due(const ethd__sitting *s, const ethd__turn *turn);

/* Asks them. Each answer is on the disk before the next question. *stop: somebody stopped the survey. */
ETHD_MUST_CHECK ethd_status ethd__survey_run(ethd__sitting *s, const char *id, const ethd__turn *turn, bool *stop,
                                             char message[ETHD_MESSAGE_MAX]);

#endif
