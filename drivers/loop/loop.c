#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "denormals.h"
#include "loop/loop.h"

#define COOKIE 0x6c6f6f70u

ethd_loop_def ethd_loop_default(void) {
  return (ethd_loop_def){.cookie = COOKIE,
                         .period = 1e-3,
                         .cpu = ETHD_CPU_NONE,
                         .priority = 80,
                         .dma_latency = -1,
                         .soft_start = 0.1,
                         .gap = (double)INFINITY,
                         .heartbeat = (double)INFINITY,
                         .stack = (size_t)256 << 10,
                         .rows = 4096};
}

ethd_status ethd__loop_refuse(ethd_error *error, ethd_status status, const char *name, double found, double min,
                              double max) {
  if (!error) return status;
  *error = (ethd_error){.status = status, .found = found, .min = min, .max = max};
  size_t n = strnlen(name, sizeof error->name - 1);
  memcpy(error->name, name, n);
  return status;
}

/* ---- create ---- */

static ethd_status within(ethd_error *error, const char *name, double found, double min, double max) {
  if (found >= min && found <= max) return ETHD_OK;
  return ethd__loop_refuse(error, ETHD_E_RANGE, name, found, min, max);
}

static ethd_status check(const ethd_loop_def *d, ethd_error *error) {
  if (d->cookie != COOKIE) return ethd__loop_refuse(error, ETHD_E_ARGUMENT, "ethd_loop_def", NAN, NAN, NAN);
  if (!d->driver) return ethd__loop_refuse(error, ETHD_E_ARGUMENT, "driver", NAN, NAN, NAN);
  if (!d->control) return ethd__loop_refuse(error, ETHD_E_ARGUMENT, "control", NAN, NAN, NAN);
  if (d->driver->abi != ETHD_DRIVER_ABI || d->driver->size < sizeof *d->driver)
    return ethd__loop_refuse(error, ETHD_E_ABI, "driver", NAN, NAN, NAN);
  if (!d->driver->start || !d->driver->read || !d->driver->write || !d->driver->safe)
    return ethd__loop_refuse(error, ETHD_E_ARGUMENT, "driver", NAN, NAN, NAN);
  if (d->rows & (d->rows - 1)) return ethd__loop_refuse(error, ETHD_E_RANGE, "rows", d->rows, 0, 0x1p20);
  ethd_status status = within(error, "period", d->period, 1e-5, 1);
  if (!status) status = within(error, "cpu", d->cpu, ETHD_CPU_AUTO, 1023);
  if (!status) status = within(error, "priority", d->priority, 1, 99);
  if (!status) status = within(error, "dma_latency", d->dma_latency, -1, 1e6);
  if (!status) status = within(error, "early_wake", d->early_wake, 0, d->period / 2);
  if (!status) status = within(error, "soft_start", d->soft_start, 0, 10);
  if (!status) status = within(error, "gap", d->gap, d->period, (double)INFINITY);
  if (!status) status = within(error, "heartbeat", d->heartbeat, d->period, (double)INFINITY);
  if (!status) status = within(error, "stack", (double)d->stack, 65536, 0x1p26);
  if (!status) status = within(error, "rows", d->rows, 0, 0x1p20);
  return status;
}

static int64_t nanoseconds(double s) { return s < 1e9 ? llrint(1e9 * s) : INT64_MAX; }

/* The narrower of the application's and what any device stands: how far apart a slow device's own samples are says
   nothing of the loop's lateness. */
static double gap_of(const ethd_loop_def *d) {
  bool is_limited = d->driver->limits && d->device && isfinite(d->driver->limits(d->device).gap);
  return is_limited ? fmin(d->gap, ethd_limits_device().gap) : d->gap;
}

/* s: so far two joint samples may lie apart, by the application and the device. */
static double between_samples(const ethd_loop_def *d) {
  if (!d->driver->limits || !d->device) return d->gap;
  return fmin(d->gap, d->driver->limits(d->device).gap);
}

ethd_status ethd_loop_create(const ethd_loop_def *def, ethd_loop **out, ethd_error *error) {
  *out = NULL;
  ethd_status status = check(def, error);
  if (status) return status;
  size_t size = (sizeof(ethd_loop) + 63) / 64 * 64;
  ethd_loop *l = aligned_alloc(64, size);
  if (!l) return ethd__loop_refuse(error, ETHD_E_MEMORY, "loop", NAN, NAN, NAN);
  memset(l, 0, size);
  l->def = *def;
  l->period = llrint(1e9 * def->period);
  l->early = llrint(1e9 * def->early_wake);
  l->gap = nanoseconds(gap_of(def));
  int64_t apart =
      nanoseconds(fmin(between_samples(def), 1)) + 1; /* a gap that isn't exact in binary counts as what it's meant */
  l->hold = (apart < ETHD__HOLD_MAX ? apart : ETHD__HOLD_MAX) / l->period - 1;
  l->heartbeat = nanoseconds(def->heartbeat);
  l->dma_latency = -1;
  l->rows.size = def->rows;
  l->rows.at = calloc(def->rows ? def->rows : 1, sizeof *l->rows.at);
  if (!l->rows.at) {
    ethd_loop_destroy(l);
    return ethd__loop_refuse(error, ETHD_E_MEMORY, "rows", NAN, NAN, NAN);
  }
  *out = l;
  return ETHD_OK;
}

