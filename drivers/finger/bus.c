#include "finger/bus.h"

#include <math.h>
#include <stdlib.h>

#include "finger/limits.h"
#include "text/error_text.h"
#include "text/text.h"

#define FRAMES 3 /* good frames that show that the line is the right one */

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

static void take(void *device, const uint8_t *bytes, size_t count, int64_t arrival_ns) {
  ethd__finger_bus *b = device;
  const uint8_t *at = bytes;
  ethd__ring_frame frame;
  uint64_t corrupt = b->decoder.counters.corrupt;
  while (ethd__decoder_next(&b->decoder, &at, bytes + count, &frame)) receive(b, &frame, arrival_ns);
  b->inbox.newest.lost += b->decoder.counters.corrupt != corrupt; /* before the sequence shows the gap */
  ethd__inbox_put(&b->inbox);
}

static void restart(void *device) {
  ethd__finger_bus *b = device;
  ethd__decoder_restart(&b->decoder);
  ethd__board_clock_restart(&b->clock);
}

ethd_status ethd__finger_bus_service(void *device, uint32_t unit, int64_t now_ns) {
  ethd__finger_bus *b = device;
  (void)unit;
  return ethd__ring_port_service(&b->port, &(ethd__ring_listener){b, &b->inbox.lock, b->is_virtual, take, restart},
                                 now_ns);
}

/* ---- [main] ---- */

static void ignore(void *bus, const ethd__ring_frame *frame) { (void)bus, (void)frame; }

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
  return ethd__ring_port_listen(&b->port, b->patience, FRAMES, ignore, b, message);
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
