/* Recordings: a folder with tick.npy (rows of ethd_trace, in space of ethd_space_trace), config.ini, the scene,
   events.csv. Links from libethd-drivers and libethd.

   tick.npy is a NumPy structured array. Its header's count is raised after each flush, so a killed run
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
  bool newer;      /* a later addition: in older files, which lack it, it is read as 0 */
} ethd_column;

/* The columns of an ethd_trace and of an ethd_space_trace (space.h), ended by a NULL name. */
ETHD_API extern const ethd_column ethd_trace_columns[], ethd_space_trace_columns[];

typedef struct ethd_npy ethd_npy;

/* Creates a .npy file of rows of `columns`; it replaces a file at path. ETHD_E_FILE,
   ETHD_E_ARGUMENT (columns that don't fit the row), ETHD_E_MEMORY; message holds one line. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_npy_create(const char *path, const ethd_column *columns, size_t row_bytes,
                                                     ethd_npy **out, char message[ETHD_MESSAGE_MAX]);

/* Appends rows. ETHD_E_FILE: these or earlier rows couldn't be written. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_npy_append(ethd_npy *npy, const void *rows, size_t count);

/* Writes the appended rows to the file, then the header's count. ETHD_E_FILE. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_npy_flush(ethd_npy *npy);

/* Flushes, closes, and frees in any case. ETHD_E_FILE. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_npy_close(ethd_npy *npy);

/* Reads a whole file into memory; the caller frees *rows. It must have exactly these columns, but may lack newer ones,
   which are then 0.
   ETHD_E_FILE, ETHD_E_SYNTAX (another file, other columns, cut short), ETHD_E_MEMORY; message holds one line. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_npy_read(const char *path, const ethd_column *columns, size_t row_bytes,
                                                   void **rows, size_t *count, char message[ETHD_MESSAGE_MAX]);

typedef struct ethd_recording ethd_recording;

/* Makes the folder and the files of a recording. config.ini is the configuration's text, with scene.scene as the
   scene's file and with absolute paths of plugins. The folder is locked until the recording is closed. A folder with a
   recording's files is refused; with `replace` those files are removed first. A folder from which the configuration was
   read is refused too. ETHD_E_ARGUMENT, ETHD_E_FILE, ETHD_E_MEMORY; message holds one line. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_recording_create(const char *folder, const ethd_config *config, bool replace,
                                                           ethd_recording **out, char message[ETHD_MESSAGE_MAX]);

/* Writes an event to events.csv (row,kind,detail); the events of a row of tick.npy happened before it, in order. kind:
     setup       detail: law. The configuration's setup with this transition law, in a new controller
     start       detail: free text. A new controller (or a reset one) with the present setup; with "enabled" the
                 running one was restarted and, in the plane, its motors keep their heat
     transition  detail: law. Changes the transition law of the present setup
     contact     detail: law. Changes its contact law
     tracking    detail: law. Changes its tracking law
     set         detail: section.key value. Changes the present setup
     clear       faults were acknowledged
     heat        detail: h1 h2. The motors' heat, see ethd_control_heat; not in space
     learned     detail: m1 m2 m3 m4. The transition law's memory, see ethd_control_memory; not in space
     fault       detail: a sentence for the reader
     clock       detail: ns date. The date (UTC) at an instant of time_ns, once in a recording of a real device:
                 12345678901234 2026-11-26T04:12:12.123456789Z
     lost        detail: the number of ticks missing before this row, which therefore can't be replayed
     thinned     detail: the rule. tick.npy holds only some of the ticks, so the recording can't be replayed
     end         the last event: the recording was closed, and its row is the number of its ticks
   The events of a row make one setup. If setup or start is among them, a new controller starts with it; otherwise
   the setup was posted as a whole to the running one. The first row always has a new controller. ETHD_E_FILE. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_recording_event(ethd_recording *recording, const char *kind,
                                                          const char *detail);

/* Add a row to tick.npy. ETHD_E_FILE: this or an earlier row couldn't be written; ETHD_E_ARGUMENT: the recording's
   configuration is for space and the row is of the plane, or the reverse. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_recording_tick(ethd_recording *recording, const ethd_trace *trace);
ETHD_API ETHD_MUST_CHECK ethd_status ethd_recording_tick_space(ethd_recording *recording,
                                                               const ethd_space_trace *trace);

/* Returns why a file of the recording couldn't be written, with its path; "" without a failure. All data after the
   first failure are lost: events.csv gets a row of kind fault there, for which it reserves room on a full disk. */
ETHD_API const char *ethd_recording_failure(const ethd_recording *recording);

/* Returns how many ticks are in the file. */
ETHD_API uint64_t ethd_recording_kept(const ethd_recording *recording);

/* Writes the rest and the event `end`, and frees the recording in any case. ETHD_E_FILE: message says what failed,
   now or before. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_recording_close(ethd_recording *recording, char message[ETHD_MESSAGE_MAX]);

/* Replays a recording through the library and compares every field that it has bit for bit. ETHD_OK: equal, and message
   says how many ticks. ETHD_E_DIFFERS: message names the first tick and field that differ. ETHD_E_UNFINISHED: the
   recorded ticks are equal, but the recording wasn't closed, so later ticks may be lost; or ticks are missing in
   between, and those after the gap can't be replayed; or another thread or a signal handler has set *stop (NULL:
   never). Any other negative status: message says why it can't be read. Without `plugins` a recording that needs one is
   refused, since a plugin is a program in the folder. In space the field `overflow` isn't compared, since a row doesn't
   hold the surfaces for which it had no room. */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_recording_verify(const char *folder, bool plugins, const volatile int *stop,
                                                           char message[ETHD_MESSAGE_MAX]);

ETHD_END_DECLS

#endif
