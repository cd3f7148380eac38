/* Ticks of taps on disk: a recording, and the truth beside it.

   The folder holds, beside a recording's own files, truth.npy: row i belongs to row i of tick.npy.
   events.csv has each tap's start. All [main]. */
#ifndef ETHD__APPS_TAP_TICKS_H
#define ETHD__APPS_TAP_TICKS_H

#include "ethd/record.h"
#include "tap/study.h"

/* The columns of an ethd_truth, ended by a NULL name. */
extern const ethd_column ethd__truth_columns[];

typedef struct ethd__ticks {
  ethd_recording *recording;
  ethd_npy *truth;
} ethd__ticks;

/* Makes the folder, as ethd_recording_create does. On failure nothing is open. */
ETHD_MUST_CHECK ethd_status ethd__ticks_open(const char *folder, const ethd_config *config, bool replace,
                                             ethd__ticks *out, char message[ETHD_MESSAGE_MAX]);

/* Announces the stage and law of the next taps. */
ETHD_MUST_CHECK ethd_status ethd__ticks_stage(ethd__ticks *ticks, const ethd__stage *stage,
                                              char message[ETHD_MESSAGE_MAX]);

/* Writes all of the stage's last tap; `words` are for people. */
ETHD_MUST_CHECK ethd_status ethd__ticks_tap(ethd__ticks *ticks, const char *words, const ethd__stage *stage,
                                            char message[ETHD_MESSAGE_MAX]);

/* Closes the files; one without a recording may be closed too. */
ETHD_MUST_CHECK ethd_status ethd__ticks_close(ethd__ticks *ticks, char message[ETHD_MESSAGE_MAX]);

#endif
