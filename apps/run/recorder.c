#include "run/recorder.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "cli/cli.h"
#include "record/limits_event.h"
#include "record/recording_parts.h"
#include "run/telemetry.h"
#include "text/text.h"

#define STACK ((size_t)512 << 10)
#define PAUSE 2000000  /* ns */
#define TELEMETRY 0.01 /* s */

void ethd__recorder_begin(ethd__recorder *r, double period) {
  pthread_mutex_init(&r->lock, NULL);
  r->every = (uint64_t)fmax(1, round(TELEMETRY / period));
  if (!r->keeps) r->keeps = 1;
}

ethd_status ethd__recorder_thinned(ethd__recorder *r) {
  char text[80];
  snprintf(text, sizeof text, "1 tick of %" PRIu64 " is recorded, and each tick at which a fault begins", r->keeps);
  return ethd_recording_event(r->recording, "thinned", text);
}

/* ---- rows ---- */

static void event(ethd__recorder *r, const char *kind, const char *detail) {
  if (r->recording && ethd_recording_event(r->recording, kind, detail)) r->failed = true;
}

static void tell_lost(ethd__recorder *r, uint64_t lost) {
  char text[80];
  if (!lost) return;
  r->lost += lost;
  snprintf(text, sizeof text, "%" PRIu64 " tick%s before this one found no room", lost, ethd__s(lost));
  event(r, "lost", text);
}

static void tell_posts(ethd__recorder *r, const ethd__post *posts, int count) {
  for (int i = 0; i < count; i++) event(r, posts[i].kind, posts[i].detail);
}

/* Reports a new fault; returns true if it stops the ring. */
static bool tell_fault(ethd__recorder *r, int64_t fault) {
  const char *sentence = ethd_fault_sentence((ethd_fault)fault);
  if (!fault || fault == r->fault || atomic_load(&r->stopping)) return false;
  if (fault > 0 && fault < ETHD_FAULT_COUNT) r->faults[fault]++;
  event(r, "fault", sentence);
  fprintf(stderr, "%s: fault: %s\n", program_invocation_short_name, sentence);
  return true;
}

/* Reports the recorder's losses once to the loop and to the user. */
static void tell_loop(ethd__recorder *r, uint64_t lost, bool failed_before) {
  if (r->failed && !failed_before)
    fprintf(stderr, "%s: %s\n", program_invocation_short_name, ethd_recording_failure(r->recording));
  if (lost || r->failed != failed_before) ethd_loop_raise(r->loop, ETHD_FAULT_RECORDER);
}

/* Updates the data shared with the main thread: the newest row, and the waiting posts. Copies the posts in force from
   this row on to `taken` and returns their number. */
static int share(ethd__recorder *r, const ethd__row *row, const ethd__row_head *head,
                 ethd__post taken[ETHD__POSTS_MAX]) {
  int count = 0;
  pthread_mutex_lock(&r->lock);
  for (; r->swaps < head->swaps && count < r->waiting; r->swaps++) count++;
  memcpy(taken, r->posts, (size_t)count * sizeof *taken);
  r->waiting -= count;
  memmove(r->posts, r->posts + count, (size_t)r->waiting * sizeof *taken);
  r->latest = *row;
  r->clearings += (head->marks & ETHD_ROW_CLEARED) != 0;
  pthread_mutex_unlock(&r->lock);
  return count;
}

/* On a virtual clock a recording is the same on every day. */
static void tell_date(ethd__recorder *r, int64_t instant) {
  if (r->recording && ethd__clock_event(r->recording, instant)) r->failed = true;
}

/* Writes a row and the events before it, in the order of a recording. Returns true if a fault that stops the ring
   begins. */
