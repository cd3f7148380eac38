/* The loop's memory. Fields shared by threads are atomic; each has one writer at a time, except flags that any thread
   may raise. */
#ifndef ETHD__LOOP_LOOP_H
#define ETHD__LOOP_LOOP_H

#include <stdatomic.h>
#include <stdbool.h>
#include <sys/types.h>

#include "ethd/loop.h"
#include "loop/front.h"
#include "loop/rt.h"

/* The owner of device and controller: the loop, or [main] while it enables the device. */
enum { ETHD__LOOP_RUNS, ETHD__LOOP_ASKED, ETHD__LOOP_PARKED };

#define ETHD__HOLD_MAX 60000000   /* ns for which a torque may be held without a newer sample; a slow bus takes 50 ms */
#define ETHD__LOOP_HANG 500000000 /* ns: a thread without a cycle for this time, and for four periods, hangs */
#define ETHD__LOOP_LEFT (-1)      /* in `stepping`: [main] has abandoned the stepping thread */
#define ETHD__LOOP_STEP_MAX 100000000 /* ns: no step may take longer, for any limits.step_time */

/* A ring of rows on their way from the loop to one reader. The idea: each counter has one writer, and publishing a
   counter passes a slot to the other side. head and tail only grow; a row's slot is its number modulo the size, and
   head - tail rows wait. The writer fills a slot and then releases head, so a reader that acquires head sees whole
   rows; the reader copies a row and then releases tail, so the writer that acquires tail never overwrites an unread
   row. A full ring loses the new row, which the next one counts in `lost`.

   The controller's events have their own ring. It can't serve for rows, because it is private to libethd, has a fixed
   size, and mustn't lose an event: a setup is taken only while it has room. The two rings have no common order: a row's
   `swaps`, the number of setups taken so far, assigns an event "taken" to its row. */
typedef struct ethd__loop_ring {
  _Alignas(64) atomic_uint head; /* next to write, [rt] */
  _Alignas(64) atomic_uint tail; /* next to read */
  uint32_t size;
  size_t bytes; /* of a row */
  char *at;
} ethd__loop_ring;

typedef struct ethd__unit {
  ethd_loop *loop;
  uint32_t number;
  pthread_t thread;
} ethd__unit;

struct ethd_loop {
  ethd_loop_def def;
  const ethd__loop_front *front;
  int64_t period, early;  /* ns */
  int64_t gap, heartbeat; /* ns; INT64_MAX: none */

  /* [rt]; [main] while parked */
  int64_t due;    /* ns: the next tick's instant */
  int64_t missed; /* periods since the last step */
  int64_t step;   /* ns: duration of the last step */
  int64_t ramp;   /* armed ticks since the start */
  bool dry;       /* 1: the next step is rehearsed first */
  int32_t held;   /* ticks since the last step */
  int64_t stale;  /* ticks since the last sample of joints or effector */
  int64_t hold;   /* ticks for which a torque may be held without one */
  bool was_armed;
  int64_t late;    /* ns: the longest overrun since the last step */
  int64_t ahead;   /* ns: upper bound of CLOCK_BOOTTIME minus the loop's clock */
  int64_t slept;   /* ns for which the machine was suspended since the last step */
  int64_t bucket;  /* the leaky bucket of overruns */
  int64_t beat_at; /* ns: the tick that saw the application's last beat; 0: none has */
  unsigned beats_seen;
  ethd__row_tail tail; /* of the next row */
  ethd__loop_sense sense;
  union {
    ethd__joints joints;
    ethd__effector effector;
  } last;     /* sample */
  bool known; /* there is one */
  union {
    ethd_command plane;
    ethd_space_command space;
  } command;
  ethd__near near;
  ethd__loop_row row;
  ethd_loop_stats stats;

  _Alignas(64) atomic_int mode, armed, clear, stop, ended, failed;
  atomic_uint beats;        /* the application's */
  _Atomic int64_t turned;   /* ns: the last instant at which the loop's thread was alive */
  _Atomic int64_t stepping; /* ns: start of the running step; 0: none runs */
  atomic_int hangs;         /* 1: the loop's thread made no cycle for ETHD__LOOP_HANG */
  atomic_int left;          /* ethd_status of the join that abandoned the thread; 0: none did */
  _Atomic int64_t raised;   /* rows for the next sense */
  ethd__loop_ring rows;

