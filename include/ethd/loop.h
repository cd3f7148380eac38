/* The periodic loop: reads a device, steps the controller, writes the device, on a thread of its own.
   Links from libethd-drivers and libethd.

     sleep until the tick -> driver read -> ethd_control_step -> driver write -> count -> row into a ring

   For space it does the same with a controller of space.h and a device that is opened for space:

     -> driver read_space -> surfaces, able -> ethd_space_step -> driver write_space ->

   The thread waits on CLOCK_MONOTONIC for absolute instants on a grid of whole periods. A tick that isn't done when the
   next one is due is an overrun: the lost whole periods are counted and given to the next step as `missed`, and the
   loop goes on at the next instant of the grid, never in a burst. In a tick the thread takes no mutex and makes no
   system call except the sleep (reading a clock needs none).

   CLOCK_MONOTONIC stands still while the machine is suspended, CLOCK_BOOTTIME doesn't. If their difference grows from
   tick to tick, the growth counts as missed too, and is row CLOCK of the fault table. Xenomai's Cobalt has its own
   clock and doesn't do this.

   Each refusal of the machine (real-time priority, locked memory, ...) is a bit with a sentence; require_rt makes it a
   failure. With a virtual clock there are no threads: ethd_loop_tick does one tick, the driver's service included, and
   equal inputs give equal bits.

   A step that runs for more than 0.1 s is over its budget (row BUDGET), for any limits.step_time. A second realtime
   thread watches the loop's: if a step is over that budget, or the loop is silent for longer than `gap`, it makes the
   device safe, disarms it and raises row LOOP. Without a gap (INFINITY) it watches steps only: if a driver's read or
   write then doesn't return, the torque stays until the driver's own watchdog removes it. A loop that hasn't begun a
   tick for half a second and for four periods hangs, because a call doesn't return: ethd_loop_hangs reports it, with
   the law. No thread can be ended from outside, so ethd_loop_join then gives up and fails; loop, controller, setup and
   laws stay in memory until the process ends.

   Create the loop before the device is started, and start it at once after that:

     ethd_device_open -> ethd_control_create -> ethd_loop_create -> ethd_device_start -> ethd_loop_start

   ethd_loop_create does the slow work (locking the memory of a large program takes seconds). An enabled drive waits for
   its first message only some milliseconds; then its watchdog, or the servo's guardian, removes the torque.

   A forked child that doesn't exec (daemon and multiprocessing; system and popen do exec) has a copy of the loop but
   none of its threads, and the device belongs to the parent. In the child the loop has ended and isn't armed, join
   returns ETHD_E_ARGUMENT, enable and home return ETHD_STATUS_BUSY, and destroy frees the copy; none of them calls the
   driver. So call daemon() before ethd_loop_start.

   Destroy the loop before its device and its controller. */
#ifndef ETHD_LOOP_H
#define ETHD_LOOP_H

#include "ethd/control.h"
#include "ethd/driver.h"
#include "ethd/space.h"

ETHD_BEGIN_DECLS

/* ---- histogram ---- */

/* Durations in ns, exact under 32, then in 32 bins per factor of two. */
#define ETHD_BINS 1024

typedef struct ethd_histogram {
  uint64_t counts[ETHD_BINS];
  uint64_t count;
  int64_t max; /* ns, exact */
} ethd_histogram;

/* Counts a duration; a negative one counts as 0, one beyond the last bin in the last bin. [any, rt-safe] */
ETHD_API void ethd_histogram_add(ethd_histogram *histogram, int64_t ns) ETHD_RT;

/* Return the first and the last duration of a bin, ns. [any, rt-safe] */
ETHD_API int64_t ethd_histogram_first(uint32_t bin) ETHD_RT;
ETHD_API int64_t ethd_histogram_last(uint32_t bin) ETHD_RT;

/* Returns the duration, ns, that at least the share `share` (0 to 1) of all durations don't exceed, rounded up to the
   end of its bin but never over max; 0 if there are none. [any, rt-safe] */
