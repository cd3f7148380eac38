#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "denormals.h"
#include "ethd/record.h"
#include "record/controller.h"
#include "record/npy_parts.h"
#include "record/recording_parts.h"
#include "settings/config_parts.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

typedef struct verification {
  const char *folder;
  bool plugins;
  char *events_path;
  ethd_config *config;
  const ethd__config_front *front;  /* of the configuration */
  const ethd__controller *replayed; /* and its controller */
  ethd__record_events events;
  char *tick_path;
  ethd__npy_reader rows;
  size_t next; /* event */
  ethd__setup_copy setup;
  double heat[2];              /* of the motors, by the last event of that kind */
  double learned[ETHD_MEMORY]; /* the law's memory, by the last event of that kind */
  void *control;
  const ethd__record_event *missing; /* the event that reports missing ticks; NULL: none are missing */
  char *message;
} verification;

/* ---- opening ---- */

static ethd_status open_config(verification *r) {
  ETHD__FREED char *path = ethd__path_join(r->folder, ETHD_RECORDING_CONFIG);
  if (!path) return ethd__no_memory(r->message, NULL);
  ethd_status status = (r->plugins ? ethd_config_load : ethd_config_load_received)(path, &r->config, r->message);
  if (status) return status;
  r->front = ethd__front_of(r->config);
  r->replayed = ethd__controller_of(r->config);
  memcpy(&r->setup, ethd__front_setup(r->config), r->front->bytes);
  return ETHD_OK;
}

static ethd_status open_rows(verification *r) {
  r->tick_path = ethd__path_join(r->folder, ETHD_RECORDING_TICK);
  if (!r->tick_path) return ethd__no_memory(r->message, NULL);
  return ethd__npy_reader_open(r->tick_path, r->replayed->columns, r->replayed->row_bytes, &r->rows, r->message);
}

static ethd_status open_events(verification *r) {
  r->events_path = ethd__path_join(r->folder, ETHD_RECORDING_EVENTS);
  if (!r->events_path) return ethd__no_memory(r->message, NULL);
  return ethd__record_events_read(r->events_path, &r->events, r->message);
}

/* ---- events ---- */

#define HEAT_MOST 1e9

enum { CHANGED = 1, FRESH = 2, CLEAR = 4, WARM = 8, HOT = 16, TAUGHT = 32 };

static ethd_status take_heat(verification *r, const char *detail, char *what) {
  const char *space = strchr(detail, ' ');
  bool numbers = space && ethd__number(detail, (size_t)(space - detail), &r->heat[0]) &&
                 ethd__number(space + 1, strlen(space + 1), &r->heat[1]);
  if (numbers && r->heat[0] >= 0 && r->heat[0] < HEAT_MOST && r->heat[1] >= 0 && r->heat[1] < HEAT_MOST) return ETHD_OK;
  return ethd__say(what, ETHD_E_SYNTAX, "two numbers from 0 to 1e9 are allowed");
}

static ethd_status take_learned(verification *r, const char *detail, char *what) {
  const char *p = detail;
  for (size_t i = 0; i < ETHD_MEMORY; i++) {
    size_t n = strcspn(p, " ");
    if (!ethd__number(p, n, &r->learned[i]) || !isfinite(r->learned[i]) || (p[n] == 0) != (i + 1 == ETHD_MEMORY))
      return ethd__say(what, ETHD_E_SYNTAX, "%u numbers are allowed", ETHD_MEMORY);
    p += n + 1;
  }
  return ETHD_OK;
}

static ethd_status set(verification *r, const char *detail, char *what) {
  char key[128];
  const char *space = strchr(detail, ' ');
  if (!space || (size_t)(space - detail) >= sizeof key)
    return ethd__say(what, ETHD_E_SYNTAX, "section.key value is allowed");
  memcpy(key, detail, (size_t)(space - detail));
  key[space - detail] = 0;
  return ethd__config_set(r->config, r->front, key, space + 1, &r->setup, what);
}

