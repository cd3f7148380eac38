/* The servo as a device: opened, started and stopped by [main]. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "servo/device.h"
#include "servo/words.h"
#include "text/error_text.h"
#include "text/text.h"

#define START_MOST 10.0 /* s beyond the steps' own times */
#define ZEROES 3        /* good exchanges with zero torque before anything is enabled */
#define PAUSE 200000    /* ns between the turns of a start */

enum { Q1, Q2, JOINT, SPEED, PARAMS };

static const ethd_param params[PARAMS] = {
    [Q1] = {"q1", "rad", -100, 100, 0, "joint 1 when the device is opened; without: as its register says"},
    [Q2] = {"q2", "rad", -100, 100, 0, "joint 2, likewise"},
    [JOINT] = {"joint", "1", 1, 2, 1, "of a map with one axis: which joint that is"},
    [SPEED] = {"speed", "m/s", 0.01, 10, 1.2, "of the ring: faster is row 24 of the fault table"},
};

static const char *const keys[] = {"map", "port", NULL};

typedef struct settings {
  const ethd_setting *map, *port;
  double p[PARAMS]; /* NAN: not given */
} settings;

/* ---- settings ---- */

static const char *file(const ethd_device_def *def) { return def->file ? def->file : "the defaults"; }

static ethd_status read_settings(const ethd_device_def *def, settings *out, char *message) {
  const ethd_setting *texts[2] = {NULL, NULL};
  *out = (settings){.p = {NAN, NAN, NAN, params[SPEED].def}};
  ethd_status status = ethd_settings_read(&ethd_driver_servo, def, out->p, texts, message);
  out->map = texts[0];
  out->port = texts[1];
  if (!status && !out->map)
    status =
        ethd__say(message, ETHD_E_ARGUMENT, "%s: device.map is missing: a servo needs its register map", file(def));
  if (!status && !isnan(out->p[JOINT]) && out->p[JOINT] != rint(out->p[JOINT]))
    status =
        ethd__say(message, ETHD_E_RANGE, "%s: device.joint: found %g, 1 and 2 are allowed", file(def), out->p[JOINT]);
  return status;
}

static ethd_status load_map(const ethd_device_def *def, const settings *s, ethd__servo_map *map, char *message) {
  char *path = ethd__path_join(def->folder, s->map->value);
  if (!path) return ethd__say(message, ETHD_E_MEMORY, "%s", ethd_status_sentence(ETHD_E_MEMORY));
  ethd_status status = ethd__servo_map_load(path, s->map->value, map, message);
  free(path);
  if (status || !s->port) return status;
  if (strlen(s->port->value) >= sizeof map->port)
    return ethd__say(message, ETHD_E_RANGE, "%s:%d: device.port: too long", file(def), s->port->line);
  strcpy(map->port, s->port->value);
  return ETHD_OK;
}

/* ---- opening ---- */

static ethd_status place_axes(ethd__servo_device *d, const ethd_device_def *def, const settings *s, char *message) {
  int both = 1;
  for (int i = 0; i < 2; i++) {
    d->joint[i] = d->map.roles[ETHD__SERVO_TORQUE1 + i] >= 0 ? i : -1;
    both &= d->joint[i] >= 0;
    d->feedback.home[i] = NAN;
  }
  int given = !isnan(s->p[JOINT]);
  if (both && given) return ethd__say(message, ETHD_E_ARGUMENT, "%s: device.joint: the map has both joints", file(def));
  for (int i = 0; i < 2; i++) {
    if (d->joint[i] < 0) continue;
    if (!both && given) d->joint[i] = (int32_t)s->p[JOINT] - 1;
    d->feedback.home[i] = s->p[d->joint[i] ? Q2 : Q1];
  }
  return ETHD_OK;
}

static void close_device(void *device) {
  ethd__servo_device *d = device;
  if (!d) return;
  ethd__servo_link_close(&d->link);
  ethd_cell_destroy(d->commands);
  ethd_cell_destroy(d->samples);
  pthread_mutex_destroy(&d->lock);
  free(d);
}

