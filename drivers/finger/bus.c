#include "finger/bus.h"

#include <math.h>
#include <stdlib.h>

#include "clock.h"
#include "finger/limits.h"
#include "text/error_text.h"
#include "text/text.h"

#define WAIT_MS 20 /* wait for bytes of one call of service */
#define ROOM 4096  /* bytes of one read */
#define FRAMES 3   /* good frames that show that the line is the right one */

/* ---- I/O ---- */

static void receive(ethd__finger_bus *b, const ethd__ring_frame *frame, int64_t arrival_ns) {
  ethd__sighting *s = &b->inbox.newest;
  int64_t t_ns;
  ethd__clock_verdict verdict = ethd__board_clock_step(&b->clock, frame, arrival_ns, &t_ns);
  s->jumps += verdict == ETHD__CLOCK_DOUBTFUL || verdict == ETHD__CLOCK_JUMPED;
  s->lost += frame->lost;
  if (verdict == ETHD__CLOCK_DOUBTFUL) return;
  bool good = b->means(b->sensor, frame->counts, s);
  ethd__inbox_judge(&b->inbox, good);
  if (!good) return;
  s->have = ETHD_HAVE_CENTRE;
  ethd__inbox_stamp(&b->inbox, t_ns, arrival_ns);
}

static void take(ethd__finger_bus *b, const uint8_t *bytes, size_t count, int64_t arrival_ns) {
  const uint8_t *at = bytes;
  ethd__ring_frame frame;
  uint64_t corrupt = b->decoder.counters.corrupt;
  while (ethd__decoder_next(&b->decoder, &at, bytes + count, &frame)) receive(b, &frame, arrival_ns);
  b->inbox.newest.lost += b->decoder.counters.corrupt != corrupt; /* before the sequence shows the gap */
  ethd__inbox_put(&b->inbox);
}

/* Begins anew with the next frame, because earlier bytes are lost. */
static void restart(ethd__finger_bus *b) {
  ethd__decoder_restart(&b->decoder);
  ethd__board_clock_restart(&b->clock);
}

static ethd_status reopen(ethd__finger_bus *b, int64_t now_ns) {
  char message[ETHD_MESSAGE_MAX];
  if (now_ns < b->port.attempt_ns) return ETHD_STATUS_STALE;
  ethd_status status = ethd__ring_port_open(&b->port, now_ns, message);
  if (!status) restart(b);
  return status;
}

/* On a virtual clock it doesn't wait, and available bytes count as arrived now. */
ethd_status ethd__finger_bus_service(void *device, uint32_t unit, int64_t now_ns) {
  ethd__finger_bus *b = device;
  uint8_t bytes[ROOM];
  (void)unit;
  if (b->port.fd < 0) {
    ethd_status status = reopen(b, now_ns);
    if (status) return status;
  }
  if (ethd__ring_port_was_deaf(&b->port, now_ns)) restart(b);
  int64_t got = ethd__ring_port_read(&b->port, b->is_virtual ? 0 : WAIT_MS, bytes, sizeof bytes);
  if (got <= 0) return got < 0 ? ETHD_E_DEVICE : ETHD_OK;
  pthread_mutex_lock(&b->inbox.lock);
  take(b, bytes, (size_t)got, b->is_virtual ? now_ns : ethd__clock_now());
  pthread_mutex_unlock(&b->inbox.lock);
  return ETHD_OK;
}

/* ---- [main] ---- */

static ethd_status listen_first(ethd__finger_bus *b, char *message) {
  ethd__decoder d = {0};
  uint8_t bytes[ROOM];
  uint64_t all = 0;
  int64_t end = ethd__clock_now() + (int64_t)(1e9 * b->patience);
  while (d.counters.frames < FRAMES && ethd__clock_now() < end) {
    int64_t got = ethd__ring_port_read(&b->port, WAIT_MS, bytes, sizeof bytes);
    if (got < 0) return ethd__say(message, ETHD_E_DEVICE, "%s: the line is gone", b->port.path);
    const uint8_t *at = bytes;
    ethd__ring_frame frame;
    while (ethd__decoder_next(&d, &at, bytes + got, &frame)) continue;
    all += (uint64_t)got;
  }
  if (d.counters.frames >= FRAMES) return ETHD_OK;
  return ethd__say(
      message, ETHD_E_DEVICE,
      "%s: %llu bytes but %llu frames in %g s: is the sensor connected and powered, and is its baud rate %u?",
      b->port.path, (unsigned long long)all, (unsigned long long)d.counters.frames, b->patience, b->port.baud);
}

ethd_status ethd__finger_bus_prepare(ethd__finger_bus *b, const ethd_device_def *def, const char *port, const double *p,
                                     char message[ETHD_MESSAGE_MAX]) {
  b->is_virtual = def->is_virtual;
  b->clock.delay = p[ETHD__BUS_DELAY];
  b->port =
      (ethd__ring_port){.path = ethd__path_join(def->folder, port), .baud = (uint32_t)p[ETHD__BUS_BAUD], .fd = -1};
  b->patience = p[ETHD__BUS_PATIENCE];
  bool is_made = ethd__inbox_open(&b->inbox, ETHD__FRAME_RATE) == ETHD_OK && b->port.path;
  return is_made ? ETHD_OK : ethd__no_memory(message, NULL);
}

ethd_status ethd__finger_bus_open(ethd__finger_bus *b, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ethd__ring_port_open(&b->port, ethd__clock_now(), message);
  return status ? status : listen_first(b, message);
}

void ethd__finger_bus_close(void *device) {
  ethd__finger_bus *b = device;
  ethd__ring_port_close(&b->port);
  ethd__inbox_close(&b->inbox);
  free(b->port.path);
  free(b);
}

ethd_status ethd__finger_bus_read(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT {
  ethd__inbox_read(&((ethd__finger_bus *)device)->inbox, now_ns, out);
  return ETHD_OK;
}

uint32_t ethd__finger_bus_units(const void *device) { return (void)device, 1; }

uint32_t ethd__finger_bus_figures(const void *device, ethd_figure *out, uint32_t max) {
  return ethd__inbox_figures(&((ethd__finger_bus *)device)->inbox, out, max);
}

ethd_limits ethd__finger_bus_limits(const void *device) {
  const ethd__finger_bus *b = device;
  ethd_limits limits = ethd_limits_device();
  ethd__finger_limits(ETHD__FRAME_RATE, b->clock.delay, &limits);
  limits.gap = (double)INFINITY;
  return limits;
}