ETHD_API int64_t ethd_histogram_at(const ethd_histogram *histogram, double share) ETHD_RT;

/* ---- shortfalls of the machine ---- */

enum {
  ETHD_SHORT_FIFO = 1,        /* no SCHED_FIFO: the loop runs at ordinary priority */
  ETHD_SHORT_MLOCK = 2,       /* memory isn't locked */
  ETHD_SHORT_AFFINITY = 4,    /* not bound to the requested cpu */
  ETHD_SHORT_DMA_LATENCY = 8, /* dma_latency couldn't be held: the processor may sleep deeply */
  ETHD_SHORT_PREEMPT = 16,    /* the kernel isn't a realtime one */
  ETHD_SHORT_IO = 32          /* no SCHED_FIFO for the device's I/O threads: they run at ordinary priority */
};
#define ETHD_SHORT_COUNT 6

/* Give the shortfall and its remedy, a sentence each; `bit` is one of the above. [any] */
ETHD_API const char *ethd_shortfall_sentence(int32_t bit);
ETHD_API const char *ethd_shortfall_mend(int32_t bit);

/* ---- the loop ---- */

#define ETHD_IO_BELOW 5    /* difference of the I/O threads' lower priority, which is at least 1 */
#define ETHD_CPU_NONE (-1) /* any processor, as the kernel chooses */
#define ETHD_CPU_AUTO (-2) /* the isolated processor with the highest number, if there is one */

/* Made by ethd_loop_default, then changed field by field. */
typedef struct ethd_loop_def {
  uint32_t cookie;          /* set by ethd_loop_default */
  uint32_t bytes;           /* set by ethd_loop_default: the first size that isn't this library's, 0: none */
  ethd_device *device;      /* from ethd_device_open; start it between ethd_loop_create and _start */
  ethd_control *control;    /* only the loop steps it while the loop exists; NULL: `space` is used */
  double period;            /* s, the controller's (ethd_control_period), 1e-5 to 1; another one is refused */
  int32_t cpu;              /* number of a processor, ETHD_CPU_NONE or ETHD_CPU_AUTO */
  int32_t priority;         /* of SCHED_FIFO, 1 to 99; the device's I/O threads have ETHD_IO_BELOW less */
  int32_t require_rt;       /* 1: start fails at any shortfall */
  int32_t dma_latency;      /* us, held while the loop exists; -1: not held */
  double early_wake;        /* s, 0 to period / 2: the loop wakes this early, warms the caches and spins to the tick */
  double gap;               /* s, at least a period: longer lateness, silence and older joint samples are faults;
                            INFINITY: lateness is only counted. The device's own limit holds too */
  double heartbeat;         /* s, at least a period: the longest time between two beats; INFINITY: none is needed */
  double soft_start;        /* s, 0 to 10: rise time of the command's share from 0 to 1 after enabling */
  size_t stack;             /* bytes of the loop's stack, 65536 to 2^26; thread-local memory comes on top */
  uint32_t rows;            /* of the ring, a power of two up to 2^20; 0: no rows are kept */
  int64_t *clock;           /* NULL: the system's. Else a virtual clock, ns: the loop sets it to each tick's
                            instant, a driver may move it on */
  const int64_t *suspended; /* ns for which a virtual clock has stood still so far; NULL: it never stands still */
  ethd_space *space;        /* for a device in space; exactly one of `control` and `space` is set */
  /* For `space`: fills `out` with the surfaces near the effector of this sense, for the step that follows, and returns
     how many there are. It isn't called while the device can't be read. NULL: there are none. It runs within the step's
     time budget; if it hangs, ethd_loop_hangs reports the device's code. */
  uint32_t (*surfaces)(void *of, const ethd_space_sense *sense, ethd_surface out[ETHD_SURFACES_MAX]) ETHD_RT;
  void *surfaces_of;
} ethd_loop_def;

typedef struct ethd_loop ethd_loop;

