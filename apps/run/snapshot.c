#include "run/snapshot.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "record/npy_parts.h"
#include "text/error_text.h"
#include "text/text.h"

#define BEFORE 2.0 /* s */
#define AFTER 1.0
#define ROWS_MAX 1e5

static size_t rows_in(double seconds, double period) {
  return (size_t)fmin(fmax(1, round(seconds / period)), ROWS_MAX);
}

ethd_status ethd__snapshot_open(ethd__snapshot *s, const char *path, double period, const ethd_column *columns,
                                size_t row_bytes) {
  *s = (ethd__snapshot){.columns = columns, .bytes = row_bytes};
  s->after = rows_in(AFTER, period);
  s->room = rows_in(BEFORE, period) + 1 + s->after;
  s->path = strdup(path);
  s->rows = malloc(s->room * s->bytes);
  if (s->path && s->rows) return ETHD_OK;
  ethd__snapshot_close(s);
  return ETHD_E_MEMORY;
}

/* Writes the rows, the oldest first. */
static ethd_status write_rows(ethd__snapshot *s, FILE *file, size_t n) {
  ethd_npy *npy;
  int fd = fcntl(fileno(file), F_DUPFD_CLOEXEC, 3);
  if (fd < 0) return ethd__say(s->message, ETHD_E_FILE, "%s: %s", s->path, strerror(errno));
  ethd_status status = ethd__npy_begin(fd, s->path, s->columns, s->bytes, &npy, s->message);
  if (status) return status;
  for (size_t i = s->count - n; !status && i < s->count; i++)
    status = ethd_npy_append(npy, s->rows + (i % s->room) * s->bytes, 1);
  if (!status) status = ethd_npy_flush(npy);
  int reason = ethd__npy_reason(npy);
  ethd_status closed = ethd_npy_close(npy);
  if (status || closed) (void)ethd__say(s->message, ETHD_E_FILE, "%s: %s", s->path, strerror(reason ? reason : errno));
  return status ? status : closed;
}

/* An earlier file stays until this one is complete. */
static ethd_status replace_file(ethd__snapshot *s, size_t n) {
  ethd_replace replace;
  ethd_status status = ethd_replace_begin(s->path, &replace, s->message);
  if (status) return status;
  status = write_rows(s, replace.file, n);
  if (!status) return ethd_replace_commit(&replace, s->message);
  ethd_replace_abandon(&replace);
  return status;
}

static void write_file(ethd__snapshot *s) {
  size_t n = s->count < s->room ? s->count : s->room;
  s->left = 0;
  ethd_status status = replace_file(s, n);
  if (!status)
    s->written = n;
  else if (!s->message[0])
    strcpy(s->message, ethd_status_sentence(status));
}

void ethd__snapshot_take(ethd__snapshot *s, const void *row, ethd_fault begins) {
  int over = s->fault != ETHD_FAULT_NONE && !s->left;
  if (!s->path || over) return;
  memcpy(s->rows + (s->count++ % s->room) * s->bytes, row, s->bytes);
  if (s->left) {
    if (--s->left == 0) write_file(s);
  } else if (begins) {
    s->fault = begins;
    s->left = s->after;
  }
}

void ethd__snapshot_finish(ethd__snapshot *s) {
  if (s->left) write_file(s);
}

void ethd__snapshot_close(ethd__snapshot *s) {
  free(s->rows);
  free(s->path);
  s->rows = NULL;
  s->path = NULL;
}
