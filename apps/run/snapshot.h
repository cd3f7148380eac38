/* The ticks around the first fault that stopped the ring: 2 s before it and 1 s after it. All calls are one
   thread's. */
#ifndef ETHD__APPS_RUN_SNAPSHOT_H
#define ETHD__APPS_RUN_SNAPSHOT_H

#include "ethd/fault.h"
#include "ethd/record.h"

typedef struct ethd__snapshot {
  char *path;                 /* NULL: none is taken */
  const ethd_column *columns; /* of a row */
  size_t bytes;               /* of a row */
  char *rows;
  size_t room, count;             /* rows; taken since the start */
  size_t after;                   /* rows that follow the fault */
  size_t left;                    /* ticks still to come; 0 before the fault and after the file is written */
  ethd_fault fault;               /* the first; ETHD_FAULT_NONE: none yet */
  size_t written;                 /* rows in the file */
  char message[ETHD_MESSAGE_MAX]; /* why it couldn't be written, else empty */
} ethd__snapshot;

/* Fails with ETHD_E_MEMORY. Before it no snapshot is taken. */
ETHD_MUST_CHECK ethd_status ethd__snapshot_open(ethd__snapshot *s, const char *path, double period,
                                                const ethd_column *columns, size_t row_bytes);

/* To be called with every row, in order. `begins`: a fault that begins at this row and stops the ring. */
void ethd__snapshot_take(ethd__snapshot *s, const void *row, ethd_fault begins);

/* Writes the rows so far, if the run ends before all have come. */
void ethd__snapshot_finish(ethd__snapshot *s);
void ethd__snapshot_close(ethd__snapshot *s);

#endif
