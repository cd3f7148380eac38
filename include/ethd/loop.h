/* The periodic loop: reads a device, steps the controller, writes the device, on a thread of its own.
   Links from libethd-drivers and libethd.

     sleep until the tick -> driver read -> ethd_control_step -> driver write -> count -> row into a ring

   The thread waits on CLOCK_MONOTONIC for absolute instants on a grid of whole periods. A tick that isn't
   done when the next one is due is an overrun: the whole periods that were lost are counted, handed to the
   next step as `missed`, and the loop goes on at the next instant of the grid, never in a burst. On the
   thread's way there is no mutex and no system call but the sleep (a clock is read without one).

   CLOCK_MONOTONIC stands still while the machine is suspended, CLOCK_BOOTTIME doesn't: what it gains on the
   other from tick to tick is missed as well, and row 35 of the fault table. Not on Xenomai's Cobalt, which
   has a clock of its own.

   What the machine refuses (real-time priority, locked memory, ...) is data, a set of bits with a sentence
   each; require_rt makes it a failure. With a virtual clock there are no threads: ethd_loop_tick does one
   tick, the driver's service included, and equal inputs give equal bits.

   A step that runs for more than 0.1 s is over its budget (row 29), whatever limits.step_time says. A thread of
   real time watches over the loop's: at a step over that budget, or at silence over `gap`, the device is made safe
   from there and disarmed, and row 3 is raised. Half a second and four periods without a turn is a thread that hangs, for code
   that it called doesn't return: ethd_loop_hangs says so, and in which law. No thread can be ended from outside, so
   ethd_loop_join then leaves it to itself and fails; loop, controller, setup and laws stay in memory for it until the
   process ends.

   The loop, its device and its controller outlive each other in this order: destroy the loop first. */
#ifndef ETHD_LOOP_H
#define ETHD_LOOP_H

#include "ethd/control.h"
#include "ethd/driver.h"

ETHD_BEGIN_DECLS

/* ---- histogram ---- */

/* Durations in ns, to 1/32: values under 32 exactly, then 32 bins per factor of two. */
#define ETHD_BINS 1024

typedef struct ethd_histogram {
  uint64_t counts[ETHD_BINS];
  uint64_t count;
  int64_t max; /* ns, exact */
} ethd_histogram;

/* Negative durations count as 0, longer ones than the last bin's in the last. [any, rt-safe] */
ETHD_API void ethd_histogram_add(ethd_histogram *histogram, int64_t ns) ETHD_RT;

/* First and last duration of a bin, ns. [any, rt-safe] */
ETHD_API int64_t ethd_histogram_first(uint32_t bin) ETHD_RT;
ETHD_API int64_t ethd_histogram_last(uint32_t bin) ETHD_RT;

/* The smallest duration that at least `share` (0 to 1) of all don't exceed: the end of its bin, never over
   max; 0 when empty. [any, rt-safe] */
ETHD_API int64_t ethd_histogram_at(const ethd_histogram *histogram, double share) ETHD_RT;

/* ---- what the machine refuses ---- */

enum {
  ETHD_SHORT_FIFO = 1,        /* SCHED_FIFO: the loop runs at ordinary priority */
  ETHD_SHORT_MLOCK = 2,       /* memory isn't locked */
  ETHD_SHORT_AFFINITY = 4,    /* not bound to the cpu that was asked for */
  ETHD_SHORT_DMA_LATENCY = 8, /* the processor may sleep deeply, though that was to be prevented */
  ETHD_SHORT_PREEMPT = 16,    /* the kernel isn't a realtime one */
  ETHD_SHORT_IO = 32          /* SCHED_FIFO for the device's I/O threads: they run at ordinary priority */
};
#define ETHD_SHORT_COUNT 6

/* What is short, and what mends it, one sentence each; `bit` is one of the above. [any] */
ETHD_API const char *ethd_shortfall_sentence(int32_t bit);
ETHD_API const char *ethd_shortfall_mend(int32_t bit);

/* ---- the loop ---- */

#define ETHD_IO_BELOW 5    /* in priority, at least 1 */
#define ETHD_CPU_NONE (-1) /* wherever the kernel puts it */
#define ETHD_CPU_AUTO (-2) /* the highest isolated one, else none */

/* Made by ethd_loop_default, then changed field by field. */
typedef struct ethd_loop_def {
  uint32_t cookie;           /* set by ethd_loop_default */
  const ethd_driver *driver; /* of ethd_device_open; or one that has start, read, write and safe */
  void *device;              /* open and started */
  ethd_control *control;     /* stepped by nobody else while the loop lives */
  double period;             /* s, the controller's; 1e-5 to 1 */
  int32_t cpu;               /* number of a processor, ETHD_CPU_NONE or ETHD_CPU_AUTO */
  int32_t priority;          /* of SCHED_FIFO, 1 to 99; the device's I/O threads come ETHD_IO_BELOW under it */
  int32_t require_rt;        /* 1: start fails at any shortfall */
  int32_t dma_latency;       /* us, held while the loop runs; -1: not held */
  double early_wake;         /* s, 0 to period / 2: wakes so early, warms the caches, then spins to the tick */
  double gap;                /* s, from a period on: lateness, silence and joint samples older than it are faults;
                            INFINITY: lateness is only counted. The device's own limit holds too */
  double heartbeat;          /* s, from a period on: the application's longest silence; INFINITY: any */
  double soft_start;         /* s, 0 to 10: time in which the torque's share rises from 0 to 1 after enabling */
  size_t stack;              /* bytes of the loop's stack, 65536 to 2^26 */
  uint32_t rows;             /* of the ring, a power of two up to 2^20; 0: no rows are kept */
  int64_t *clock;            /* NULL: the system's. Else a virtual clock, ns: the loop sets it to each tick's
                            instant, a driver may move it on */
  const int64_t *suspended;  /* ns for which a virtual clock has stood still so far; NULL: it never does */
} ethd_loop_def;

