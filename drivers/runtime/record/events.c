#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "record/recording_parts.h"
#include "text/error_text.h"
#include "text/text.h"

#define BYTES_MAX ((size_t)1 << 30)

/* Cuts the next line off *rest; NULL at the end. */
static char *cut_line(char **rest) {
  char *line = *rest;
  if (!*line) return NULL;
  size_t n = strcspn(line, "\n");
  *rest = line + n + (line[n] == '\n');
  line[n] = 0;
  if (n && line[n - 1] == '\r') line[n - 1] = 0;
  return line;
}

/* Removes a word's quotes, in place. */
static void unquote(char *word) {
  if (*word != '"') return;
  char *to = word;
  for (const char *p = word + 1; *p; p++) {
    if (*p == '"' && *++p != '"') break;
    *to++ = *p;
  }
  *to = 0;
}

static bool parse_line(char *line, ethd__record_event *out) {
  char *kind = strchr(line, ','), *detail = kind ? strchr(kind + 1, ',') : NULL;
  if (!detail) return false;
  *kind++ = *detail++ = 0;
  size_t digits = strspn(line, "0123456789");
  if (!digits || digits > 18 || line[digits]) return false;
  unquote(detail);
  out->row = strtoull(line, NULL, 10);
  out->kind = kind;
  out->detail = detail;
  return true;
}

static ethd_status parse(const char *path, ethd__record_events *out, char *message) {
  char *rest = out->text, *line = cut_line(&rest);
  uint64_t last = 0;
  if (!line || strcmp(line, ETHD_RECORDING_HEADER) != 0)
    return ethd__say(message, ETHD_E_SYNTAX, "%s:1: the first line must be %s", path, ETHD_RECORDING_HEADER);
  for (size_t n = 2; (line = cut_line(&rest)); n++) {
    ethd__record_event *event = &out->events[out->count];
    if (!parse_line(line, event)) return ethd__say(message, ETHD_E_SYNTAX, "%s:%zu: no row,kind,detail", path, n);
    if (event->row < last)
      return ethd__say(message, ETHD_E_SYNTAX, "%s:%zu: row: found %" PRIu64 ", %" PRIu64 " or more is allowed", path,
                       n, event->row, last);
    last = event->row;
    event->line = n;
    out->count++;
  }
  return ETHD_OK;
}

static size_t count_lines(const char *p) {
  size_t n = 1;
  for (; *p; p++) n += *p == '\n';
  return n;
}

ethd_status ethd__record_events_read(const char *path, ethd__record_events *out, char message[ETHD_MESSAGE_MAX]) {
  size_t length;
  *out = (ethd__record_events){0};
  ethd_status status = ethd_text_read(path, BYTES_MAX, &out->text, &length, message);
  if (status) return status;
  if (strlen(out->text) != length)
    status = ethd__say(message, ETHD_E_SYNTAX, "%s: a byte 0: this isn't text", path);
  else if (!(out->events = calloc(count_lines(out->text), sizeof *out->events)))
    status = ethd__no_memory(message, path);
  else
    status = parse(path, out, message);
  if (status) ethd__record_events_free(out);
  return status;
}

void ethd__record_events_free(ethd__record_events *events) {
  free(events->events);
  free(events->text);
  *events = (ethd__record_events){0};
}
