/* Reads recordings from their folders. */
#include "identify/evidence.h"

#include <dirent.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "record/recording_parts.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

#define DEEP 3    /* levels of subfolders that are searched for recordings */
#define SOFT 0.15 /* s: longest soft start of the torque; a recording doesn't tell whether there was one */

/* ---- one recording ---- */

/* Marks the ticks at which the device applied the row's torque: not after a stop or a fault, and not during a soft
   start. */
static unsigned char *armed_ticks(const ethd__record_events *events, const ethd_trace *rows, size_t count,
                                  double period) {
  unsigned char *armed = malloc(count + 1);
  if (!armed) ethd__fail_memory();
  size_t next = 0, soft = (size_t)ceil(SOFT / period), wait = soft;
  bool off = false;
  for (size_t i = 0; i < count; i++) {
    for (; next < events->count && events->events[next].row <= i; next++) {
      const ethd__record_event *e = &events->events[next];
      bool begins = !strcmp(e->kind, "start"), soft_start = begins && !strcmp(e->detail, "enabled");
      if (begins || (!strcmp(e->kind, "setup") && !e->row)) {
        wait = begins && !soft_start ? 0 : soft; /* simulated taps have no loop, so they don't start softly */
        off = false;
      }
      if (!strcmp(e->kind, "set") && !strcmp(e->detail, "limits.speed 0")) off = true;
    }
    if (rows[i].fault) off = true;
    armed[i] = !off && !wait;
    if (wait) wait--;
  }
  return armed;
}

static bool differ(double a, double b) { return !(fabs(a - b) <= 1e-9 * fabs(a)); }

/* Refuses a recording of another arm: the known properties of the arm must agree in all recordings. */
static ethd_status agree(ethd__evidence *e, const char *folder, const ethd_setup *s, char *message) {
  if (!e->recording_count) {
    e->arm = s->arm;
    e->period = s->period;
    e->ring_radius = s->ring_radius;
  }
  if (e->arm.mechanism != s->arm.mechanism || differ(e->arm.link1, s->arm.link1) || differ(e->arm.link2, s->arm.link2))
    return ethd__say(message, ETHD_E_ARGUMENT,
                     "%s: of another arm than %s (%s, %g and %g m; %s, %g and %g m): fit each device by itself", folder,
                     e->folders[0], ethd_arm_name(s->arm.mechanism), s->arm.link1, s->arm.link2,
                     ethd_arm_name(e->arm.mechanism), e->arm.link1, e->arm.link2);
  if (differ(e->period, s->period))
    return ethd__say(message, ETHD_E_ARGUMENT, "%s: a period of %g s, but %s has %g s: record all at one period",
                     folder, s->period, e->folders[0], e->period);
  return ETHD_OK;
}

static void remember(ethd__evidence *e, const char *folder) {
  char **longer = realloc(e->folders, (e->recording_count + 1) * sizeof *longer);
  if (!longer || !(longer[e->recording_count] = strdup(folder))) ethd__fail_memory();
  e->folders = longer;
  e->recording_count++;
}

static ethd_status take(ethd__evidence *e, const char *folder, const ethd_config *config, char *message) {
  ETHD__FREED char *ticks = ethd__folder_path(folder, ETHD_RECORDING_TICK),
                   *path = ethd__folder_path(folder, ETHD_RECORDING_EVENTS);
  ETHD__FREED void *rows = NULL;
  size_t count = 0;
  ethd__record_events events = {0};
  ethd_status status = agree(e, folder, &config->setup, message);
  if (!status) status = ethd_npy_read(ticks, ethd_trace_columns, sizeof(ethd_trace), &rows, &count, message);
  if (!status) status = ethd__record_events_read(path, &events, message);
  if (!status) {
    ETHD__FREED unsigned char *armed = armed_ticks(&events, rows, count, e->period);
    remember(e, folder);
    ethd__evidence_rows(e, &config->setup, rows, count, armed);
  }
  ethd__record_events_free(&events);
  return status;
}

static ethd_status add_recording(ethd__evidence *e, const char *folder, char *message) {
  ETHD__FREED char *path = ethd__folder_path(folder, ETHD_RECORDING_CONFIG);
  ethd_config *config = NULL;
  ethd_status status = (e->plugins ? ethd_config_load : ethd_config_load_received)(path, &config, message);
  if (!status) ethd__need_plane(config);
  if (!status) status = take(e, folder, config, message);
  ethd_config_free(config);
  return status;
}

/* ---- folders ---- */

static bool is_recording(const char *folder) {
  ETHD__FREED char *path = ethd__folder_path(folder, ETHD_RECORDING_TICK);
  return ethd__file_taken(path);
}

static int is_visible(const struct dirent *entry) { return entry->d_name[0] != '.'; }

static ethd_status add_below(ethd__evidence *e, const char *folder, int deep, char *message) {
  struct dirent **entries;
  ethd_status status = ETHD_OK;
  if (is_recording(folder)) return add_recording(e, folder, message);
  int fd = deep ? ethd__file_open(folder, O_RDONLY | O_DIRECTORY, 0) : -1;
  int n = fd < 0 ? -1 : scandirat(fd, ".", &entries, is_visible, alphasort);
  if (fd >= 0) close(fd);
  for (int i = 0; i < n; i++) {
    ETHD__FREED char *path = ethd__folder_path(folder, entries[i]->d_name);
    if (!status && (entries[i]->d_type == DT_DIR || is_recording(path))) status = add_below(e, path, deep - 1, message);
    free(entries[i]);
  }
  if (n >= 0) free(entries);
  return status;
}

ethd_status ethd__evidence_add(ethd__evidence *e, const char *folder, char message[ETHD_MESSAGE_MAX]) {
  uint32_t before = e->recording_count;
  ethd_status status = add_below(e, folder, DEEP, message);
  if (status || e->recording_count > before) return status;
  return ethd__say(message, ETHD_E_FILE,
                   "%s: no recording, which has a tick.npy; ethd-run --record and ethd-identify --excite make one",
                   folder);
}

void ethd__evidence_free(ethd__evidence *e) {
  for (uint32_t i = 0; i < e->recording_count; i++) free(e->folders[i]);
  free(e->folders);
  free(e->q);
  free(e->torque);
  free(e->stretches);
  free(e->deliveries);
  *e = (ethd__evidence){0};
}
