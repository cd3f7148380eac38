/* Writes the loop's rows to a recording and to telemetry, and keeps the newest row for other threads. It runs in its
   own thread or, on a virtual clock, after every tick. */
#ifndef ETHD__APPS_RUN_RECORDER_H
#define ETHD__APPS_RUN_RECORDER_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>

#include "ethd/record.h"
#include "run/front.h"
#include "run/snapshot.h"

#define ETHD__POSTS_MAX 4
#define ETHD__DETAIL_MAX 256

/* A posted setup, in the form of events.csv. */
typedef struct ethd__post {
  const char *kind;
  char detail[ETHD__DETAIL_MAX];
} ethd__post;

/* Another receiver of every row, called on the recorder's thread. */
typedef struct ethd__sink {
  void *self;
  void (*take)(void *self, const ethd__row *row); /* NULL: none */
} ethd__sink;

typedef struct ethd__recorder {
  const ethd__session_front *front;
  const ethd_column *columns; /* of a row's trace */
  ethd_loop *loop;
  ethd__sink sink;
  ethd_recording *recording; /* NULL: none */
  int telemetry;             /* socket, -1 none */
  uint64_t every;            /* rows from one datagram to the next */
  uint64_t keeps;            /* rows from one recorded row to the next; 1: each */
  pthread_t thread;
  atomic_int stop, stopping; /* stopping: a controlled stop has begun; its own fault is not reported */
  bool threaded;
  bool dated;             /* the first row's date is recorded */
  atomic_int sees_finger; /* 1: a reading of the finger has come */

  ethd__snapshot snapshot;

  pthread_mutex_t lock; /* for data shared by the main and the recorder's thread; no file is written under it */
  ethd__post posts[ETHD__POSTS_MAX];
  int waiting;               /* posts */
  uint64_t swaps, clearings; /* clearings: rows so far whose step cleared faults */
  ethd__row latest;

  /* only the recorder's thread uses these until it has ended */
  uint64_t rows, lost;
  uint64_t written; /* rows that the recording should have */
  int64_t fault;    /* of the last row */
  uint64_t kept;    /* rows in the recording, once it is closed */
  uint64_t faults[ETHD_FAULT_COUNT];
  bool failed; /* the recording couldn't be written */
} ethd__recorder;

/* recorder->front, columns, loop, recording and telemetry are set. */
void ethd__recorder_begin(ethd__recorder *recorder, double period);
ETHD_MUST_CHECK ethd_status ethd__recorder_start(ethd__recorder *recorder);

/* Processes all waiting rows. Must not be called while the thread runs. */
void ethd__recorder_drain(ethd__recorder *recorder);

/* Ends the thread and processes the rest. */
void ethd__recorder_end(ethd__recorder *recorder);

/* Records that the recording has only every keeps-th row. */
ETHD_MUST_CHECK ethd_status ethd__recorder_thinned(ethd__recorder *recorder);

/* Notes a setup before it is posted; ethd__recorder_withdraw removes the note if the post is refused. Returns false if
   the detail is too long. */
bool ethd__recorder_expect(ethd__recorder *recorder, const char *kind, const char *detail);
void ethd__recorder_withdraw(ethd__recorder *recorder);

ethd__row ethd__recorder_latest(ethd__recorder *recorder);

/* Returns the fault that is latched, by the newest row. */
ethd_fault ethd__recorder_fault(ethd__recorder *recorder);
uint64_t ethd__recorder_clearings(ethd__recorder *recorder);

#endif
