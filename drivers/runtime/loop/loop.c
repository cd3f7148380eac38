/* A loop's functions for any thread, and its tick on a virtual clock. */
#include <string.h>
#include <unistd.h>

#include "denormals.h"
#include "loop/loop.h"

/* ---- the virtual clock ---- */

uint32_t ethd__loop_units(const ethd_loop *l) { return ethd_device_units(l->def.device); }

void ethd_loop_tick(ethd_loop *l) {
  if (!l->def.clock) return; /* the loop's thread does its ticks */
  uint64_t before = ethd__denormals_flush();
  for (uint32_t i = 0; i < ethd__loop_units(l); i++)
    if (ethd_device_service(l->def.device, i, ethd__loop_now(l)) < 0) l->stats.service_failures++;
  (void)!ethd__loop_turn(l);
  ethd__denormals_restore(before);
}

/* ---- other threads ---- */

bool ethd__loop_is_forked(const ethd_loop *l) { return l->process && l->process != getpid(); }

int32_t ethd_loop_armed(const ethd_loop *l) {
  return atomic_load_explicit(&l->armed, memory_order_relaxed) && !ethd__loop_is_forked(l);
}

int32_t ethd_loop_ended(const ethd_loop *l) {
  return atomic_load_explicit(&l->ended, memory_order_acquire) || ethd__loop_is_forked(l);
}

int32_t ethd_loop_hangs(const ethd_loop *l, const ethd_law **law) {
  int32_t hangs = atomic_load_explicit(&l->hangs, memory_order_acquire) && !ethd__loop_is_forked(l);
  if (law) *law = hangs ? l->front->law(l) : NULL;
  return hangs;
}

int32_t ethd_loop_shortfalls(const ethd_loop *l) { return l->shortfalls; }
void ethd_loop_disarm(ethd_loop *l) { atomic_store_explicit(&l->armed, 0, memory_order_relaxed); }
void ethd_loop_acknowledge(ethd_loop *l) { atomic_store_explicit(&l->clear, 1, memory_order_relaxed); }
void ethd_loop_beat(ethd_loop *l) { atomic_fetch_add_explicit(&l->beats, 1, memory_order_relaxed); }

void ethd_loop_raise(ethd_loop *l, ethd_fault fault) {
  if (fault > ETHD_FAULT_NONE && fault < ETHD_FAULT_COUNT)
    atomic_fetch_or_explicit(&l->raised, ETHD_FAULT_BIT(fault), memory_order_relaxed);
}

void ethd_loop_stop(ethd_loop *l) { atomic_store_explicit(&l->stop, 1, memory_order_relaxed); }

static ethd_status take(ethd_loop *l, void *out) {
  ethd__loop_ring *r = &l->rows;
  unsigned tail = atomic_load_explicit(&r->tail, memory_order_relaxed);
  if (tail == atomic_load_explicit(&r->head, memory_order_acquire)) return ETHD_STATUS_EMPTY;
  ethd__loop_copy(l, r->at + (tail % r->size) * r->bytes, out);
  atomic_store_explicit(&r->tail, tail + 1, memory_order_release);
  return ETHD_OK;
}

ethd_status ethd_loop_take(ethd_loop *l, ethd_loop_row *out) {
  return l->front == &ethd__loop_plane ? take(l, out) : ETHD_E_ARGUMENT;
}

ethd_status ethd_loop_take_space(ethd_loop *l, ethd_space_row *out) {
  return l->front == &ethd__loop_space ? take(l, out) : ETHD_E_ARGUMENT;
}

static uint64_t seen(const uint64_t *count) { return __atomic_load_n(count, __ATOMIC_RELAXED); }

uint64_t ethd_loop_periods(const ethd_loop *l) { return seen(&l->stats.ticks) + seen(&l->stats.missed); }

static void read_histogram(const ethd_histogram *h, ethd_histogram *out) {
  for (uint32_t i = 0; i < ETHD_BINS; i++) out->count += out->counts[i] = seen(&h->counts[i]);
  out->max = __atomic_load_n(&h->max, __ATOMIC_RELAXED);
}

/* The controller's own count is consistent only between two of its steps. Rows of a hanging thread are counted here. */
static void read_faults(const ethd_loop *l, uint64_t out[ETHD_FAULT_COUNT]) {
  ethd_counters now = {0};
  int64_t raised = 0;
  if (l->def.clock || ethd_loop_ended(l))
    l->front->counters(l, &now);
  else if (ethd_loop_hangs(l, NULL))
    raised = atomic_load_explicit(&l->raised, memory_order_relaxed);
  for (int i = 0; i < ETHD_FAULT_COUNT; i++)
    out[i] = l->faults[i] + now.faults[i] + ((raised & ETHD_FAULT_BIT(i)) != 0);
}

void ethd_loop_read(const ethd_loop *l, ethd_loop_stats *out) {
  const ethd_loop_stats *s = &l->stats;
  *out = (ethd_loop_stats){.ticks = seen(&s->ticks),
                           .overruns = seen(&s->overruns),
                           .missed = seen(&s->missed),
                           .relaxes = ethd__xenomai_relaxes(),
                           .read_failures = seen(&s->read_failures),
                           .write_failures = seen(&s->write_failures),
                           .service_failures = seen(&s->service_failures),
                           .rows_lost = seen(&s->rows_lost)};
  read_histogram(&s->wake, &out->wake);
  read_histogram(&s->tick, &out->tick);
  read_faults(l, out->faults);
}
