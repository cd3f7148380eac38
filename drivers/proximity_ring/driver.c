/* The proximity ring as a device: it measures the finger, beside a driver that moves.

     I/O thread   port -> receiver -> cell          [rt]   cell -> rays, sample_ns, rows 15, 18, 20      */
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ethd/cell.h"
#include "ethd/fault.h"
#include "no_joints.h"
#include "proximity_ring/empty.h"
#include "proximity_ring/port.h"
#include "proximity_ring/receiver.h"
#include "proximity_ring/settings.h"
#include "text/error_text.h"
#include "text/text.h"

#define GAP_NS (1500000000 / ETHD__FRAME_RATE) /* without a frame means that at least one is lost */

/* The I/O thread's data for the control thread. */
typedef struct sample {
  ethd__ring_reading reading;
  ethd__receiver_counts counts;
  int64_t arrival_ns; /* of the reading */
} sample;

typedef struct ring {
  ethd__ring_settings settings;
  bool is_virtual;      /* whether the clock is virtual */
  pthread_mutex_t lock; /* of the I/O thread's part, which figures read */
  ethd_cell *cell;

  /* I/O thread, and open */
  ethd__ring_port port;
  ethd__receiver receiver;
  sample newest;
  char drifted[224]; /* what remark says of a drift */

  /* [rt] */
  sample taken;
  ethd__receiver_counts seen;
} ring;

/* ---- I/O ---- */

static void take(void *device, const uint8_t *bytes, size_t count, int64_t arrival_ns) {
  ring *r = device;
  const uint8_t *at = bytes;
  ethd__ring_reading reading;
  while (ethd__receiver_next(&r->receiver, &at, bytes + count, arrival_ns, &reading)) {
    r->newest.reading = reading;
    r->newest.arrival_ns = arrival_ns;
  }
  r->newest.counts = r->receiver.counts;
  ethd_cell_put(r->cell, &r->newest);
}

static void restart(void *device) { ethd__receiver_restart(&((ring *)device)->receiver); }

static ethd_status service(void *device, uint32_t unit, int64_t now_ns) {
  ring *r = device;
  (void)unit;
  return ethd__ring_port_service(&r->port, &(ethd__ring_listener){r, &r->lock, r->is_virtual, take, restart}, now_ns);
}

/* ---- [rt] ---- */

static int64_t lasting(const sample *s, int64_t now_ns, int64_t *grave) {
  int64_t rows = 0;
  uint32_t out = 0;
  if (s->counts.readings == 0) return 0;
  if (now_ns - s->arrival_ns > GAP_NS) rows |= ETHD_FAULT_BIT(ETHD_FAULT_FRAME_LOST);
  for (uint32_t mask = s->reading.out; mask; mask &= mask - 1) out++;
  if (out || s->reading.has_drift) rows |= ETHD_FAULT_BIT(ETHD_FAULT_SENSOR);
  if (ETHD_RAYS - out < ETHD__GOOD_LEAST) *grave |= ETHD_FAULT_BIT(ETHD_FAULT_SENSOR);
  return rows;
}

static ethd_status ring_read(void *device, int64_t now_ns, ethd_sense *out) ETHD_RT {
  ring *r = device;
  const sample *s = &r->taken;
  (void)!ethd_cell_take(r->cell, &r->taken);
  if (s->counts.frame_lost != r->seen.frame_lost) out->faults |= ETHD_FAULT_BIT(ETHD_FAULT_FRAME_LOST);
  if (s->counts.board_clock != r->seen.board_clock) out->faults |= ETHD_FAULT_BIT(ETHD_FAULT_BOARD_CLOCK);
  out->faults |= lasting(s, now_ns, &out->grave);
  uint64_t read = r->seen.readings;
  if (s->counts.readings != read && s->reading.sample_ns <= now_ns) { /* else it waits: late ticks meet younger ones */
    out->have |= ETHD_HAVE_RAYS;
    out->sample_ns = s->reading.sample_ns;
    memcpy(out->rays, s->reading.rays, sizeof out->rays);
    read = s->counts.readings;
  }
  r->seen = s->counts;
  r->seen.readings = read;
  return ETHD_OK;
}

/* ---- [main] ---- */

static void ring_close(void *device) {
  ring *r = device;
  if (!r) return;
  ethd__ring_port_close(&r->port);
  ethd_cell_destroy(r->cell);
  pthread_mutex_destroy(&r->lock);
  free(r->port.path);
  free(r);
}

static ethd_status load_calibration(const ethd_device_def *def, ring *r, char *message) {
  const ethd_setting *s = r->settings.calibration;
  r->receiver.calibration = ethd__calibration_default();
  if (!s) return ETHD_OK;
  ETHD__FREED char *path = ethd__path_join(def->folder, s->value);
  if (!path) return ethd__no_memory(message, NULL);
  return ethd__calibration_load(path, &r->receiver.calibration, message);
}

static ethd_status prepare(const ethd_device_def *def, ring *r, char *message) {
  const double *p = r->settings.p;
  ethd_error error = {0};
  ethd_status status = load_calibration(def, r, message);
  if (status) return status;
  r->receiver.clock.delay = p[ETHD__RING_DELAY];
  status = ethd__plausible_prepare(def->setup->ring_radius, def->setup->finger_radius, p[ETHD__RING_GATE],
                                   p[ETHD__RING_SPEED], p[ETHD__RING_SLACK], &r->receiver.plausible, &error);
  if (!status)
    status = ethd__drift_prepare(def->setup->ring_radius, def->setup->finger_radius, &r->receiver.drift, &error);
  if (status) ethd_error_text(def->file, &error, message);
  r->port = (ethd__ring_port){
      .path = ethd__path_join(def->folder, r->settings.port->value), .baud = (uint32_t)p[ETHD__RING_BAUD], .fd = -1};
  if (!status && (!r->port.path || ethd_cell_create(sizeof(sample), &r->cell, NULL)))
    status = ethd__no_memory(message, NULL);
  return status;
}

