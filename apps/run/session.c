#include "run/session.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "cli/cli.h"
#include "cli/law_fault.h"
#include "settings/config_parts.h"
#include "text/error_text.h"
#include "text/text.h"

#define PATIENCE 1000    /* waits of 1 ms, or ticks, until it gives up */
#define FIRST_FINGER 100 /* such waits for the finger's first reading */

/* ---- time ---- */

/* Prints the failed law and its failure. */
static void tell_law(const ethd__session *s, const ethd_event *event) {
  char text[ETHD_MESSAGE_MAX];
  const ethd_law *laws[ETHD_TRANSITION + 1];
  s->front->laws(&s->setup, laws);
  const ethd__law_fault fault = ethd__law_fault_of(laws, event);
  if (fault.law) fprintf(stderr, "%s: %s\n", program_invocation_short_name, ethd__law_fault_text(&fault, text));
}

void ethd__session_poll(ethd__session *s) {
  ethd_event event;
  while (s->controller->poll(s->control, &event) == ETHD_OK)
    if (event.kind == ETHD_EVENT_TAKEN)
      s->posted = false;
    else
      tell_law(s, &event);
  if (s->loop) ethd_loop_beat(s->loop);
  ethd__tell_refusal();
}

void ethd__session_tick(ethd__session *s) {
  ethd__config_foreign(s->config, "a plugin's law");
  ethd_loop_tick(s->loop);
  ethd__config_foreign(s->config, NULL);
  ethd__recorder_drain(&s->recorder);
  ethd__session_poll(s);
}

/* Lets a millisecond pass, or on a virtual clock a tick. */
static void pass(ethd__session *s) {
  struct timespec t = {.tv_nsec = 1000000};
  if (s->is_virtual) {
    ethd__session_tick(s);
  } else {
    nanosleep(&t, NULL);
    ethd__session_poll(s);
  }
}

double ethd__session_time(const ethd__session *s) { return (double)ethd_loop_periods(s->loop) * s->period; }

bool ethd__session_lives(const ethd__session *s) {
  return !ethd_loop_ended(s->loop) && !ethd_loop_hangs(s->loop, NULL);
}

/* Waits until `posted` setups are taken. */
static bool settle(ethd__session *s) {
  for (int i = 0; s->posted && i < PATIENCE && ethd__session_lives(s); i++) pass(s);
  return !s->posted;
}

void ethd__session_await_tick(ethd__session *s) {
  uint64_t before = ethd_loop_periods(s->loop);
  for (int i = 0; ethd_loop_periods(s->loop) == before && i < PATIENCE && ethd__session_lives(s); i++) pass(s);
}

bool ethd__session_sees_finger(ethd__session *s) {
  for (int i = 0; i < FIRST_FINGER && !s->is_virtual && !atomic_load(&s->recorder.sees_finger); i++) pass(s);
  return atomic_load(&s->recorder.sees_finger);
}

/* ---- while it runs ---- */

ethd_status ethd__session_post(ethd__session *s, const ethd__setup_copy *setup, const char *kind, const char *detail,
                               char message[ETHD_MESSAGE_MAX]) {
  ethd_error error = {0};
  if (!settle(s)) return ethd__say(message, ETHD_STATUS_BUSY, "%s", ethd_status_sentence(ETHD_STATUS_BUSY));
  if (!ethd__recorder_expect(&s->recorder, kind, detail))
    return ethd__say(message, ETHD_E_FULL, "%s", ethd_status_sentence(ETHD_E_FULL));
  ethd__config_foreign(s->config, "the check of a plugin's law");
  ethd_status status = s->controller->post(s->control, setup, &error);
  ethd__config_foreign(s->config, NULL);
  if (status) {
    ethd__recorder_withdraw(&s->recorder);
    ethd_error_text(NULL, &error, message);
    return status;
  }
  s->setup = *setup;
  s->posted = true;
  if (s->is_virtual || settle(s)) return ETHD_OK;
  return ethd__say(message, ETHD_STATUS_BUSY, "%s", ethd_status_sentence(ETHD_STATUS_BUSY));
}

