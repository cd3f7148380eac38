#include "run/session.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "cli/cli.h"
#include "record/limits_event.h"
#include "run/refusal.h"
#include "run/telemetry.h"
#include "settings/config_parts.h"
#include "text/error_text.h"
#include "text/text.h"

#define HEARTBEAT 0.1 /* s */
#define PATIENCE 1000 /* waits of 1 ms, or ticks */
#define FIRST_FINGER 100

/* ---- time ---- */

/* Names the law that failed and says what it did. */
static void tell_law(const ethd__session *s, const ethd_event *e) {
  const ethd_law *laws[] = {&s->setup.tracking->law, &s->setup.contact->law, &s->setup.transition->law};
  static const char *const kinds[] = {"tracking", "contact", "transition"};
  int value = (int)e->value, kind = e->code == ETHD_FAULT_LAW ? value / 100 : value;
  ethd_status status = e->code == ETHD_FAULT_LAW ? (ethd_status) - (value % 100) : ETHD_E_NOT_FINITE;
  if ((e->code != ETHD_FAULT_LAW && e->code != ETHD_FAULT_FINITE) || kind < 0 || kind > ETHD_TRANSITION) return;
  fprintf(stderr, "%s: the %s law %s: %s\n", program_invocation_short_name, kinds[kind], laws[kind]->id,
          ethd_status_sentence(status));
}

void ethd__session_poll(ethd__session *s) {
  ethd_event event;
  while (ethd_control_poll(s->control, &event) == ETHD_OK)
    if (event.kind == ETHD_EVENT_TAKEN)
      s->posted = false;
    else if (event.kind == ETHD_EVENT_FAULT)
      tell_law(s, &event);
  if (s->loop) ethd_loop_beat(s->loop);
}

void ethd__session_tick(ethd__session *s) {
  ethd__config_foreign(s->config, "a plugin's law");
  ethd_loop_tick(s->loop);
  ethd__config_foreign(s->config, NULL);
  ethd__recorder_drain(&s->recorder);
  ethd__session_poll(s);
}

static void pass(ethd__session *s) {
  struct timespec t = {.tv_nsec = 1000000};
  if (s->is_virtual) {
    ethd__session_tick(s);
  } else {
    nanosleep(&t, NULL);
    ethd__session_poll(s);
  }
}

double ethd__session_time(const ethd__session *s) { return (double)ethd_loop_periods(s->loop) * s->setup.period; }

bool ethd__session_lives(const ethd__session *s) {
  return !ethd_loop_ended(s->loop) && !ethd_loop_hangs(s->loop, NULL);
}

/* Waits until `posted` setups are taken. */
static bool settle(ethd__session *s) {
  for (int i = 0; s->posted && i < PATIENCE && ethd__session_lives(s); i++) pass(s);
  return !s->posted;
}

static void await_tick(ethd__session *s) {
  uint64_t before = ethd_loop_periods(s->loop);
  for (int i = 0; ethd_loop_periods(s->loop) == before && i < PATIENCE && ethd__session_lives(s); i++) pass(s);
}

/* ---- opening ---- */

static ethd_status open_device(ethd__session *s, const char *folder, char *message) {
  ethd_error error = {0};
  const ethd_device_def def = {&s->config->setup,        s->config->settings,
                               s->config->setting_count, folder ? folder : s->config->folder,
                               s->config->path,          s->is_virtual};
  ethd_status status = ethd_device_open(s->config->device, NULL, &def, &s->driver, &s->device, message);
  if (status) return status;
  const ethd_limits limits = s->driver->limits(s->device);
  s->setup = s->config->setup;
  s->setup.limits = ethd_limits_narrower(&limits, &s->config->setup.limits);
  const ethd_dynamics dynamics = s->driver->dynamics(s->device);
  s->setup.dynamics = ethd_dynamics_known(&dynamics, &s->config->setup.dynamics);
  status = ethd_control_create(&s->setup, &s->control, &error);
  if (status) ethd_error_text(s->config->path, &error, message);
  return status;
}

/* The snapshot goes into the recording's folder unless another path is given. */
static ethd_status open_snapshot(ethd__session *s, const ethd__session_options *o, char *message) {
  char *path = o->snapshot ? strdup(o->snapshot) : ethd__path_join(o->record, "snapshot.npy");
  ethd_status status = path ? ethd__snapshot_open(&s->recorder.snapshot, path, s->setup.period) : ETHD_E_MEMORY;
  free(path);
  return status ? ethd__say(message, status, "--snapshot: %s", ethd_status_sentence(status)) : ETHD_OK;
}