/* 1 ms, no cpu, priority 80, early_wake 0, dma_latency -1, no gap, no heartbeat, soft_start 0.1 s,
   256 KiB, 4096 rows. [any] */
ETHD_API ethd_loop_def ethd_loop_default(void);

typedef struct ethd_loop ethd_loop;

/* Marks of a row: what was done before its step. */
enum {
  ETHD_ROW_STARTED = 1, /* the device was started and the controller reset */
  ETHD_ROW_CLEARED = 2  /* ethd_control_clear was called */
};

/* A tick as it was. The device got `share` of the trace's torque. */
typedef struct ethd_loop_row {
  ethd_trace trace;
  double share;   /* 0 to 1; 0 while disabled */
  uint64_t lost;  /* rows before this one that found no room */
  uint64_t swaps; /* posted setups taken up to this tick, lost rows included */
  int32_t marks, armed;
  double heat[2]; /* of the motors as the device was started last, see ethd_control_heat */
} ethd_loop_row;

typedef struct ethd_loop_stats {
  uint64_t ticks;
  uint64_t overruns; /* ticks that weren't done, or not woken, when the next one was due */
  uint64_t missed;   /* whole periods lost by them */
  uint64_t relaxes;  /* switches to the secondary mode of Xenomai's Cobalt; 0 elsewhere */
  uint64_t read_failures, write_failures, service_failures;
  uint64_t rows_lost;
  uint64_t faults[ETHD_FAULT_COUNT]; /* occurrences; while threads run, up to the last enabling */
  ethd_histogram wake;               /* from the instant that was asked for to the first instruction */
  ethd_histogram tick;               /* read, step, write */
} ethd_loop_stats;

/* ETHD_E_ARGUMENT, ETHD_E_RANGE with the field's name, ETHD_E_MEMORY. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_loop_create(const ethd_loop_def *def, ethd_loop **out, ethd_error *error);

/* Stops and joins if need be. NULL is fine. Where join failed with a thread that hangs, nothing is freed, and neither
   are the controller and, after ETHD_E_DEVICE, the device to be destroyed. [main] */
ETHD_API void ethd_loop_destroy(ethd_loop *loop);

/* Threads: the loop's, one for each unit of the device's blocking I/O. One dry tick, then the device is armed. With a virtual
   clock there are none. Failures: ETHD_E_DEVICE, its name says of what ("require_rt", "thread",
   "xenomai"); with require_rt nothing runs. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_loop_start(ethd_loop *loop, ethd_error *error);

/* One tick on the virtual clock. [main] */
ETHD_API void ethd_loop_tick(ethd_loop *loop);

/* Disarms: from the next tick on the device gets zero torque; the loop goes on reading. [any] */
ETHD_API void ethd_loop_disarm(ethd_loop *loop);

/* 1: the device gets torques. A controller's safe command or a device's failure disarms. [any] */
ETHD_API int32_t ethd_loop_armed(const ethd_loop *loop);

/* The application is alive: within every `heartbeat` while the device is armed, or it is stopped. [any] */
ETHD_API void ethd_loop_beat(ethd_loop *loop);

/* A row of the fault table that the application sees, an emergency stop or a signal: its bit stands in the
   next sense, once; raise it again while it lasts. [any] */
ETHD_API void ethd_loop_raise(ethd_loop *loop, ethd_fault fault);

/* Acknowledges the controller's fault before the next step. [any] */
ETHD_API void ethd_loop_clear(ethd_loop *loop);

/* Starts the device anew, restarts the controller and arms, softly; meanwhile the loop leaves both alone.
   Not while a posted setup waits. ETHD_BUSY: the loop didn't let go within a second. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_loop_enable(ethd_loop *loop);

/* The device's home, while it is disarmed and the loop leaves it alone: where the joints stand, or NULL, see driver.h.
   A controller without a fault begins anew, as the pose may jump. ETHD_BUSY: the loop didn't let go, or is armed. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_loop_home(ethd_loop *loop, const double *q);

/* Asks the threads to end; zero torque is the last thing written. [any] */
ETHD_API void ethd_loop_stop(ethd_loop *loop);

/* Waits for them, for a second at most once they were told to stop (at periods over 0.1 s: eight periods). ETHD_E_LAW:
   the loop's thread hangs in a law, and will never touch the device again. ETHD_E_DEVICE: the clock failed, or, where
   ethd_loop_ended is 0, the thread hangs in the device. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_loop_join(ethd_loop *loop);

/* The next row, in order; ETHD_EMPTY when there is none. One reader at a time. [any] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_loop_take(ethd_loop *loop, ethd_loop_row *out);

/* ETHD_SHORT_* bits, known once started; 0 on a virtual clock. [main] */
ETHD_API int32_t ethd_loop_shortfalls(const ethd_loop *loop);

/* 1: the loop's thread has ended, by ethd_loop_stop or by itself. [any] */
ETHD_API int32_t ethd_loop_ended(const ethd_loop *loop);

/* Periods since the start, ticks and missed ones: the loop's time over its period. [any] */
ETHD_API uint64_t ethd_loop_periods(const ethd_loop *loop);

/* 1: the loop's thread hangs, as said above; *law is the law in which it does, NULL: the device's code. 0 else. law
   may be NULL. [any] */
ETHD_API int32_t ethd_loop_hangs(const ethd_loop *loop, const ethd_law **law);

/* Numbers while it runs are a tick apart at most. [main] */
ETHD_API void ethd_loop_read(const ethd_loop *loop, ethd_loop_stats *out);

ETHD_END_DECLS

#endif
