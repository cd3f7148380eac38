/* The delay of a device that doesn't give it. */
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <time.h>

#include "check/report.h"
#include "clock.h"

#define DURATION 0.5 /* s of measuring */
#define SAMPLES 5    /* least number of samples */
#define PAUSE 200000 /* ns after a service without work */

typedef struct io {
  ethd_device *device;
  uint32_t unit;
  atomic_bool *ends;
} io;

/* Does the work of a unit's I/O thread. */
static void *serve(void *context) {
  const io *u = context;
  while (!atomic_load(u->ends))
    if (ethd_device_service(u->device, u->unit, ethd__clock_now()) != ETHD_OK)
      nanosleep(&(struct timespec){.tv_nsec = PAUSE}, NULL);
  return NULL;
}

/* Reads at every period as the loop does and returns the longest spacing of two samples, s; NAN: too few came. */
static double watch(ethd_device *device, double period) {
  double most = 0;
  int64_t begin = ethd__clock_now(), due = begin, last = 0;
  int samples = 0;
  while (due - begin < (int64_t)(1e9 * DURATION)) {
    ethd_sense sense = {.time_ns = 0};
    int64_t now = ethd__clock_now();
    if (ethd_device_read(device, now, &sense) == ETHD_OK && sense.time_ns != last) {
      if (samples++) most = fmax(most, 1e-9 * (double)(sense.time_ns - last));
      last = sense.time_ns;
    }
    due += (int64_t)(1e9 * period);
    int64_t left = due - ethd__clock_now();
    if (left > 0) nanosleep(&(struct timespec){left / 1000000000, left % 1000000000}, NULL);
  }
  return samples < SAMPLES ? NAN : most;
}

static double measure(const ethd_setup *setup, ethd_device *device) {
  pthread_t threads[ETHD_UNITS_MAX];
  io units[ETHD_UNITS_MAX];
  atomic_bool ends = false;
  uint32_t n = ethd_device_units(device), begun = 0;
  for (; begun < n; begun++) {
    units[begun] = (io){device, begun, &ends};
    if (pthread_create(&threads[begun], NULL, serve, &units[begun])) break;
  }
  double spacing = begun == n ? watch(device, setup->period) : NAN;
  atomic_store(&ends, true);
  for (uint32_t i = 0; i < begun; i++) pthread_join(threads[i], NULL);
  return spacing;
}

void ethd__find_delay(const ethd_setup *setup, ethd_device *device, bool is_open, ethd__figures *figures) {
  double spacing = is_open ? measure(setup, device) : NAN, gap = setup->limits.gap;
  if (!isnan(spacing)) {
    figures->loop.delay = spacing;
    snprintf(figures->delay_is, sizeof figures->delay_is,
             "unknown, taken as the longest spacing of samples in %g s, measured now (--delay gives it)", DURATION);
    return;
  }
  figures->loop.delay = fmax(isfinite(gap) ? gap : ethd_limits_device().gap, setup->period);
  snprintf(figures->delay_is, sizeof figures->delay_is,
           "unknown, taken as the longest spacing that %s allows (%s--delay gives it)",
           isfinite(gap) ? "limits.gap" : "a device without limits.gap", is_open ? "" : "--open measures it, ");
}