static ethd_status open_recorder(ethd__session *s, const ethd__session_options *o, char *message) {
  ethd__recorder *r = &s->recorder;
  ethd_status status = ETHD_OK;
  r->telemetry = -1;
  r->keeps = o->keeps;
  if (o->telemetry) status = ethd__telemetry_open(o->telemetry, o->group, &r->telemetry, message);
  if (!status && (o->snapshot || o->record)) status = open_snapshot(s, o, message);
  if (status || !o->record) return status;
  status = ethd_recording_create(o->record, s->config, o->replace, &r->recording, message);
  if (status) return status;
  status = ethd__limits_event(r->recording, &s->config->setup, &s->setup);
  if (!status) status = ethd__dynamics_event(r->recording, &s->config->setup, &s->setup);
  if (!status && r->keeps > 1) status = ethd__recorder_thinned(r);
  return status ? ethd__say(message, status, "%s: %s", o->record, ethd_status_sentence(status)) : ETHD_OK;
}

static ethd_status refuse_device(const ethd__session *s, ethd_status status, char *message) {
  const char *why = s->driver->why(s->device);
  return ethd__say(message, status, "device %s: start: %.*s", s->config->device, ETHD_MESSAGE_MAX / 2,
                   why[0] ? why : ethd_status_sentence(status));
}

static ethd_status open_loop(ethd__session *s, const ethd__session_options *o, char *message) {
  ethd_loop_def def = o->loop;
  ethd_error error = {0};
  def.driver = s->driver;
  def.device = s->device;
  def.control = s->control;
  def.period = s->setup.period;
  def.gap = s->setup.limits.gap;
  if (def.gap < (double)INFINITY) def.heartbeat = HEARTBEAT;
  def.clock = o->is_virtual ? &s->clock : NULL;
  ethd_status status = ethd_loop_create(&def, &s->loop, &error);
  if (status) {
    ethd_error_text("the loop", &error, message);
    return status;
  }
  s->recorder.loop = s->loop;
  ethd__recorder_begin(&s->recorder, def.period);
  if (o->home) status = s->driver->home(s->device, NULL);
  if (!status) status = s->driver->start(s->device);
  if (status) return refuse_device(s, status, message);
  s->started = true;
  status = ethd_loop_start(s->loop, &error);
  if (status) return ethd__start_refused(s->loop, status, &error, message);
  if (!o->is_virtual) status = ethd__recorder_start(&s->recorder);
  return status ? ethd__say(message, status, "the recorder: %s", ethd_status_sentence(status)) : ETHD_OK;
}

ethd_status ethd__session_open(const ethd__session_options *o, ethd__session *s, char message[ETHD_MESSAGE_MAX]) {
  char left[ETHD_MESSAGE_MAX];
  memset(s, 0, sizeof *s);
  s->recorder.telemetry = -1;
  s->recorder.sink = o->sink;
  s->is_virtual = o->is_virtual;
  ethd_status status = o->text ? ethd_config_parse(o->text, strlen(o->text), o->config ? o->config : "the defaults",
                                                   o->folder, &s->config, message)
                               : ethd_config_load(o->config, &s->config, message);
  if (!status) status = open_device(s, o->folder, message);
  if (!status) status = open_recorder(s, o, message);
  if (!status) status = open_loop(s, o, message);
  if (status) {
    (void)!ethd__session_end(s, left);
    ethd__session_free(s);
    return status;
  }
  await_tick(s);
  return ETHD_OK;
}

bool ethd__session_sees_finger(ethd__session *s) {
  for (int i = 0; i < FIRST_FINGER && !s->is_virtual && !atomic_load(&s->recorder.sees_finger); i++) pass(s);
  return atomic_load(&s->recorder.sees_finger);
}

/* ---- while it runs ---- */