ethd_status ethd__session_enable(ethd__session *s) {
  if (!settle(s)) return ETHD_STATUS_BUSY;
  if (ethd_loop_armed(s->loop)) {
    ethd_loop_disarm(s->loop);
    ethd__session_await_tick(s);
  }
  ethd_status status = ethd_loop_enable(s->loop);
  if (!status) ethd__session_await_tick(s);
  return status;
}

double ethd__session_clean_time(const ethd__session *s, double *needed) {
  char key[64];
  snprintf(key, sizeof key, "%s.clean_time", s->front->limits);
  *needed = s->front->config->get(&s->setup, key);
  return s->controller->clean_time(s->control);
}

bool ethd__session_acknowledge(ethd__session *s) {
  uint64_t before = ethd__recorder_clearings(&s->recorder);
  ethd_loop_acknowledge(s->loop);
  for (int i = 0; ethd__recorder_clearings(&s->recorder) == before && i < PATIENCE && ethd__session_lives(s); i++)
    pass(s);
  return !ethd__recorder_fault(&s->recorder);
}

/* Stops by a speed limit of 0: the guard stops the ring and removes the torque. */
void ethd__session_halt(ethd__session *s, bool told) {
  char message[ETHD_MESSAGE_MAX], key[64], detail[64];
  ethd__setup_copy setup = s->setup;
  snprintf(key, sizeof key, "%s.speed", s->front->limits);
  snprintf(detail, sizeof detail, "%s 0", key);
  atomic_store(&s->recorder.stopping, 1);
  if (told) {
    ethd_loop_raise(s->loop, ETHD_FAULT_APPLICATION);
    ethd__session_await_tick(s);
  }
  ethd_status status = s->front->config->set(&setup, key, 0);
  if (!status && ethd_loop_armed(s->loop) && !ethd__session_post(s, &setup, "set", detail, message))
    for (int i = 0; ethd_loop_armed(s->loop) && i < PATIENCE && ethd__session_lives(s); i++) pass(s);
  ethd_loop_disarm(s->loop);
  ethd__session_await_tick(s);
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

/* Prints the reason of the failure, and records it. */
static void tell_hang(ethd__session *s, ethd_status status, char *message) {
  const ethd_law *law;
  (void)ethd_loop_hangs(s->loop, &law);
  if (law)
    (void)ethd__say(message, status, "the law %s doesn't return: its step hangs; the device's torque was removed",
                    law->id);
  else
    (void)ethd__say(message, status, "the device %s doesn't return; the loop hangs in its code", s->config->device);
  if (s->recorder.recording) (void)!ethd_recording_event(s->recorder.recording, "fault", message);
}

static ethd_status end_loop(ethd__session *s, char *message) {
  ethd_loop_stop(s->loop);
  ethd_status status = ethd_loop_join(s->loop);
  ethd__recorder_end(&s->recorder);
  s->left = status && !ethd_loop_ended(s->loop);
  s->lost = s->left && status != ETHD_E_LAW; /* a second thread must not enter a device where one hangs */
  if (s->left)
    tell_hang(s, status, message);
  else if (status)
    (void)ethd__say(message, status, "the clock failed; the loop ended by itself");
  return status;
}

ethd_status ethd__session_end(ethd__session *s, char message[ETHD_MESSAGE_MAX]) {
  ethd_status status = s->loop ? end_loop(s, message) : ETHD_OK;
  ethd_status stopped = s->started && !s->lost ? ethd_device_stop(s->device) : ETHD_OK;
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
  if (s->device) ethd_device_close(s->device);
  if (s->controller) s->controller->destroy(s->control);
  if (s->config) ethd_config_free(s->config);
}