/* Marks of a row: actions before its step. */
enum {
  ETHD_ROW_STARTED = 1, /* the device was started and the controller reset */
  ETHD_ROW_CLEARED = 2  /* ethd_control_acknowledge was called */
};

/* One tick. The device got the share `share` of the trace's torque. */
typedef struct ethd_loop_row {
  ethd_trace trace;
  double share;   /* 0 to 1; 0 while disabled */
  uint64_t lost;  /* earlier rows for which the ring had no room */
  uint64_t swaps; /* posted setups taken up to this tick, lost rows included */
  int32_t marks, armed;
  double heat[2]; /* of the motors when the device was last started, see ethd_control_heat */
} ethd_loop_row;

/* One tick in space. The sense's ability is the device's along the normal of the surface nearest to the sense's x,
   unless the driver's read gave one. During a soft start only a share of the command is written; then
   `commanded` is that share, unless the driver's read gave it. */
typedef struct ethd_space_row {
  ethd_space_trace trace;
  double share;
  uint64_t lost, swaps;
  int32_t marks, armed;
} ethd_space_row;

typedef struct ethd_loop_stats {
  uint64_t ticks;
  uint64_t overruns; /* ticks that weren't done, or not woken, when the next one was due */
  uint64_t missed;   /* whole periods lost by them */
  uint64_t relaxes;  /* switches to the secondary mode of Xenomai's Cobalt; 0 elsewhere */
  uint64_t read_failures, write_failures, service_failures;
  uint64_t rows_lost;
  uint64_t faults[ETHD_FAULT_COUNT]; /* occurrences; while threads run, up to the last enabling */
  ethd_histogram wake;               /* from the requested instant to the first instruction */
  ethd_histogram tick;               /* read, step, write */
} ethd_loop_stats;

/* Fills a definition for ethd_loop_default, with the caller's sizes, bytes, of ethd_loop_def, _row and _stats, and of
   ethd_space_row. [any] */
ETHD_API void ethd_loop_fill(ethd_loop_def *def, uint32_t def_size, uint32_t row_size, uint32_t stats_size,
                             uint32_t space_row_size);

/* Returns 1 ms, no cpu, priority 80, early_wake 0, dma_latency -1, no gap, no heartbeat, soft_start 0.1 s, 256 KiB,
   4096 rows. With headers in which a struct has another size than in this library it returns a definition that
   ethd_loop_create refuses. [any] */
static inline ethd_loop_def ethd_loop_default(void) {
  ethd_loop_def def;
  ethd_loop_fill(&def, (uint32_t)sizeof def, (uint32_t)sizeof(ethd_loop_row), (uint32_t)sizeof(ethd_loop_stats),
                 (uint32_t)sizeof(ethd_space_row));
  return def;
}

/* Creates a loop, which doesn't run yet, locks the process's memory and makes the stack of the loop's thread; on a
   virtual clock neither. ETHD_E_ARGUMENT ("device": opened for the other kind of controller), ETHD_E_ABI (the driver's
   table), ETHD_E_RANGE with the field's name or "units" (a device has at most ETHD_UNITS_MAX); ETHD_E_MEMORY.
   ETHD_E_DEVICE: "xenomai" (this kernel has no Cobalt), "clock" (Cobalt's and Linux's differ, by error->found s),
   "thread". [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_loop_create(const ethd_loop_def *def, ethd_loop **out, ethd_error *error);

/* Stops, joins and frees the loop; NULL is allowed. If join failed because a thread hangs, nothing is freed; then don't
   destroy the controller either nor, after ETHD_E_DEVICE, the device. [main] */
ETHD_API void ethd_loop_destroy(ethd_loop *loop);

/* Starts the loop's thread and one for each unit of the device's blocking I/O (on a virtual clock none), runs one dry
   tick and arms the device. ETHD_E_DEVICE: error->name says what failed: "require_rt", after which nothing runs, or
   "thread". ETHD_E_ARGUMENT: it was started before; a loop starts only once. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_loop_start(ethd_loop *loop, ethd_error *error);

/* Runs one tick on the virtual clock; does nothing without one. [main] */
ETHD_API void ethd_loop_tick(ethd_loop *loop);

