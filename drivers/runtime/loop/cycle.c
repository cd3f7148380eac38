/* The control thread's work in each tick. Nothing here allocates or locks, and the only system call is the sleep. */
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "loop/loop.h"

#define REHEARSALS 3 /* steps that are rehearsed after an early wake-up */

/* ---- clock ---- */

int64_t ethd__loop_now(const ethd_loop *l) {
  struct timespec t;
  if (l->def.clock) return *l->def.clock;
  __RT(clock_gettime)(CLOCK_MONOTONIC, &t);
  return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

/* Cobalt's clock isn't Linux's and stops while the machine is suspended, so nothing is compared there. */
int64_t ethd__loop_boot(const ethd_loop *l) {
  if (l->def.clock) return *l->def.clock + (l->def.suspended ? *l->def.suspended : 0);
#if defined(__COBALT__)
  return ethd__loop_now(l);
#else
  struct timespec t;
  clock_gettime(CLOCK_BOOTTIME, &t);
  return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
#endif
}

static int sleep_until(const ethd_loop *l, int64_t instant) {
  struct timespec t = {.tv_sec = (time_t)(instant / 1000000000), .tv_nsec = (long)(instant % 1000000000)};
  int failure;
  if (l->def.clock) {
    if (*l->def.clock < instant) *l->def.clock = instant;
    return 0;
  }
  do failure = __RT(clock_nanosleep)(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL);
  while (failure == EINTR);
  return failure;
}

/* ---- rows ---- */

static bool room(const ethd__loop_ring *r) {
  return atomic_load_explicit(&r->head, memory_order_relaxed) - atomic_load_explicit(&r->tail, memory_order_acquire) <
         r->size;
}

static void raise(uint64_t *count, uint64_t by) { __atomic_store_n(count, *count + by, __ATOMIC_RELAXED); }

static void push(ethd_loop *l) {
  ethd__loop_ring *r = &l->rows;
  if (!r->size) return;
  if (!room(r)) {
    l->tail.lost++;
    raise(&l->stats.rows_lost, 1);
    return;
  }
  unsigned head = atomic_load_explicit(&r->head, memory_order_relaxed);
  memcpy((char *)&l->row + l->front->tail, &l->tail, sizeof l->tail);
  ethd__loop_copy(l, &l->row, r->at + (head % r->size) * r->bytes);
  atomic_store_explicit(&r->head, head + 1, memory_order_release);
  l->tail.lost = 0;
  l->tail.marks = 0;
}

/* ---- one tick ---- */

/* The state of a device that can't be read is unknown, so the controller gets NaN and reports its input fault. */
static void blind(ethd_loop *l) {
  raise(&l->stats.read_failures, 1);
  l->sense.head.have = 0;
  l->sense.head.time_ns = l->due;
  l->front->blind(l);
}

/* A row that removes the torque acts at once. A stop waits for the next sample: with an old one the ring's speed would
   seem to fall. If none comes, row FEEDBACK_OLD ends the torque. */
static bool is_pressing(const ethd__sense_head *s) {
  for (int64_t rows = s->faults | s->grave; rows; rows &= rows - 1) {
    ethd_fault row = (ethd_fault)__builtin_ctzll((uint64_t)rows);
    if (ethd_fault_reaction(row, s->grave >> row & 1) > ETHD_REACTION_STOP) return true;
  }
  return 0;
}

/* A torque isn't held for longer than the allowed gap between two steps. Before the first step after a start no torque
   is held, and the device may take a little longer. */
static void watch_age(ethd_loop *l, ethd_status status) {
  l->stale = status > 0 ? l->stale + 1 : 0;
  if (l->stale > (l->ramp ? l->hold : ETHD__HOLD_MAX / l->period))
    l->sense.head.faults |= ETHD_FAULT_BIT(ETHD_FAULT_FEEDBACK_OLD);
}

static void disarm(ethd_loop *l) {
  atomic_store_explicit(&l->armed, 0, memory_order_relaxed);
  if (l->was_armed) ethd_device_safe(l->def.device);
  l->was_armed = 0;
}

/* False if there is no newer sample than at the last step: the torque is then held, unless the loop was disarmed. */
static bool read_device(ethd_loop *l) {
  ethd_status status = l->front->read(l);
  watch_age(l, status);
  ethd__loop_rows(l, &l->sense.head);
  if (status > 0 && !is_pressing(&l->sense.head)) {
    if (!atomic_load_explicit(&l->armed, memory_order_relaxed)) disarm(l);
    l->held++;
    l->missed++;
    return false;
  }
  l->known |= status == ETHD_OK;
  if (status < 0 || !l->known)
    blind(l);
  else
    l->front->remember(l, status == ETHD_OK);
  l->held = 0;
  l->sense.head.missed = l->missed;
  l->sense.head.step_ns = l->step;
  return 1;
}

/* The share of the command that the device gets. Periods without a step, on a slow bus, count as well. */
static double share(ethd_loop *l) {
  if (l->ramp) l->ramp += l->sense.head.missed;
  double t = (double)l->ramp++ * l->def.period;
  return t < l->def.soft_start ? t / l->def.soft_start : 1;
}

static void write_device(ethd_loop *l) {
  if (l->front->is_safe(l) || !atomic_load_explicit(&l->armed, memory_order_relaxed))
    disarm(l);
  else
    l->was_armed = 1;
  l->tail.share = l->was_armed ? share(l) : 0;
  l->tail.armed = l->was_armed;
  if (l->front->write(l, l->was_armed, l->tail.share) >= 0) return;
  raise(&l->stats.write_failures, 1);
  disarm(l);
}

/* Publishes the step's start for the watching thread. */
static int64_t begin_step(ethd_loop *l) {
  int64_t now = ethd__loop_now(l);
  atomic_store_explicit(&l->stepping, now, memory_order_relaxed);
  return now;
}

/* If [main] abandoned this thread while the step hung, the thread no longer owns the device or any other data. */
static void end_step(ethd_loop *l) {
  if (atomic_exchange_explicit(&l->stepping, 0, memory_order_acq_rel) != ETHD__LOOP_LEFT) return;
  for (;;) (void)!sleep_until(l, ethd__loop_now(l) + 1000000000);
}

static void step(ethd_loop *l) {
  if (atomic_load_explicit(&l->clear, memory_order_relaxed)) {
    atomic_store_explicit(&l->clear, 0, memory_order_relaxed);
    l->front->acknowledge(l);
    l->tail.marks |= ETHD_ROW_CLEARED;
  }
  int64_t begin = begin_step(l);
  if (l->front->look) l->front->look(l);
  if (l->dry) l->front->rehearse(l);
  if (l->dry) begin = ethd__loop_now(l);
  l->dry = 0;
  const bool swapped = l->front->step(l);
  l->tail.swaps += swapped;
  l->step = ethd__loop_now(l) - begin;
  end_step(l);
  l->missed = 0;
}

static void tick(ethd_loop *l) {
  raise(&l->stats.ticks, 1);
  if (!read_device(l)) return;
  step(l);
  write_device(l);
  push(l);
}

void ethd__loop_rest(ethd_loop *l) {
  l->was_armed = 1;
  disarm(l);
  (void)!l->front->write(l, false, 0);
}

/* ---- the grid ---- */

static void overrun(ethd_loop *l, int64_t late, int64_t periods) {
  ethd__loop_late(l, late);
  raise(&l->stats.overruns, 1);
  raise(&l->stats.missed, (uint64_t)periods);
  l->missed += periods;
  l->due += periods * l->period;
}

/* Sleeps until the tick. With early wake the caches are then warm and the start is exact. */
static int wait(ethd_loop *l) {
  int failure = sleep_until(l, l->due - l->early);
  if (failure) return failure;
  int64_t now = ethd__loop_now(l), late = now - (l->due - l->early);
  ethd_histogram_add(&l->stats.wake, late);
  if (l->early && !l->dry) {
    (void)begin_step(l);
    for (int i = 0; i < REHEARSALS; i++) l->front->rehearse(l);
    end_step(l);
    while (!l->def.clock && (now = ethd__loop_now(l)) < l->due) continue;
  }
  if (now - l->due >= l->period) overrun(l, now - l->due, (now - l->due) / l->period);
  return 0;
}

/* Sets the next tick to the grid's next instant in the future. */
static void advance(ethd_loop *l) {
  l->due += l->period;
  int64_t late = ethd__loop_now(l) - l->due;
  if (late > 0) overrun(l, late, (late + l->period - 1) / l->period);
}

/* True once [main] has asked for the device, unless it withdraws at the same moment. */
static bool parked(ethd_loop *l) {
  int mode = ETHD__LOOP_ASKED;
  return atomic_compare_exchange_strong_explicit(&l->mode, &mode, ETHD__LOOP_PARKED, memory_order_acq_rel,
                                                 memory_order_acquire) ||
         mode == ETHD__LOOP_PARKED;
}

int ethd__loop_turn(ethd_loop *l) {
  atomic_store_explicit(&l->turned, l->due - l->period, memory_order_relaxed);
  /* while parked, [main] may be using all but the clock */
  if (parked(l)) {
    l->due += l->period;
    return sleep_until(l, l->due);
  }
  int failure = wait(l);
  if (failure) return failure;
  int64_t boot = ethd__loop_boot(l), begin = ethd__loop_now(l);
  ethd__loop_ahead(l, boot - begin, boot - l->due);
  tick(l);
  ethd_histogram_add(&l->stats.tick, ethd__loop_now(l) - begin);
  advance(l);
  return 0;
}

/* The loop doesn't end while [main] has the device. */
static bool told_to_stop(ethd_loop *l) {
  return atomic_load_explicit(&l->stop, memory_order_relaxed) &&
         atomic_load_explicit(&l->mode, memory_order_acquire) == ETHD__LOOP_RUNS;
}

int ethd__loop_cycle(ethd_loop *l) {
  int failure = 0;
  l->due = ethd__loop_now(l) + l->period;
  while (!failure && !told_to_stop(l)) failure = ethd__loop_turn(l);
  ethd__loop_rest(l);
  return failure;
}