static void add(void *empty, const ethd__ring_frame *frame) { ethd__empty_add(empty, frame); }

static ethd_status check_darks(const ring *r, char *message) {
  for (int k = 0; k < ETHD_RAYS; k++)
    if (isnan(r->receiver.calibration.sensors[k].dark))
      return ethd__say(message, ETHD_E_ARGUMENT,
                       "device.empty = trust: the calibration has no dark of sensor %d; empty = check measures it", k);
  return ETHD_OK;
}

static ethd_status listen_to(ring *r, double ring_radius, char *message) {
  char what[ETHD_MESSAGE_MAX];
  ethd__empty empty = {0};
  ethd_status status =
      ethd__ring_port_listen(&r->port, r->settings.p[ETHD__RING_PATIENCE], ETHD__EMPTY_FRAMES, add, &empty, message);
  if (status) return status;
  if (r->settings.p[ETHD__RING_EMPTY] == 1) return check_darks(r, message);
  status = ethd__empty_check(&empty, ring_radius, &r->receiver.calibration, what);
  return status ? ethd__say(message, status, "%s: %.*s", r->port.path, ETHD_MESSAGE_MAX / 2, what) : ETHD_OK;
}

static ethd_status ring_prepare(const ethd_device_def *def, void **out, char message[ETHD_MESSAGE_MAX]) {
  ethd__ring_settings settings;
  *out = NULL;
  ethd_status status = ethd__ring_settings_read(def, &settings, message);
  if (status) return status;
  ring *r = *out = calloc(1, sizeof *r);
  if (!r) return ETHD_E_MEMORY;
  r->settings = settings;
  r->is_virtual = def->is_virtual;
  r->port.fd = -1;
  pthread_mutex_init(&r->lock, NULL);
  return prepare(def, r, message);
}

static ethd_status ring_open(const ethd_device_def *def, void **out, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = ring_prepare(def, out, message);
  return status ? status : listen_to(*out, def->setup->ring_radius, message);
}

static uint32_t units(const void *device) {
  (void)device;
  return 1;
}

static ethd_limits limits(const void *device) {
  (void)device;
  ethd_limits limits = ethd_limits_device();
  limits.gap = (double)INFINITY; /* it takes no samples of the joints */
  return limits;
}

static uint32_t figures(const void *device, ethd_figure *out, uint32_t max) {
  ring *r = (ring *)device;
  pthread_mutex_lock(&r->lock);
  const ethd__receiver *in = &r->receiver;
  const ethd_figure all[] = {
      {"ring frames", "1", (double)in->decoder.counters.frames},
      {"ring frames corrupt", "1", (double)in->decoder.counters.corrupt},
      {"ring frames lost", "1", (double)in->decoder.counters.lost},
      {"ring frames implausible", "1", (double)in->plausible.bad},
      {"ring rays left out", "1", (double)in->plausible.suspects},
      {"ring drift", "m", in->drift.offset},
      {"ring clock jumps", "1", (double)in->clock.jumps},
      {"ring clock drift", "1", in->clock.drift},
      {"ring port opened", "1", (double)r->port.opened},
      {"ring reading age", "s", r->settings.p[ETHD__RING_DELAY]},
  };
  pthread_mutex_unlock(&r->lock);
  uint32_t n = sizeof all / sizeof *all;
  if (n > max) n = max;
  memcpy(out, all, n * sizeof *all);
  return n;
}

static const char *remark(const void *device, uint32_t i) {
  ring *r = (ring *)device;
  pthread_mutex_lock(&r->lock);
  bool at_once = r->port.low_latency || r->port.fd < 0;
  const ethd__drift drift = r->receiver.drift;
  if (drift.is_off)
    snprintf(r->drifted, sizeof r->drifted,
             "the ring's sensors have drifted together: they show the finger's radius about %.1f mm too %s; open the "
             "empty ring again, or calibrate it (step 6)",
             1e3 * fabs(drift.offset), drift.offset > 0 ? "large" : "small");
  pthread_mutex_unlock(&r->lock);
  const char *said[4] = {NULL};
  uint32_t n = 0;
  if (!at_once) said[n++] = "the ring's port has no low-latency mode: its bytes may arrive up to 16 ms late (step 1)";
  if (r->receiver.calibration.level == ETHD__LEVEL_NONE)
    said[n++] = "the ring isn't calibrated: distances are a typical sensor's, half a millimetre off (step 6)";
  if (drift.is_off) said[n++] = r->drifted;
  return i < n ? said[i] : NULL;
}

const ethd_driver ethd_driver_ring = {
    .size = sizeof(ethd_driver),
    .abi = ETHD_DRIVER_ABI,
    .id = "ring",
    .brief = "proximity ring on a serial port, beside a driver that moves",
    .params = ethd__ring_params,
    .param_count = ETHD__RING_PARAMS,
    .keys = ethd__ring_keys,
    .open = ring_open,
    .read = ring_read,
    .units = units,
    .service = service,
    .close = ring_close,
    .limits = limits,
    .figures = figures,
    .remark = remark,
    .joints = ethd__no_joints,
    .prepare = ring_prepare,
};