static ethd_status apply(verification *r, const ethd__record_event *e, int *done) {
  char what[ETHD_MESSAGE_MAX];
  ethd_status status = ETHD_OK;
  if (strcmp(e->kind, "setup") == 0) {
    memcpy(&r->setup, ethd__front_setup(r->config), r->front->bytes);
    status = ethd__config_law(r->config, r->front, "transition", e->detail, &r->setup, what);
    *done |= FRESH;
  } else if (strcmp(e->kind, "transition") == 0 || strcmp(e->kind, "contact") == 0 ||
             strcmp(e->kind, "tracking") == 0) {
    status = ethd__config_law(r->config, r->front, e->kind, e->detail, &r->setup, what);
    *done |= CHANGED;
  } else if (strcmp(e->kind, "set") == 0) {
    status = set(r, e->detail, what);
    *done |= CHANGED;
  } else if (strcmp(e->kind, "start") == 0) {
    *done |= strcmp(e->detail, "enabled") == 0 ? WARM : FRESH;
  } else if (strcmp(e->kind, "clear") == 0) {
    *done |= CLEAR;
  } else if (strcmp(e->kind, "heat") == 0 && r->replayed->set_heat) {
    status = take_heat(r, e->detail, what);
    *done |= HOT;
  } else if (strcmp(e->kind, "learned") == 0 && r->replayed->set_memory) {
    status = take_learned(r, e->detail, what);
    *done |= TAUGHT;
  } else if (strcmp(e->kind, "thinned") == 0 || strcmp(e->kind, "lost") == 0) {
    r->missing = e;
  } else if (strcmp(e->kind, "fault") != 0 && strcmp(e->kind, "clock") != 0 && strcmp(e->kind, "end") != 0) {
    status =
        ethd__say(what, ETHD_E_UNKNOWN,
                  "an unknown kind of event; setup, start, transition, contact, tracking, set, clear, thinned, lost, "
                  "%sfault, clock, end are allowed",
                  r->replayed->set_heat ? "heat, learned, " : "");
  }
  if (!status) return ETHD_OK;
  return ethd__say(r->message, status, "%s:%zu: %s: %s", r->events_path, e->line, e->kind, what);
}

static ethd_status renew(verification *r, int done) {
  ethd_error error = {0};
  ethd_status status = ETHD_OK;
  if ((done & ~(HOT | TAUGHT)) == WARM && r->control) {
    r->replayed->restart(r->control);
  } else if (done & (FRESH | WARM)) {
    r->replayed->destroy(r->control);
    status = r->replayed->create(&r->setup, &r->control, &error);
  } else if (done & CHANGED) {
    status = r->replayed->post(r->control, &r->setup, &error);
  }
  if (done & CLEAR && r->control) r->replayed->acknowledge(r->control);
  if (done & HOT && !status) r->replayed->set_heat(r->control, r->heat);
  if (done & TAUGHT && !status) r->replayed->set_memory(r->control, r->learned);
  if (status) ethd_error_text(r->events_path, &error, r->message);
  return status;
}

static ethd_status before_row(verification *r, size_t row) {
  int done = row == 0 ? FRESH : 0;
  while (r->next < r->events.count && r->events.events[r->next].row <= row) {
    ethd_status status = apply(r, &r->events.events[r->next++], &done);
    if (status) return status;
  }
  return renew(r, done);
}

/* ---- comparing ---- */

static bool same(const ethd_column *column, const unsigned char *a, const unsigned char *b) {
  double x, y;
  if (memcmp(a, b, 8) == 0) return true;
  if (column->type != 'f') return false;
  memcpy(&x, a, 8);
  memcpy(&y, b, 8);
  return x != x && y != y;
}

static void say_number(char type, const unsigned char *at, char out[32]) {
  double number;
  int64_t integer;
  memcpy(&number, at, 8);
  memcpy(&integer, at, 8);
  if (type == 'f')
    snprintf(out, 32, "%.17g", number);
  else
    snprintf(out, 32, "%" PRId64, integer);
}

/* Returns true if a replay can compute the column. */
static bool is_repeated(const verification *r, const ethd_column *c) {
  return !ethd__npy_lacks(&r->rows.shape, c) && !(r->replayed->unrepeated && !strcmp(r->replayed->unrepeated, c->name));
}

