/* The thread that watches the loop's thread: it disarms the device when the loop's thread is dead. */
#include <stdbool.h>
#include <time.h>

#include "loop/loop.h"

#define SOON 1000000      /* ns until the next check while a step hangs */
#define LOOK_MAX 10000000 /* ns between two checks at most */

typedef struct watch {
  int64_t now, turned, alive; /* ns */
  int64_t silent;             /* ns without a cycle, counted by this thread: not while the whole process is stopped */
} watch;

/* Returns ns until the loop's thread counts as dead: after silence for `gap`, if that is set, or after a step longer
   than ETHD__LOOP_STEP_MAX, whichever comes first. */
static int64_t left_to_live(const ethd_loop *l, const watch *w) {
  int64_t step = atomic_load_explicit(&l->stepping, memory_order_relaxed);
  int64_t gap = l->gap > 2 * l->period ? l->gap : 2 * l->period; /* a period lies between two cycles */
  int64_t by_gap = l->gap < INT64_MAX ? w->alive + gap - w->now : INT64_MAX;
  int64_t by_step = step ? step + ETHD__LOOP_STEP_MAX - w->now : INT64_MAX;
  return by_gap < by_step ? by_gap : by_step;
}

/* Disarms the device from this thread, and raises the fault in case the loop resumes at this moment. */
static void let_go(ethd_loop *l) {
  ethd_loop_raise(l, ETHD_FAULT_LOOP);
  ethd_loop_disarm(l);
  ethd_device_safe(l->def.device);
}

static void look(ethd_loop *l, watch *w) {
  int64_t turned = atomic_load_explicit(&l->turned, memory_order_relaxed), now = ethd__loop_now(l);
  int64_t hang = ETHD__LOOP_HANG > 4 * l->period ? ETHD__LOOP_HANG : 4 * l->period;
  w->silent = turned == w->turned ? w->silent + (now - w->now < 2 * LOOK_MAX ? now - w->now : 2 * LOOK_MAX) : 0;
  w->turned = turned;
  w->now = now;
  if (turned > w->alive) w->alive = turned;
  if (!ethd_loop_armed(l)) w->alive = now;
  atomic_store_explicit(&l->hangs, w->silent >= hang, memory_order_release);
}

void *ethd__loop_watch(void *loop) {
  ethd_loop *l = loop;
  watch w = {.now = ethd__loop_now(l), .alive = ethd__loop_now(l)};
  while (!ethd_loop_ended(l) && !atomic_load_explicit(&l->left, memory_order_relaxed)) {
    int64_t left = left_to_live(l, &w);
    /* after the device is safe, the thread only waits for the end of the hanging step */
    struct timespec t = {.tv_nsec = left < 1 ? SOON : left < LOOK_MAX ? left : LOOK_MAX};
    nanosleep(&t, NULL);
    look(l, &w);
    if (ethd_loop_armed(l) && left_to_live(l, &w) <= 0) let_go(l);
  }
  return NULL;
}
