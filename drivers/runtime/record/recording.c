#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "ethd/record.h"
#include "record/controller.h"
#include "record/npy_parts.h"
#include "record/recording_parts.h"
#include "settings/config_parts.h"
#include "text/csv.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

#define ROOM 256 /* bytes reserved in events.csv for a row about a failed write */

struct ethd_recording {
  ethd_npy *ticks;
  FILE *events;
  const ethd__controller *front;
  uint64_t rows; /* all rows so far, those in the file and the lost ones */
  ethd__claim claim;
  char *folder, failure[ETHD_MESSAGE_MAX]; /* "": none */
};

/* ---- config.ini ---- */

/* Returns the value of `file` in the recording's configuration instead of the original line's; NULL: the same. */
static const char *own_value(const ethd_config *config, int line) {
  const ethd_ini *ini = &ethd__config_whole(config)->ini;
  uint32_t plugin = 0;
  for (uint32_t i = 0; i < ini->count; i++) {
    const ethd_ini_key *k = &ini->keys[i];
    bool is_plugin = strcmp(k->section, "plugins") == 0;
    if (k->line == line && is_plugin) return config->plugins[plugin];
    if (k->line == line && strcmp(k->section, "scene") == 0) return ETHD_RECORDING_SCENE;
    plugin += is_plugin;
  }
  return NULL;
}

/* Returns the line that names drivers if some of them are files; 0: there is none. */
static int driver_files_line(const ethd_config *config) {
  const ethd_ini_key *key = ethd_ini_find(&ethd__config_whole(config)->ini, "device", "driver");
  return key && strstr(config->device, ETHD_DRIVER_FILE) ? key->line : 0;
}

char *ethd__record_config_text(const ethd_config *config) {
  char *text = NULL;
  size_t length;
  FILE *out = open_memstream(&text, &length);
  if (!out) return NULL;
  int line = 1, drivers = driver_files_line(config);
  for (const char *p = config->text; *p; line++) {
    size_t n = strcspn(p, "\n");
    const char *own = own_value(config, line);
    if (own)
      fprintf(out, "file = %s", own);
    else if (line == drivers)
      fprintf(out, "driver = %s", config->device);
    else
      fwrite(p, 1, n, out);
    putc('\n', out);
    p += n + (p[n] == '\n');
  }
  bool failed = ferror(out);
  if (fclose(out) == 0 && !failed) return text;
  free(text);
  return NULL;
}

/* ---- writing ---- */

static ethd_status write_file(const char *folder, const char *name, const char *text, char *message) {
  ETHD__FREED char *path = text ? ethd__path_join(folder, name) : NULL;
  if (!path) return ethd__no_memory(message, folder);
  return ethd_text_write(path, text, strlen(text), message);
}

static ethd_status write_config(const char *folder, const ethd_config *config, char *message) {
  ETHD__FREED char *text = ethd__record_config_text(config);
  return write_file(folder, ETHD_RECORDING_CONFIG, text, message);
}

/* Reserves room for the next row of events.csv on a full disk, if the file system can do so. */
static void keep_room(FILE *events) {
  off_t end = ftello(events);
  (void)!fallocate(fileno(events), FALLOC_FL_KEEP_SIZE, end, ROOM);
}

static ethd_status open_events(const char *path, ethd_recording *recording, char *message) {
  int fd = ethd__file_create(path, message);
  if (fd < 0) return ETHD_E_FILE;
  recording->events = fdopen(fd, "w");
  if (recording->events) return ETHD_OK;
  close(fd);
  return ethd__no_memory(message, path);
}

/* The ticks' file comes first: it marks a folder as a recording, which may be replaced. */
static ethd_status open_files(const char *folder, ethd_recording *recording, char *message) {
  ETHD__FREED char *ticks = ethd__path_join(folder, ETHD_RECORDING_TICK);
  ETHD__FREED char *events = ethd__path_join(folder, ETHD_RECORDING_EVENTS);
  ethd_status status = ticks && events ? ETHD_OK : ethd__no_memory(message, folder);
  if (!status)
    status = ethd_npy_create(ticks, recording->front->columns, recording->front->row_bytes, &recording->ticks, message);
  if (!status) status = open_events(events, recording, message);
  if (status) return status;
  fputs(ETHD_RECORDING_HEADER "\n", recording->events);
  fflush(recording->events);
  keep_room(recording->events);
  return status;
}

