/* Opens a session: device, controller, recorder, loop. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/cli.h"
#include "record/limits_event.h"
#include "run/refusal.h"
#include "run/session.h"
#include "run/telemetry.h"
#include "text/error_text.h"
#include "text/text.h"

#define HEARTBEAT 0.1 /* s */

static ethd_status open_device(ethd__session *s, const char *folder, char *message) {
  ethd_config *config = s->config;
  ethd_error error = {0};
  const ethd_device_def def = {.setup = config->is_space ? NULL : &config->setup,
                               .settings = config->settings,
                               .setting_count = config->setting_count,
                               .folder = folder ? folder : config->folder,
                               .file = config->path,
                               .is_virtual = s->is_virtual,
                               .space = config->is_space ? &config->space : NULL};
  ethd_status status = ethd_device_open(config->device, NULL, &def, &s->device, message);
  if (status) return status;
  s->front = ethd__session_front_of(config);
  s->controller = ethd__controller_of(config);
  memcpy(&s->setup, ethd__front_setup(config), s->front->config->bytes);
  s->period = config->is_space ? config->space.period : config->setup.period;
  s->front->merge(s->device, &s->setup);
  status = s->controller->create(&s->setup, &s->control, &error);
  if (status) ethd_error_text(config->path, &error, message);
  return status;
}

/* The thread that writes the snapshot must not block, as on a pipe. */
static bool is_other_than_file(const char *path) {
  struct stat info;
  return stat(path, &info) == 0 && !S_ISREG(info.st_mode);
}

/* The snapshot goes into the recording's folder unless another path is given. */
static ethd_status open_snapshot(ethd__session *s, const ethd__session_options *o, char *message) {
  char *path = o->snapshot ? strdup(o->snapshot) : ethd__path_join(o->record, "snapshot.npy");
  if (path && is_other_than_file(path)) {
    ethd_status status = ethd__say(message, ETHD_E_FILE, "--snapshot: %s: isn't a file", path);
    free(path);
    return status;
  }
  ethd_status status = path ? ethd__snapshot_open(&s->recorder.snapshot, path, s->period, s->controller->columns,
                                                  s->controller->row_bytes)
                            : ETHD_E_MEMORY;
  free(path);
  return status ? ethd__say(message, status, "--snapshot: %s", ethd_status_sentence(status)) : ETHD_OK;
}

static ethd_status open_recorder(ethd__session *s, const ethd__session_options *o, char *message) {
  ethd__recorder *r = &s->recorder;
  ethd_status status = ETHD_OK;
  r->telemetry = -1;
  r->keeps = o->keeps;
  if (o->telemetry) status = ethd__telemetry_open("--telemetry", o->telemetry, o->group, &r->telemetry, message);
  if (!status && (o->snapshot || o->record)) status = open_snapshot(s, o, message);
  if (status || !o->record) return status;
  status = ethd_recording_create(o->record, s->config, o->replace, &r->recording, message);
  if (status) return status;
  for (int i = 0; !status && i < 2 && s->front->merged[i]; i++)
    status = ethd__section_events(r->recording, s->front->config, s->front->merged[i], ethd__front_setup(s->config),
                                  &s->setup);
  if (!status && r->keeps > 1) status = ethd__recorder_thinned(r);
  return status ? ethd__say(message, status, "%s: %s", o->record, ethd_status_sentence(status)) : ETHD_OK;
}

static ethd_status refuse_device(const ethd__session *s, ethd_status status, char *message) {
  const char *why = ethd_device_why(s->device);
  return ethd__say(message, status, "device %s: start: %.*s", s->config->device, ETHD_MESSAGE_MAX / 2,
                   why[0] ? why : ethd_status_sentence(status));
}

static ethd_status open_loop(ethd__session *s, const ethd__session_options *o, char *message) {
  ethd_loop_def def = o->loop;
  ethd_error error = {0};
  def.device = s->device;
  s->front->enter(s->config, &s->setup, s->control, &def);
  if (def.gap < (double)INFINITY) def.heartbeat = HEARTBEAT;
  def.clock = o->is_virtual ? &s->clock : NULL;
  ethd_status status = ethd_loop_create(&def, &s->loop, &error);
  if (status == ETHD_E_DEVICE) return ethd__start_refused(NULL, status, &error, message);
  if (status) {
    ethd_error_text("the loop", &error, message);
    return status;
  }
  s->recorder.loop = s->loop;
  s->recorder.front = s->front;
  s->recorder.columns = s->controller->columns;
  ethd__recorder_begin(&s->recorder, def.period);
  if (o->home) status = ethd_device_home(s->device, NULL);
  if (!status) status = ethd_device_start(s->device);
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
  ethd__session_await_tick(s);
  return ETHD_OK;
}