static int64_t monotonic(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

/* A first exchange or more, until the drive has identified itself. */
static ethd_status identify(ethd__servo_device *d, double seconds) {
  const double zero[2] = {0, 0};
  const struct timespec pause = {.tv_nsec = PAUSE};
  for (int64_t begin = monotonic(), now = begin; 1e-9 * (double)(now - begin) < seconds; now = monotonic()) {
    if (d->link.state == ETHD__SERVO_UP && d->link.sequence < 0)
      ethd__servo_link_begin(&d->link, ETHD__SERVO_IDENTIFY, now);
    (void)!ethd__servo_turn(d, now, zero);
    if (d->link.state >= ETHD__SERVO_IDENTIFIED) return ETHD_OK;
    nanosleep(&pause, NULL);
  }
  return ETHD_E_DEVICE;
}

static double steps_time(const ethd__servo_map *map, int sequence) {
  double sum = map->connect;
  for (uint32_t i = 0; i < map->sequences[sequence].count; i++)
    if (map->sequences[sequence].at[i].kind != ETHD__SERVO_STEP_WRITE) sum += map->sequences[sequence].at[i].value;
  return sum;
}

static ethd_status servo_open(const ethd_device_def *def, void **out, char message[ETHD_MESSAGE_MAX]) {
  settings s;
  *out = NULL;
  ethd_status status = read_settings(def, &s, message);
  if (status) return status;
  ethd__servo_device *d = *out = calloc(1, sizeof *d);
  if (!d) return ETHD_E_MEMORY;
  d->link.bus.fd = -1;
  pthread_mutex_init(&d->lock, NULL);
  atomic_init(&d->safe, 1);
  status = load_map(def, &s, &d->map, message);
  if (!status) status = place_axes(d, def, &s, message);
  if (!status && (ethd_cell_create(sizeof d->command, &d->commands, NULL) ||
                  ethd_cell_create(sizeof d->newest, &d->samples, NULL)))
    status = ethd__say(message, ETHD_E_MEMORY, "%s", ethd_status_sentence(ETHD_E_MEMORY));
  if (!status) {
    d->speed = s.p[SPEED];
    d->period_ns = (int64_t)rint(1e9 * def->setup->period);
    d->exchange_ns = d->period_ns * d->map.divisor;
    ethd__servo_link_make(&d->map, &d->link);
    uint32_t unconfirmed = ethd__servo_unconfirmed(&d->map);
    if (unconfirmed)
      snprintf(d->unconfirmed, sizeof d->unconfirmed,
               "%u of %u registers are unconfirmed: check their addresses in the drive's manual", unconfirmed,
               d->map.count);
    ethd_error error;
    status = ethd__servo_feedback_make(&d->feedback, &d->map, def->setup->limits.torque, 1e-9 * (double)d->exchange_ns,
                                       &error);
    if (status) ethd_error_text(s.map->value, &error, d->link.message);
    if (!status) status = ethd__servo_link_connect(&d->link, monotonic());
    if (!status) status = identify(d, steps_time(&d->map, ETHD__SERVO_IDENTIFY));
    if (status) ethd__say(message, status, "%s: %.*s", s.map->value, ETHD_MESSAGE_MAX / 2, d->link.message);
  }
  return status;
}

/* ---- start: zero first, seen by the drive, then the steps ---- */

static ethd_status zero_and_verify(ethd__servo_device *d, double seconds) {
  const double zero[2] = {0, 0};
  const struct timespec pause = {.tv_nsec = PAUSE};
  int good = 0;
  for (int64_t begin = monotonic(), now = begin; good < ZEROES; now = monotonic()) {
    if (1e-9 * (double)(now - begin) > seconds || d->link.state < ETHD__SERVO_IDENTIFIED) return ETHD_E_DEVICE;
    good = ethd__servo_turn(d, now, zero) ? 0 : good + 1;
    nanosleep(&pause, NULL);
  }
  return ETHD_OK;
}

/* The steps of a sequence, one a turn, under zero torque. */
static ethd_status run(ethd__servo_device *d, int32_t sequence) {
  const double zero[2] = {0, 0};
  const struct timespec pause = {.tv_nsec = PAUSE};
  double most = steps_time(&d->map, sequence) + 1;
  int64_t begin = monotonic();
  ethd__servo_link_begin(&d->link, sequence, begin);
  for (int64_t now = begin; d->link.sequence == sequence; now = monotonic()) {
    if (1e-9 * (double)(now - begin) > most) return ETHD_E_DEVICE;
    (void)!ethd__servo_turn(d, now, zero);
    nanosleep(&pause, NULL);
  }
  return d->link.result;
}

static ethd_status start_locked(ethd__servo_device *d) {
  atomic_store(&d->safe, 1);
  atomic_fetch_add(&d->epoch, 1); /* commands from before count no more */
  d->link.attempt_ns = 0;
  d->link.set_point_stays = false;
  for (int i = 0; i < 2; i++) d->feedback.axes[i].since_ns = 0;
  ethd_status status = identify(d, START_MOST / 10 + steps_time(&d->map, ETHD__SERVO_IDENTIFY));
  if (status) return status;
  /* an old set-point must be gone, and be seen to be gone, before the drive moves anything */
  status = zero_and_verify(d, 0.5);
  d->link.set_point_stays = status && d->link.echo_failed;
  if (d->link.set_point_stays) d->link.rows[ETHD_FAULT_SET_POINT]++;
  if (!status) status = run(d, ETHD__SERVO_ENABLE);
  if (status) return status;
  atomic_store(&d->safe, 0);
  return ETHD_OK;
}

static ethd_status start(void *device) {
  ethd__servo_device *d = device;
  pthread_mutex_lock(&d->lock);
  ethd_status status = start_locked(d);
  pthread_mutex_unlock(&d->lock);
  return status ? ETHD_E_DEVICE : ETHD_OK;
}

/* Zero torque even where the drive doesn't answer to the steps. */
static ethd_status stop(void *device) {
  ethd__servo_device *d = device;
  pthread_mutex_lock(&d->lock);
  atomic_store(&d->safe, 1);
  ethd_status status = ETHD_OK;
  if (d->link.state >= ETHD__SERVO_UP) {
    d->link.state = d->link.state > ETHD__SERVO_IDENTIFIED ? ETHD__SERVO_IDENTIFIED : d->link.state;
    status = run(d, ETHD__SERVO_DISABLE);
  }
  pthread_mutex_unlock(&d->lock);
  return status ? ETHD_E_DEVICE : ETHD_OK;
}

/* ---- what it says of itself ---- */

static uint32_t units(const void *device) {
  (void)device;
  return 1;
}

static ethd_limits limits(const void *device) {
  const ethd__servo_device *d = device;
  ethd_limits limits = ethd_limits_device();
  limits.speed = d->speed;
  for (int i = 0; i < 2; i++) {
    int32_t r = d->map.roles[ETHD__SERVO_TORQUE1 + i];
    if (r >= 0) limits.torque = fmin(limits.torque, ethd__servo_most(&d->map.registers[r]));
  }
  return limits;
}

static double at(const ethd_histogram *h, double share) { return 1e-9 * (double)ethd_histogram_at(h, share); }

static uint32_t figures(const void *device, ethd_figure *out, uint32_t max) {
  const ethd__servo_device *d = device;
  const ethd__servo_counts *c = &d->link.counts;
  const ethd_figure all[] = {
      {"servo exchanges", "1", (double)c->exchanges},
      {"servo round trip p50", "s", at(&d->trip, 0.5)},
      {"servo round trip p99", "s", at(&d->trip, 0.99)},
      {"servo round trip max", "s", 1e-9 * (double)d->trip.max},
      {"servo feedback age p50", "s", at(&d->age, 0.5)},
      {"servo feedback age p99", "s", at(&d->age, 0.99)},
      {"servo feedback age max", "s", 1e-9 * (double)d->age.max},
      {"servo answers missing", "1", (double)c->missing},
      {"servo answers stale", "1", (double)c->stale},
      {"servo answers damaged or refused", "1", (double)(c->garbled + c->busy + c->refused + c->failed)},
      {"servo links lost", "1", (double)c->lost},
      {"servo links made", "1", (double)c->connects},
  };
  uint32_t n = sizeof all / sizeof *all;
  if (n > max) n = max;
  memcpy(out, all, n * sizeof *out);
  return n;
}

/* The registers that nobody confirms, then what the map leaves open. */
static const char *remark(const void *device, uint32_t i) {
  const ethd__servo_device *d = device;
  bool some = d->unconfirmed[0] != 0;
  return some && i == 0 ? d->unconfirmed : ethd__servo_risk(&d->map, i - some);
}

const ethd_driver ethd_driver_servo = {
    .size = sizeof(ethd_driver),
    .abi = ETHD_DRIVER_ABI,
    .id = "servo",
    .brief = "servo drive on a Modbus, by a register map",
    .params = params,
    .param_count = PARAMS,
    .keys = keys,
    .open = servo_open,
    .start = start,
    .read = ethd__servo_read,
    .write = ethd__servo_write,
    .units = units,
    .service = ethd__servo_service,
    .safe = ethd__servo_safe,
    .stop = stop,
    .close = close_device,
    .limits = limits,
    .figures = figures,
    .remark = remark,
};