/* Disarms: from the next tick on the device gets zero torque, even without new samples; the loop goes on reading.
   [any] */
ETHD_API void ethd_loop_disarm(ethd_loop *loop);

/* Returns 1 while the device gets torques. A safe command of the controller or a failure of the device disarms.
   [any] */
ETHD_API int32_t ethd_loop_armed(const ethd_loop *loop);

/* Signals that the application is alive. An armed device is stopped if no beat comes within `heartbeat`. [any] */
ETHD_API void ethd_loop_beat(ethd_loop *loop);

/* Reports a row of the fault table that the application detects, such as an emergency stop or a signal. Its bit is set
   in the next sense only; raise it again while it lasts. [any] */
ETHD_API void ethd_loop_raise(ethd_loop *loop, ethd_fault fault);

/* Acknowledges the controller's fault before the next step. [any] */
ETHD_API void ethd_loop_acknowledge(ethd_loop *loop);

/* Starts the device again, restarts the controller and arms, with a soft start; meanwhile the loop uses neither. Must
   not be called while a posted setup waits. ETHD_STATUS_BUSY: the loop didn't release the device within a second; else
   the status of the device's start: if it isn't ETHD_OK, the loop is disarmed. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_loop_enable(ethd_loop *loop);

/* Calls the device's home, with the joints' angles, rad, or NULL (driver.h), while it is disarmed and the loop doesn't
   use it. A controller without a fault is then restarted, since the pose may jump. ETHD_STATUS_BUSY: the loop didn't
   release the device, or is armed. ETHD_E_ARGUMENT: the device has no home. ETHD_E_RANGE: an angle that isn't finite or
   is over ETHD_SENSE_ANGLE_MAX; else what its home returns. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_loop_home(ethd_loop *loop, const double *q);

/* Asks the threads to end; their last command is zero torque. [any] */
ETHD_API void ethd_loop_stop(ethd_loop *loop);

/* Waits for the threads, after ethd_loop_stop for a second at most (eight periods if they are over 0.1 s). ETHD_E_LAW:
   the loop's thread hangs in a law and will never touch the device again. ETHD_E_DEVICE: the clock failed or, if
   ethd_loop_ended is 0, the thread hangs in the device. [main] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_loop_join(ethd_loop *loop);

/* Reads the next row, in order; ETHD_STATUS_EMPTY when there is none. One reader at a time. [any] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_loop_take(ethd_loop *loop, ethd_loop_row *out);

/* The same for a loop in space. Each of the two returns ETHD_E_ARGUMENT for a loop of the other kind. [any] */
ETHD_API ETHD_MUST_CHECK ethd_status ethd_loop_take_space(ethd_loop *loop, ethd_space_row *out);

/* Returns ETHD_SHORT_* bits, known once it has started; 0 on a virtual clock. [main] */
ETHD_API int32_t ethd_loop_shortfalls(const ethd_loop *loop);

/* Returns 1 when the loop's thread has ended, by ethd_loop_stop or by itself. [any] */
ETHD_API int32_t ethd_loop_ended(const ethd_loop *loop);

/* Returns the periods since the start, missed ones included: the loop's time over its period. [any] */
ETHD_API uint64_t ethd_loop_periods(const ethd_loop *loop);

/* Returns 1 while the loop's thread hangs, as said above; *law is then the law in which it hangs, NULL if it hangs in
   the device's code. law may be NULL. [any] */
ETHD_API int32_t ethd_loop_hangs(const ethd_loop *loop, const ethd_law **law);

/* Gives the loop's statistics; while it runs, they may come from two neighbouring ticks. [main] */
ETHD_API void ethd_loop_read(const ethd_loop *loop, ethd_loop_stats *out);

ETHD_END_DECLS

#endif
