/* Makes a loop from its definition, and destroys it. [main] */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "loop/loop.h"

#define COOKIE 0x6c6f6f70u
#define SKEWED 0x6c6f6f80u /* + i: the definition of a program in which struct i has another size */

static const struct {
  const char *name;
  uint32_t size;
} sized[] = {{"ethd_loop_def", sizeof(ethd_loop_def)},
             {"ethd_loop_row", sizeof(ethd_loop_row)},
             {"ethd_loop_stats", sizeof(ethd_loop_stats)},
             {"ethd_space_row", sizeof(ethd_space_row)}};
#define SIZED (sizeof sized / sizeof *sized)

void ethd_loop_fill(ethd_loop_def *def, uint32_t def_size, uint32_t row_size, uint32_t stats_size,
                    uint32_t space_row_size) {
  const uint32_t there[SIZED] = {def_size, row_size, stats_size, space_row_size};
  uint32_t i = 0;
  while (i < SIZED && there[i] == sized[i].size) i++;
  memset(def, 0, def_size);
  if (i < SIZED) {
    def->cookie = SKEWED + i;
    def->bytes = there[i];
    return;
  }
  *def = (ethd_loop_def){.cookie = COOKIE,
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

static ethd_status within(ethd_error *error, const char *name, double found, double min, double max) {
  if (found >= min && found <= max) return ETHD_OK;
  return ethd__loop_refuse(error, ETHD_E_RANGE, name, found, min, max);
}

static const ethd__loop_front *front_of(const ethd_loop_def *d) {
  return d->space ? &ethd__loop_space : &ethd__loop_plane;
}

/* The controller computes speeds with its own period, so with another period of the loop they would be wrong. */
static ethd_status check_period(const ethd_loop_def *d, ethd_error *error) {
  double period = front_of(d)->period(d);
  if (d->period == period) return ETHD_OK;
  return ethd__loop_refuse(error, ETHD_E_ARGUMENT, "period", d->period, period, period);
}

static ethd_status check(const ethd_loop_def *d, ethd_error *error) {
  const uint32_t skewed = d->cookie - SKEWED;
  if (skewed < SIZED)
    return ethd__loop_refuse(error, ETHD_E_SIZE, sized[skewed].name, d->bytes, sized[skewed].size, sized[skewed].size);
  if (d->cookie != COOKIE) return ethd__loop_refuse(error, ETHD_E_ARGUMENT, "ethd_loop_def", NAN, NAN, NAN);
  if (!d->device) return ethd__loop_refuse(error, ETHD_E_ARGUMENT, "device", NAN, NAN, NAN);
  if (!d->control == !d->space)
    return ethd__loop_refuse(error, ETHD_E_ARGUMENT, d->space ? "control and space" : "control", NAN, NAN, NAN);
  if (ethd_device_in_space(d->device) != (d->space != NULL))
    return ethd__loop_refuse(error, ETHD_E_ARGUMENT, "device", NAN, NAN, NAN);
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
  return status ? status : check_period(d, error);
}

static int64_t nanoseconds(double s) { return s < 1e9 ? llrint(1e9 * s) : INT64_MAX; }

/* Returns the limit of the loop's lateness: the smaller of the application's limit and the tolerance of any device. The
   longer spacing of a slow device's samples doesn't change it. */
static double gap_of(const ethd_loop_def *d) {
  bool is_limited = isfinite(ethd_device_limits(d->device).gap);
  return is_limited ? fmin(d->gap, ethd_limits_device().gap) : d->gap;
}

/* Returns the longest spacing of two joint samples that application and device allow, s. */
static double between_samples(const ethd_loop_def *d) { return fmin(d->gap, ethd_device_limits(d->device).gap); }

ethd_status ethd_loop_create(const ethd_loop_def *def, ethd_loop **out, ethd_error *error) {
  *out = NULL;
  ethd_status status = check(def, error);
  if (status) return status;
  size_t size = (sizeof(ethd_loop) + 63) / 64 * 64;
  ethd_loop *l = aligned_alloc(64, size);
  if (!l) return ethd__loop_refuse(error, ETHD_E_MEMORY, "loop", NAN, NAN, NAN);
  memset(l, 0, size);
  l->def = *def;
  l->front = front_of(def);
  l->period = llrint(1e9 * def->period);
  l->early = llrint(1e9 * def->early_wake);
  l->gap = nanoseconds(gap_of(def));
  int64_t apart = nanoseconds(fmin(between_samples(def), 1)) +
                  1; /* one more, because a gap in seconds may be rounded down in binary */
  l->hold = (apart < ETHD__HOLD_MAX ? apart : ETHD__HOLD_MAX) / l->period - 1;
  if (l->hold < 0) l->hold = 0; /* a longer period holds each torque for one period */
  l->heartbeat = nanoseconds(def->heartbeat);
  l->dma_latency = -1;
  l->rows.size = def->rows;
  l->rows.bytes = l->front->row;
  l->rows.at = calloc(def->rows ? def->rows : 1, l->rows.bytes);
  if (!l->rows.at) status = ethd__loop_refuse(error, ETHD_E_MEMORY, "rows", NAN, NAN, NAN);
  if (!status && !def->clock) status = ethd__loop_ask_machine(l, error);
  if (status) {
    ethd_loop_destroy(l);
    return status;
  }
  *out = l;
  return ETHD_OK;
}

void ethd_loop_destroy(ethd_loop *l) {
  if (!l) return;
  ethd_loop_stop(l);
  (void)!ethd_loop_join(l);
  if (atomic_load_explicit(&l->left, memory_order_relaxed)) return; /* a thread that hangs may still use it */
  free(l->rows.at);
  free(l);
}
