#include "tape/tape.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "record/recording_parts.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

static ethd_status no_memory(const char *folder, char *message) { return ethd__no_memory(message, folder); }

/* Takes the device's limits from the events before the first row. */
static ethd_status take_device(const ethd__record_events *events, ethd__tape *out, char *message) {
  ethd_config *config;
  ethd_status status = ethd_config_load(NULL, &config, message);
  if (status) return status;
  ethd_setup setup = config->setup;
  setup.limits = ethd_limits_none();
  for (size_t i = 0; !status && i < events->count && events->events[i].row == 0; i++) {
    char key[64];
    const ethd__record_event *e = &events->events[i];
    size_t n = strcspn(e->detail, " ");
    if (strcmp(e->kind, "set") != 0 || n >= sizeof key) continue;
    if (strncmp(e->detail, "limits.", 7) != 0 && strncmp(e->detail, "arm.", 4) != 0) continue;
    memcpy(key, e->detail, n);
    key[n] = 0;
    status = ethd_config_set(config, key, e->detail + n + (e->detail[n] == ' '), &setup, message);
  }
  out->limits = setup.limits;
  out->dynamics = setup.dynamics;
  ethd_config_free(config);
  return status;
}

static bool changes(const ethd__record_event *e) {
  return strcmp(e->kind, "fault") && strcmp(e->kind, "lost") && strcmp(e->kind, "thinned");
}

/* Takes the first command that was given while the recording ran. */
static void take_change(const ethd__record_events *events, ethd__tape *tape) {
  tape->changed = tape->count;
  for (size_t i = 0; i < events->count; i++) {
    const ethd__record_event *e = &events->events[i];
    if (e->row == 0 || e->row >= tape->count || !changes(e)) continue;
    tape->changed = (size_t)e->row;
    snprintf(tape->change, sizeof tape->change, "%s%s%s", e->kind, e->detail[0] ? " " : "", e->detail);
    return;
  }
}

static ethd_status take_events(const char *folder, ethd__tape *tape, char *message) {
  ethd__record_events events = {0};
  ETHD__FREED char *path = ethd__path_join(folder, ETHD_RECORDING_EVENTS);
  ethd_status status = path ? ethd__record_events_read(path, &events, message) : no_memory(folder, message);
  if (status) return status;
  take_change(&events, tape);
  status = take_device(&events, tape, message);
  ethd__record_events_free(&events);
  return status;
}

ethd_status ethd__tape_load(const char *folder, ethd__tape *out, char message[ETHD_MESSAGE_MAX]) {
  ethd__received received;
  void *rows = NULL;
  *out = (ethd__tape){.count = 0};
  ethd__received_enter(&received, folder);
  ETHD__FREED char *path = ethd__path_join(folder, ETHD_RECORDING_TICK);
  ethd_status status = path ? ethd_npy_read(path, ethd_trace_columns, sizeof(ethd_trace), &rows, &out->count, message)
                            : no_memory(folder, message);
  out->rows = rows;
  if (!status && !out->count) status = ethd__say(message, ETHD_E_RANGE, "%s: the recording has no ticks", folder);
  if (!status) status = take_events(folder, out, message);
  ethd__received_leave(&received);
  if (status) ethd__tape_free(out);
  return status;
}

void ethd__tape_free(ethd__tape *tape) {
  free(tape->rows);
  *tape = (ethd__tape){.count = 0};
}