static bool record(ethd__recorder *r, const ethd__row_head *row, const ethd__post *posts, int count) {
  tell_lost(r, row->lost);
  if (!r->rows && r->dated) tell_date(r, row->time_ns);
  if (row->marks & ETHD_ROW_STARTED && r->rows) event(r, "start", "enabled");
  tell_posts(r, posts, count);
  if (row->marks & ETHD_ROW_CLEARED) event(r, "clear", "");
  bool begins = tell_fault(r, row->fault);
  if (r->rows % r->keeps == 0 || begins) {
    if (r->recording && ethd__recording_row(r->recording, row->trace)) r->failed = true;
    r->written++;
  }
  r->fault = row->fault;
  r->rows++;
  return begins;
}

static void take(ethd__recorder *r, const ethd__row *row) {
  const ethd__row_head head = r->front->head(row);
  bool failed_before = r->failed;
  ethd__post posts[ETHD__POSTS_MAX];
  int count = share(r, row, &head, posts);
  bool begins = record(r, &head, posts, count);
  tell_loop(r, head.lost, failed_before);
  if (head.sees_finger) atomic_store(&r->sees_finger, 1);
  if (r->sink.take) r->sink.take(r->sink.self, row);
  ethd__snapshot_take(&r->snapshot, head.trace, begins ? (ethd_fault)head.fault : ETHD_FAULT_NONE);
  if (r->telemetry >= 0 && r->rows % r->every == 0) ethd__telemetry_send(r->telemetry, r->columns, &head);
}

void ethd__recorder_drain(ethd__recorder *r) {
  ethd__row row;
  while (r->front->take(r->loop, &row) == ETHD_OK) take(r, &row);
}

/* ---- thread ---- */

static void *run(void *recorder) {
  ethd__recorder *r = recorder;
  while (!atomic_load(&r->stop)) {
    struct timespec t = {.tv_nsec = PAUSE};
    ethd__recorder_drain(r);
    nanosleep(&t, NULL);
  }
  return NULL;
}

/* Leaves all signals to the main thread. */
ethd_status ethd__recorder_start(ethd__recorder *r) {
  pthread_attr_t attr;
  sigset_t all, before;
  sigfillset(&all);
  pthread_attr_init(&attr);
  pthread_attr_setstacksize(&attr, STACK);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  r->dated = true;
  r->threaded = pthread_create(&r->thread, &attr, run, r) == 0;
  pthread_sigmask(SIG_SETMASK, &before, NULL);
  pthread_attr_destroy(&attr);
  return r->threaded ? ETHD_OK : ETHD_E_MEMORY;
}

void ethd__recorder_end(ethd__recorder *r) {
  atomic_store(&r->stop, 1);
  if (r->threaded) pthread_join(r->thread, NULL);
  r->threaded = false;
  ethd__recorder_drain(r);
  ethd__snapshot_finish(&r->snapshot);
  pthread_mutex_destroy(&r->lock);
}

/* ---- called by the main thread ---- */

bool ethd__recorder_expect(ethd__recorder *r, const char *kind, const char *detail) {
  size_t length = strlen(detail);
  if (length >= ETHD__DETAIL_MAX) return false;
  pthread_mutex_lock(&r->lock);
  bool room = r->waiting < ETHD__POSTS_MAX;
  if (room) {
    r->posts[r->waiting].kind = kind;
    memcpy(r->posts[r->waiting++].detail, detail, length + 1);
  }
  pthread_mutex_unlock(&r->lock);
  return room;
}

void ethd__recorder_withdraw(ethd__recorder *r) {
  pthread_mutex_lock(&r->lock);
  if (r->waiting) r->waiting--;
  pthread_mutex_unlock(&r->lock);
}

ethd__row ethd__recorder_latest(ethd__recorder *r) {
  pthread_mutex_lock(&r->lock);
  ethd__row row = r->latest;
  pthread_mutex_unlock(&r->lock);
  return row;
}

ethd_fault ethd__recorder_fault(ethd__recorder *r) {
  const ethd__row row = ethd__recorder_latest(r);
  return (ethd_fault)r->front->head(&row).fault;
}

uint64_t ethd__recorder_clearings(ethd__recorder *r) {
  pthread_mutex_lock(&r->lock);
  uint64_t clearings = r->clearings;
  pthread_mutex_unlock(&r->lock);
  return clearings;
}