ethd_status ethd_recording_create(const char *folder, const ethd_config *config, bool replace, ethd_recording **out,
                                  char message[ETHD_MESSAGE_MAX]) {
  char unsaid[ETHD_MESSAGE_MAX];
  *out = NULL;
  ethd_recording *recording = calloc(1, sizeof *recording);
  if (!recording) return ethd__no_memory(message, folder);
  recording->claim = ETHD_CLAIM_NONE;
  recording->front = ethd__controller_of(config);
  recording->folder = strdup(folder);
  ethd_status status = ethd__recording_claim(folder, config, replace, &recording->claim, message);
  if (!status) status = open_files(folder, recording, message);
  if (!status) status = write_config(folder, config, message);
  if (!status && config->scene_text) status = write_file(folder, ETHD_RECORDING_SCENE, config->scene_text, message);
  if (status)
    (void)!ethd_recording_close(recording, unsaid);
  else
    *out = recording;
  return status;
}

/* ---- failed writes ---- */

static ethd_status put_event(ethd_recording *recording, uint64_t row, const char *kind, const char *detail) {
  FILE *file = recording->events;
  fprintf(file, "%" PRIu64 ",%s,", row, kind);
  ethd__csv_put_word(file, detail);
  putc('\n', file);
  if (fflush(file) != 0 || ferror(file)) return ETHD_E_FILE;
  keep_room(file);
  return ETHD_OK;
}

/* Only the first failure is reported, because later ones follow from it. */
ethd_status ethd__recording_fail(ethd_recording *recording, const char *name, int reason) {
  char detail[128];
  if (recording->failure[0]) return ETHD_E_FILE;
  uint64_t kept = ethd_recording_kept(recording);
  snprintf(detail, sizeof detail, "%s: %s", ethd_fault_sentence(ETHD_FAULT_RECORDER), strerror(reason));
  (void)!put_event(recording, kept, "fault", detail);
  return ethd__say(recording->failure, ETHD_E_FILE, "%s/%s: %s; ticks from %" PRIu64 " on are lost", recording->folder,
                   name, strerror(reason), kept);
}

const char *ethd_recording_failure(const ethd_recording *recording) { return recording->failure; }

uint64_t ethd_recording_kept(const ethd_recording *recording) { return ethd__npy_rows(recording->ticks); }

static ethd_status ticks_failed(ethd_recording *recording) {
  return ethd__recording_fail(recording, ETHD_RECORDING_TICK, ethd__npy_reason(recording->ticks));
}

/* Flushes the ticks before an event. Events are few, and the ticks after an event can't be interpreted without it. */
ethd_status ethd_recording_event(ethd_recording *recording, const char *kind, const char *detail) {
  ethd_status status = ethd_npy_flush(recording->ticks) ? ticks_failed(recording) : ETHD_OK;
  errno = 0;
  if (!put_event(recording, recording->rows, kind, detail)) return status;
  return ethd__recording_fail(recording, ETHD_RECORDING_EVENTS, errno ? errno : EIO);
}

ethd_status ethd__recording_row(ethd_recording *recording, const void *trace) {
  recording->rows++;
  return ethd_npy_append(recording->ticks, trace, 1) ? ticks_failed(recording) : ETHD_OK;
}

ethd_status ethd_recording_tick(ethd_recording *recording, const ethd_trace *trace) {
  if (recording->front->columns != ethd_trace_columns) return ETHD_E_ARGUMENT;
  return ethd__recording_row(recording, trace);
}

ethd_status ethd_recording_tick_space(ethd_recording *recording, const ethd_space_trace *trace) {
  if (recording->front->columns != ethd_space_trace_columns) return ETHD_E_ARGUMENT;
  return ethd__recording_row(recording, trace);
}

/* Writes the last event after ticks that are all in the file. */
static ethd_status finish(ethd_recording *recording) {
  if (recording->failure[0]) return ETHD_E_FILE;
  return ethd_recording_event(recording, "end", "closed");
}

static ethd_status close_files(ethd_recording *recording) {
  if (recording->ticks && ethd_npy_close(recording->ticks)) return ETHD_E_FILE;
  return ETHD_OK;
}

ethd_status ethd_recording_close(ethd_recording *recording, char message[ETHD_MESSAGE_MAX]) {
  if (!recording) return ETHD_OK;
  ethd_status status = recording->ticks && recording->events ? finish(recording) : ETHD_OK;
  const char *failure = recording->failure;
  if (close_files(recording) && !status) status = ETHD_E_FILE;
  if (recording->events && fclose(recording->events) != 0) status = ETHD_E_FILE;
  if (status)
    (void)ethd__say(message, status, "%s%s", *failure ? failure : recording->folder,
                    *failure ? "" : ": a write failed at the end");
  ethd__claim_release(&recording->claim);
  free(recording->folder);
  free(recording);
  return status;
}