  /* [main] */
  pid_t process; /* of the threads; 0: there are none */
  int32_t shortfalls;
  bool started, locked, has_control, has_watch;
  uint64_t faults[ETHD_FAULT_COUNT]; /* of controllers that were reset */
  uint32_t units;                    /* of blocking I/O that have a thread */
  ethd__unit unit[ETHD_UNITS_MAX];
  pthread_t control, watch;
  void *stack;
  int dma_latency;
  int cpu; /* ETHD_CPU_NONE: any */
};

/* Copies a row. Its type is known here, so no memcpy is called: an application's ThreadSanitizer would watch each call,
   and a suppressed report takes longer than a tick. [rt] */
static inline void ethd__loop_copy(const ethd_loop *loop, const void *from, void *to) ETHD_RT {
  if (loop->front == &ethd__loop_plane)
    *(ethd_loop_row *)to = *(const ethd_loop_row *)from;
  else
    *(ethd_space_row *)to = *(const ethd_space_row *)from;
}

/* Return the loop's instant now, ns, and the same on a clock that goes on while the machine is suspended. [rt] */
int64_t ethd__loop_now(const ethd_loop *loop) ETHD_RT;
int64_t ethd__loop_boot(const ethd_loop *loop) ETHD_RT;

/* Sleeps, ticks and counts until a stop is requested; returns 0, or the error with which the sleep failed. [rt] */
int ethd__loop_cycle(ethd_loop *loop) ETHD_RT;

/* Makes one cycle, a sleep and a tick; returns 0, or the error with which the sleep failed. [rt] */
int ethd__loop_turn(ethd_loop *loop) ETHD_RT;

/* Notes that a tick was due `ns` ago. [rt] */
void ethd__loop_late(ethd_loop *loop, int64_t ns) ETHD_RT;

/* Notes the bounds of the second clock's lead over the first. [rt] */
void ethd__loop_ahead(ethd_loop *loop, int64_t least, int64_t most) ETHD_RT;

/* Adds the rows of the fault table that the loop sees at this tick; once a tick. [rt] */
void ethd__loop_rows(ethd_loop *loop, ethd__sense_head *sense) ETHD_RT;

/* Writes zero torque as the loop's last action. [rt] */
void ethd__loop_rest(ethd_loop *loop) ETHD_RT;

/* The body of the watching thread: the loop's thread counts as dead if it makes no cycle for `gap` while the device
   gets torques. */
void *ethd__loop_watch(void *loop);

/* Does all slow work, before the device is enabled and any thread runs: initialises Xenomai, locks memory, holds the
   DMA latency, finds the processor and makes the stack; notes the bits of refusals by the machine. Fails as
   ethd__xenomai_begin does, or with ETHD_E_MEMORY. [main] */
ETHD_MUST_CHECK ethd_status ethd__loop_ask_machine(ethd_loop *loop, ethd_error *error);
void ethd__loop_release_machine(ethd_loop *loop);

/* True in a child made by fork, which has this memory but none of the threads. */
bool ethd__loop_is_forked(const ethd_loop *loop);

/* Returns how many units of blocking I/O the device has. [main] */
uint32_t ethd__loop_units(const ethd_loop *loop);

/* Fills `error` with what failed, and returns `status`. [main] */
ethd_status ethd__loop_refuse(ethd_error *error, ethd_status status, const char *name, double found, double min,
                              double max);

/* Initialises Xenomai where that is needed; begins to count switches to secondary mode on a thread; returns their
   number. Refusals are named "xenomai" (the kernel has no Cobalt), "clock" (found: lead of Cobalt's over Linux's, s)
   and "thread". [main] */
ethd_status ethd__xenomai_begin(ethd_error *error);
void ethd__xenomai_watch(void); /* on the loop's thread, before the first tick */
uint64_t ethd__xenomai_relaxes(void);

#endif
