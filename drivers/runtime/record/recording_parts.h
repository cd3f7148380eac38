/* The shared parts of recording and replaying. */
#ifndef ETHD__RECORD_RECORDING_PARTS_H
#define ETHD__RECORD_RECORDING_PARTS_H

#include "ethd/record.h"
#include "text/claim.h"

#define ETHD_RECORDING_TICK "tick.npy"
#define ETHD_RECORDING_CONFIG "config.ini"
#define ETHD_RECORDING_SCENE "scene.scene"
#define ETHD_RECORDING_EVENTS "events.csv"
#define ETHD_RECORDING_HEADER "row,kind,detail"

typedef struct ethd__record_event {
  uint64_t row;
  size_t line;
  const char *kind, *detail;
} ethd__record_event;

typedef struct ethd__record_events {
  char *text; /* the words point into it */
  ethd__record_event *events;
  size_t count;
} ethd__record_events;

/* Reports, the first time, that the file `name` of the recording can't be written; returns ETHD_E_FILE. [main] */
ethd_status ethd__recording_fail(ethd_recording *recording, const char *name, int reason);

/* Adds a row, a trace of the recording's front. ETHD_E_FILE, as ethd_recording_tick. [main] */
ETHD_MUST_CHECK ethd_status ethd__recording_row(ethd_recording *recording, const void *trace);

/* Makes the folder of a new recording, locks it and removes an earlier one; see ethd_recording_create. [main] */
ETHD_MUST_CHECK ethd_status ethd__recording_claim(const char *folder, const ethd_config *config, bool replace,
                                                  ethd__claim *out, char message[ETHD_MESSAGE_MAX]);

/* Returns true if `path` is the folder or one of a recording's files in it. [main] */
bool ethd__recording_holds(const char *folder, const char *path);

/* Reads events.csv, whose rows rise. [main] */
ETHD_MUST_CHECK ethd_status ethd__record_events_read(const char *path, ethd__record_events *out,
                                                     char message[ETHD_MESSAGE_MAX]);
void ethd__record_events_free(ethd__record_events *events);

/* Returns the configuration's text with the scene's file called scene.scene and absolute paths of plugins; the caller
   frees it. NULL: no memory. [main] */
char *ethd__record_config_text(const ethd_config *config);

#endif
