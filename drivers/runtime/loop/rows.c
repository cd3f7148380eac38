/* Rows of the fault table that the loop itself sees. */
#include "loop/loop.h"

/* A leaky bucket, because many short delays are as bad as one long delay. */
#define POUR 10
#define FULL 50
#define BRIM 100 /* the bucket holds no more */

void ethd__loop_late(ethd_loop *l, int64_t ns) {
  l->bucket = l->bucket + POUR < BRIM ? l->bucket + POUR : BRIM;
  if (ns > l->late) l->late = ns;
}

/* If the second clock is ahead by more than before, the machine was suspended, which the loop's clock doesn't show.
   A delay between the two readings makes `least` smaller and `most` larger, so that it doesn't count as a
   suspension. */
void ethd__loop_ahead(ethd_loop *l, int64_t least, int64_t most) {
  int64_t slept = least - l->ahead;
  l->ahead = most;
  if (slept < l->period) return;
  l->slept += slept;
  l->missed += slept / l->period;
}

static void suspended(ethd_loop *l, ethd__sense_head *sense) {
  int64_t *rows = l->slept > l->gap ? &sense->grave : &sense->faults;
  *rows |= ETHD_FAULT_BIT(ETHD_FAULT_CLOCK);
  l->slept = 0;
}

static int64_t overruns(ethd_loop *l) {
  int64_t rows = l->late ? ETHD_FAULT_BIT(ETHD_FAULT_OVERRUN) : 0;
  if (l->gap < INT64_MAX && (l->bucket >= FULL || l->late > l->gap)) rows |= ETHD_FAULT_BIT(ETHD_FAULT_OVERRUNS);
  if (!l->late && l->bucket) l->bucket--;
  l->late = 0;
  return rows;
}

/* The application counts its beats; the loop notes the tick at which it saw a new one. */
static int64_t heartbeat(ethd_loop *l) {
  unsigned beats = atomic_load_explicit(&l->beats, memory_order_relaxed);
  int armed = atomic_load_explicit(&l->armed, memory_order_relaxed);
  if (beats != l->beats_seen || !armed || !l->beat_at) l->beat_at = l->due;
  l->beats_seen = beats;
  return l->due - l->beat_at > l->heartbeat ? ETHD_FAULT_BIT(ETHD_FAULT_APPLICATION) : 0;
}

void ethd__loop_rows(ethd_loop *l, ethd__sense_head *sense) {
  if (l->step > ETHD__LOOP_STEP_MAX) sense->faults |= ETHD_FAULT_BIT(ETHD_FAULT_BUDGET);
  if (atomic_load_explicit(&l->raised, memory_order_relaxed))
    sense->faults |= atomic_exchange_explicit(&l->raised, 0, memory_order_relaxed);
  if (l->late || l->bucket) sense->faults |= overruns(l);
  if (l->slept) suspended(l, sense);
  if (l->heartbeat < INT64_MAX) sense->faults |= heartbeat(l);
}