static ethd_status compare(const verification *r, size_t row, const void *recorded, const void *replayed) {
  const unsigned char *a = recorded, *b = replayed;
  char was[32], is[32], index[16] = "";
  for (const ethd_column *c = r->replayed->columns; c->name; c++)
    for (uint32_t i = 0; i < c->count; i++) {
      size_t at = c->offset + i * (size_t)8;
      if (same(c, a + at, b + at) || !is_repeated(r, c)) continue;
      if (c->count > 1) snprintf(index, sizeof index, "[%u]", i);
      say_number(c->type, a + at, was);
      say_number(c->type, b + at, is);
      return ethd__say(r->message, ETHD_E_DIFFERS, "%s: tick %zu: %s%s: recorded %s, replayed %s", r->folder, row,
                       c->name, index, was, is);
    }
  return ETHD_OK;
}

/* Judges by the event `end`, which a killed program, or one with a full disk, didn't write. */
static ethd_status judge_end(const verification *r) {
  const ethd__record_event *last = r->events.count ? &r->events.events[r->events.count - 1] : NULL;
  if (!last || strcmp(last->kind, "end") != 0)
    return ethd__say(r->message, ETHD_E_UNFINISHED,
                     "%s: %zu tick%s, equal to the bit, but the recording was never closed: later ones may be lost",
                     r->folder, r->rows.shape.count, ethd__s(r->rows.shape.count));
  if (last->row != r->rows.shape.count)
    return ethd__say(r->message, ETHD_E_DIFFERS, "%s:%zu: end: row: found %" PRIu64 ", but there %s %zu tick%s",
                     r->events_path, last->line, last->row, r->rows.shape.count == 1 ? "is" : "are",
                     r->rows.shape.count, ethd__s(r->rows.shape.count));
  return ethd__say(r->message, ETHD_OK, "%s: %zu tick%s, equal to the bit", r->folder, r->rows.shape.count,
                   ethd__s(r->rows.shape.count));
}

/* Refuses to continue at a tick before which others are missing, since they changed the controller's state. */
static ethd_status unreplayable(const verification *r, size_t row) {
  return ethd__say(r->message, ETHD_E_UNFINISHED,
                   "%s: %zu of %zu ticks are equal to the bit, the rest can't be replayed: %s (%s:%zu)", r->folder, row,
                   r->rows.shape.count, r->missing->detail, ETHD_RECORDING_EVENTS, r->missing->line);
}

static ethd_status stopped(const verification *r, size_t row) {
  return ethd__say(r->message, ETHD_E_UNFINISHED, "%s: stopped: %zu of %zu ticks are equal to the bit", r->folder, row,
                   r->rows.shape.count);
}

static ethd_status run(verification *r, const volatile int *stop) {
  for (size_t row = 0; row < r->rows.shape.count; row++) {
    if (stop && *stop) return stopped(r, row);
    union {
      ethd_trace plane;
      ethd_space_trace space;
    } trace;
    const void *recorded;
    ethd_event event;
    ethd_status status = ethd__npy_reader_next(&r->rows, &recorded, r->message);
    if (!status) status = before_row(r, row);
    if (status) return status;
    memset(&trace, 0, sizeof trace);
    ethd__config_foreign(r->config, "a plugin's law");
    r->replayed->step(r->control, recorded, &trace);
    while (r->replayed->poll(r->control, &event) == ETHD_OK)
      continue; /* a setup is taken only while events have room */
    ethd__config_foreign(r->config, NULL);
    status = compare(r, row, recorded, &trace);
    if (status) return r->missing ? unreplayable(r, row) : status;
  }
  return judge_end(r);
}

ethd_status ethd_recording_verify(const char *folder, bool plugins, const volatile int *stop,
                                  char message[ETHD_MESSAGE_MAX]) {
  verification r = {.folder = folder, .plugins = plugins, .message = message};
  uint64_t before = ethd__denormals_flush();
  ethd__received received;
  ethd__received_enter(&received, folder);
  ethd_status status = open_config(&r);
  if (!status) status = open_rows(&r);
  if (!status) status = open_events(&r);
  if (!status) status = run(&r, stop);
  if (r.replayed) r.replayed->destroy(r.control);
  ethd_config_free(r.config);
  ethd__record_events_free(&r.events);
  ethd__npy_reader_close(&r.rows);
  free(r.tick_path);
  free(r.events_path);
  ethd__received_leave(&received);
  ethd__denormals_restore(before);
  return status;
}
