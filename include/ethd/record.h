/* Recordings: a folder with tick.npy (one ethd_trace a row), config.ini, the scene, events.csv.
   Links from libethd-drivers and libethd.

   tick.npy is a NumPy structured array whose header's count is raised after each flush: a killed run
   leaves a readable file. All [main]. */
#ifndef ETHD_RECORD_H
#define ETHD_RECORD_H

#include <stdbool.h>
#include <stdio.h>

#include "ethd/config.h"

ETHD_BEGIN_DECLS

/* One column of a row of 8-byte fields. */
typedef struct ethd_column {
  const char *name, *unit;
  uint32_t count;  /* of numbers */
  uint32_t offset; /* bytes */
  char type;       /* 'f' double, 'i' int64_t */
} ethd_column;

/* The columns of an ethd_trace, ended by a NULL name. */
ETHD_API extern const ethd_column ethd_trace_columns[];

typedef struct ethd_npy ethd_npy;

/* A new .npy of rows of `columns`; written to path, which must not exist or is replaced. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_npy_create(const char *path, const ethd_column *columns, size_t row_bytes,
                                                     ethd_npy **out, char message[ETHD_MESSAGE_MAX]);
ETHD_API ETHD_MUST_CHECK ethd_status ethd_npy_append(ethd_npy *npy, const void *rows, size_t count);
ETHD_API ETHD_MUST_CHECK ethd_status ethd_npy_flush(ethd_npy *npy);
/* Flushes, closes, frees. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_npy_close(ethd_npy *npy);

/* Whole file into memory, with exactly these columns; *rows is freed by the caller. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_npy_read(const char *path, const ethd_column *columns, size_t row_bytes,
                                                   void **rows, size_t *count, char message[ETHD_MESSAGE_MAX]);

typedef struct ethd_recording ethd_recording;

/* Makes the folder and the files of a recording: config.ini is the configuration's text with the scene's
   file renamed to scene.scene, plugins to absolute paths. The folder is locked until the recording is closed. One that
   holds a recording's files is refused; with `replace` an earlier recording's files are removed first. Refused too: a
   folder whose files the configuration was read from. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_recording_create(const char *folder, const ethd_config *config, bool replace,
                                                           ethd_recording **out, char message[ETHD_MESSAGE_MAX]);

/* events.csv: row,kind,detail; the events of a row of tick.npy come before it, in order. kind:
     setup       detail: law. The configuration's setup with this transition law, in a fresh controller
     start       detail: free words. A fresh controller (or a reset one) with the present setup; "enabled":
                 the running one restarted, its motors as hot as they are
     transition  detail: law. Changes the transition law of the present setup
     set         detail: section.key value. Changes the present setup
     clear       faults were acknowledged
     heat        detail: h1 h2. The motors are so hot, see ethd_control_heat
     fault       detail: a sentence; for people
     end         the last one: the recording was closed, its ticks are as many as the row says
   A row's events make one setup: with setup or start among them the fresh controller starts with it,
   else it was posted, whole, to the running one. Before the first row a fresh controller is implied. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_recording_event(ethd_recording *recording, const char *kind,
                                                          const char *detail);
ETHD_API ETHD_MUST_CHECK ethd_status ethd_recording_tick(ethd_recording *recording, const ethd_trace *trace);

/* Why a file of the recording couldn't be written, with its path; "" while all could. What comes after the first failure
   is lost: events.csv gets a fault's row there, for which it keeps room on a full disk. */
ETHD_API const char *ethd_recording_failure(const ethd_recording *recording);

/* Ticks that are in the file. */
ETHD_API uint64_t ethd_recording_kept(const ethd_recording *recording);

/* Writes the rest and the event `end`, frees. A failure now or before is told in message. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_recording_close(ethd_recording *recording, char message[ETHD_MESSAGE_MAX]);

/* Replays a recording through the library and compares every field bit for bit. ETHD_OK: equal, and
   message says how many ticks. ETHD_E_DIFFERS: the first tick and field that differ. ETHD_E_UNFINISHED: those that are
   there are equal, but the recording wasn't closed, so that later ones may be lost. Otherwise
   negative: why it can't be read. Without `plugins` a recording that needs one is refused, since a plugin is a program
   that the folder brings along. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_recording_verify(const char *folder, bool plugins,
                                                           char message[ETHD_MESSAGE_MAX]);

ETHD_END_DECLS

#endif