ethd_status ethd__session_post(ethd__session *s, const ethd_setup *setup, const char *kind, const char *detail,
                               char message[ETHD_MESSAGE_MAX]) {
  ethd_error error = {0};
  if (!settle(s)) return ethd__say(message, ETHD_BUSY, "%s", ethd_status_sentence(ETHD_BUSY));
  if (!ethd__recorder_expect(&s->recorder, kind, detail))
    return ethd__say(message, ETHD_E_FULL, "%s", ethd_status_sentence(ETHD_E_FULL));
  ethd__config_foreign(s->config, "the check of a plugin's law");
  ethd_status status = ethd_control_post(s->control, setup, &error);
  ethd__config_foreign(s->config, NULL);
  if (status) {
    ethd__recorder_withdraw(&s->recorder);
    ethd_error_text(NULL, &error, message);
    return status;
  }
  s->setup = *setup;
  s->posted = true;
  if (s->is_virtual || settle(s)) return ETHD_OK;
  return ethd__say(message, ETHD_BUSY, "%s", ethd_status_sentence(ETHD_BUSY));
}

ethd_status ethd__session_enable(ethd__session *s) {
  if (!settle(s)) return ETHD_BUSY;
  if (ethd_loop_armed(s->loop)) {
    ethd_loop_disarm(s->loop);
    await_tick(s);
  }
  ethd_status status = ethd_loop_enable(s->loop);
  if (!status) await_tick(s);
  return status;
}

/* Stops by a speed limit of 0: the guard damps the ring and lets go when it stands. */
void ethd__session_halt(ethd__session *s, bool told) {
  char message[ETHD_MESSAGE_MAX];
  ethd_setup setup = s->setup;
  atomic_store(&s->recorder.stopping, 1);
  if (told) {
    ethd_loop_raise(s->loop, ETHD_FAULT_APPLICATION);
    await_tick(s);
  }
  setup.limits.speed = 0;
  if (ethd_loop_armed(s->loop) && !ethd__session_post(s, &setup, "set", "limits.speed 0", message))
    for (int i = 0; ethd_loop_armed(s->loop) && i < PATIENCE && ethd__session_lives(s); i++) pass(s);
  ethd_loop_disarm(s->loop);
  await_tick(s);
}

/* ---- ending ---- */

static ethd_status close_recording(ethd__session *s, char *message) {
  ethd__recorder *r = &s->recorder;
  uint64_t kept = r->recording ? ethd_recording_kept(r->recording) : 0;
  ethd_status status = ethd_recording_close(r->recording, message);
  r->kept = status ? kept : r->written;
  r->recording = NULL;
  if (r->telemetry >= 0) close(r->telemetry);
  r->telemetry = -1;
  return status;
}

/* Says why the session failed, in the recording too. */
static void tell_hang(ethd__session *s, ethd_status status, char *message) {
  const ethd_law *law;
  (void)ethd_loop_hangs(s->loop, &law);
  if (law)
    (void)ethd__say(message, status, "the law %s doesn't return; its step hangs, and the device was let go", law->id);
  else
    (void)ethd__say(message, status, "the device %s doesn't return; the loop hangs in its code", s->config->device);
  if (s->recorder.recording) (void)!ethd_recording_event(s->recorder.recording, "fault", message);
}

static ethd_status end_loop(ethd__session *s, char *message) {
  ethd_loop_stop(s->loop);
  ethd_status status = ethd_loop_join(s->loop);
  ethd__recorder_end(&s->recorder);
  s->left = status && !ethd_loop_ended(s->loop);
  s->lost = s->left && status != ETHD_E_LAW; /* no second thread enters a device in which one hangs */
  if (s->left)
    tell_hang(s, status, message);
  else if (status)
    (void)ethd__say(message, status, "the clock failed; the loop ended by itself");
  return status;
}

ethd_status ethd__session_end(ethd__session *s, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = s->loop ? end_loop(s, message) : ETHD_OK;
  ethd_status stopped = s->started && !s->lost ? s->driver->stop(s->device) : ETHD_OK;
  if (stopped < 0 && !status)
    status = ethd__say(message, stopped, "device %s: stop: %s", s->config->device, ethd_status_sentence(stopped));
  s->started = false;
  char lost[ETHD_MESSAGE_MAX];
  ethd_status closed = close_recording(s, lost);
  if (closed && !status) status = ethd__say(message, closed, "%s", lost);
  const char *snapshot = s->recorder.snapshot.message;
  return *snapshot && !status ? ethd__say(message, ETHD_E_FILE, "the snapshot: %s", snapshot) : status;
}

void ethd__session_free(ethd__session *s) {
  ethd__snapshot_close(&s->recorder.snapshot);
  if (s->left) return;
  ethd_loop_destroy(s->loop);
  if (s->device) s->driver->close(s->device);
  ethd_control_destroy(s->control);
  if (s->config) ethd_config_free(s->config);
}