void ethd_loop_destroy(ethd_loop *l) {
  if (!l) return;
  ethd_loop_stop(l);
  (void)!ethd_loop_join(l);
  if (atomic_load_explicit(&l->left, memory_order_relaxed)) return; /* a hung thread may still live in it */
  free(l->rows.at);
  free(l);
}

/* ---- the virtual clock ---- */

uint32_t ethd__loop_units(const ethd_loop *l) {
  uint32_t (*units)(const void *) = l->def.driver->units;
  uint32_t n = units ? units(l->def.device) : 0;
  return n < ETHD_UNITS_MAX ? n : ETHD_UNITS_MAX;
}

void ethd_loop_tick(ethd_loop *l) {
  uint64_t before = ethd__denormals_flush();
  for (uint32_t i = 0; i < ethd__loop_units(l); i++)
    if (l->def.driver->service(l->def.device, i, ethd__loop_now(l)) < 0) l->stats.service_failures++;
  (void)!ethd__loop_turn(l);
  ethd__denormals_restore(before);
}

/* ---- other threads ---- */

int32_t ethd_loop_armed(const ethd_loop *l) { return atomic_load_explicit(&l->armed, memory_order_relaxed); }
int32_t ethd_loop_ended(const ethd_loop *l) { return atomic_load_explicit(&l->ended, memory_order_acquire); }

int32_t ethd_loop_hangs(const ethd_loop *l, const ethd_law **law) {
  int32_t hangs = atomic_load_explicit(&l->hangs, memory_order_acquire);
  if (law) *law = hangs ? ethd_control_law(l->def.control) : NULL;
  return hangs;
}

int32_t ethd_loop_shortfalls(const ethd_loop *l) { return l->shortfalls; }
void ethd_loop_disarm(ethd_loop *l) { atomic_store_explicit(&l->armed, 0, memory_order_relaxed); }
void ethd_loop_clear(ethd_loop *l) { atomic_store_explicit(&l->clear, 1, memory_order_relaxed); }
void ethd_loop_beat(ethd_loop *l) { atomic_fetch_add_explicit(&l->beats, 1, memory_order_relaxed); }

void ethd_loop_raise(ethd_loop *l, ethd_fault fault) {
  if (fault > ETHD_FAULT_NONE && fault < ETHD_FAULT_COUNT)
    atomic_fetch_or_explicit(&l->raised, ETHD_FAULT_BIT(fault), memory_order_relaxed);
}

void ethd_loop_stop(ethd_loop *l) { atomic_store_explicit(&l->stop, 1, memory_order_relaxed); }

ethd_status ethd_loop_take(ethd_loop *l, ethd_loop_row *out) {
  ethd__loop_ring *r = &l->rows;
  unsigned tail = atomic_load_explicit(&r->tail, memory_order_relaxed);
  if (tail == atomic_load_explicit(&r->head, memory_order_acquire)) return ETHD_EMPTY;
  *out = r->at[tail % r->size];
  atomic_store_explicit(&r->tail, tail + 1, memory_order_release);
  return ETHD_OK;
}

static uint64_t seen(const uint64_t *count) { return __atomic_load_n(count, __ATOMIC_RELAXED); }

uint64_t ethd_loop_periods(const ethd_loop *l) { return seen(&l->stats.ticks) + seen(&l->stats.missed); }

static void read_histogram(const ethd_histogram *h, ethd_histogram *out) {
  for (uint32_t i = 0; i < ETHD_BINS; i++) out->count += out->counts[i] = seen(&h->counts[i]);
  out->max = __atomic_load_n(&h->max, __ATOMIC_RELAXED);
}

/* The controller's own count is whole only between two of its steps. A thread that hangs takes no rows: they count
   here. */
static void read_faults(const ethd_loop *l, uint64_t out[ETHD_FAULT_COUNT]) {
  ethd_counters now = {0};
  int64_t raised = 0;
  if (l->def.clock || ethd_loop_ended(l))
    ethd_control_counters(l->def.control, &now);
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
