/* Ticks as a device has them: with cold caches, and in a loop that sleeps in between. */
#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bench/tick.h"
#include "cli/cli.h"
#include "clock.h"
#include "locked_memory.h"

static double *room_for(size_t count) {
  double *ns = calloc(count, sizeof *ns);
  if (!ns) ethd__fail(ETHD_EXIT_FAILED, "no memory");
  return ns;
}

/* ---- cold ---- */

#define EVICT ((size_t)32 << 20) /* bytes: over any second-level cache, and most third-level ones */

static void evict(unsigned char *buffer) {
  for (size_t i = 0; i < EVICT; i += 64) buffer[i]++;
}

/* Every fifth tick runs with cold caches, so that all phases of a tap are sampled. */
void ethd__tick_cold(FILE *csv, int quick) {
  size_t count = quick ? 100 : 1000;
  double *ns = room_for(count), cost = bench_clock_cost();
  unsigned char *buffer = calloc(1, EVICT);
  if (!buffer) ethd__fail(ETHD_EXIT_FAILED, "no memory");
  printf("  cold: 32 MB written before the tick\n");
  for (int s = 0; s < 2; s++) {
    ethd__ticking *t =
        ethd__ticking_create(&ethd_transition_offset, s ? ETHD__TAP_OUTLINE : ETHD__TAP_PLANE, 1000, ETHD__TAP_RAYS);
    for (size_t i = 0; i < 5 * count; i++) {
      if (i % 5 == 0) evict(buffer);
      const ethd_sense sense = *ethd__ticking_sense(t); /* a device has just written it */
      int64_t start = ethd__clock_now();
      ethd__ticking_step(t, &sense);
      if (i % 5 == 0) ns[i / 5] = fmax(0, (double)(ethd__clock_now() - start) - cost);
    }
    ethd__tick_report(csv, (ethd__tick_row){"cold", "offset", s ? "1000" : "wall", "rays"}, ns, count, NULL);
    ethd__ticking_destroy(t);
  }
  free(buffer);
  free(ns);
}

/* ---- live ---- */

#define PERIOD 1000000 /* ns */
#define EARLY 100000   /* ns: lead of an early loop over the tick */

typedef struct live_loop {
  ethd__ticking *tapping;
  int early; /* wake before the tick, rehearse, spin */
  double *ns;
  size_t count;
  int fifo; /* granted */
} live_loop;

static void sleep_until(int64_t t) {
  struct timespec at = {t / 1000000000, t % 1000000000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, NULL) == EINTR) continue;
}

static void warm(live_loop *l, const ethd_sense *sense, int64_t tick) {
  ethd_command command;
  for (int i = 0; i < 3; i++) (void)!ethd_control_rehearse(l->tapping->control, sense, &command);
  while (ethd__clock_now() < tick) continue;
}

static void *live(void *data) {
  live_loop *l = data;
  struct sched_param priority = {.sched_priority = 80};
  l->fifo = pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority) == 0;
  ethd__flush_denormals();
  double cost = bench_clock_cost();
  int64_t next = ethd__clock_now() + 10 * (int64_t)PERIOD;
  for (size_t i = 0; i < l->count; i++, next += PERIOD) {
    const ethd_sense sense = *ethd__ticking_sense(l->tapping);
    sleep_until(l->early ? next - EARLY : next);
    if (l->early) warm(l, &sense, next);
    int64_t start = ethd__clock_now();
    ethd__ticking_step(l->tapping, &sense);
    int64_t end = ethd__clock_now();
    l->ns[i] = fmax(0, (double)(end - start) - cost);
    while (next + PERIOD < end) next += PERIOD; /* ticks that were missed stay missed */
  }
  return NULL;
}

static void run_loop(live_loop *l) {
  pthread_t thread;
  if (pthread_create(&thread, NULL, live, l) != 0) ethd__fail(ETHD_EXIT_FAILED, "no thread");
  pthread_join(thread, NULL);
}

void ethd__tick_live(FILE *csv, int quick) {
  size_t count = quick ? 1500 : 20000;
  double *ns = room_for(count);
  bool locked = ethd__memory_lock();
  for (int early = 0; early < 2; early++) {
    live_loop l = {ethd__ticking_create(&ethd_transition_offset, ETHD__TAP_OUTLINE, 1000, ETHD__TAP_RAYS), early, ns,
                   count, 0};
    run_loop(&l);
    if (!early)
      printf("  live: 1 kHz, clock_nanosleep, %s, memory %s; early: awake 100 us before, three dry ticks\n",
             l.fifo ? "SCHED_FIFO 80" : "SCHED_OTHER (SCHED_FIFO isn't allowed)", locked ? "locked" : "not locked");
    ethd__tick_report(csv, (ethd__tick_row){early ? "live early" : "live", "offset", "1000", "rays"}, ns, count, NULL);
    ethd__ticking_destroy(l.tapping);
  }
  if (locked) munlockall();
  free(ns);
}
