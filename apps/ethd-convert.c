/* A recording as a table or as a file of messages, for other programs. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "ethd/record.h"
#include "record/mcap.h"
#include "record/recording_parts.h"
#include "text/csv.h"
#include "text/error_text.h"
#include "text/text.h"

static const char doc[] =
    "Converts a recording to CSV, or to MCAP for PlotJuggler and Foxglove.\v"
    "CSV has a column per number (q_1_rad, q_2_rad, ...) and an empty cell where a number isn't defined. MCAP has the "
    "topics /tick and /events, and leaves out such a field; where the recording's time starts again, as it does with"
    " each tap, MCAP's time goes on.\n\n"
    "Example:\n"
    "  ethd-run --duration 10 --record session\n"
    "  ethd-convert session session.mcap";

static struct {
  const char *folder, *out;
} arg;

static error_t parse(int key, char *text, struct argp_state *state) {
  switch (key) {
  case ARGP_KEY_ARG:
    if (state->arg_num > 1) argp_error(state, "\"%s\": a recording and a file are all it takes", text);
    *(state->arg_num ? &arg.out : &arg.folder) = text;
    return 0;
  case ARGP_KEY_END:
    if (state->arg_num < 2) argp_error(state, "a recording's folder and a .csv or .mcap file are needed");
    return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

/* ---- the recording ---- */

typedef struct recording {
  ethd_trace *rows;
  size_t count;
  ethd__record_events events;
} recording;

static char *within(const char *name) {
  char *path = ethd__path_join(arg.folder, name);
  if (!path) ethd__fail_memory();
  return path;
}

static void refuse_inputs(void) {
  if (ethd__recording_holds(arg.folder, arg.out))
    ethd__fail(ETHD_EXIT_INPUT, "%s: is a file of the recording, which is only read; another name is needed", arg.out);
}

static recording open_recording(void) {
  char message[ETHD_MESSAGE_MAX];
  recording r = {0};
  void *rows = NULL;
  ethd__need_recording(arg.folder);
  char *tick = within(ETHD_RECORDING_TICK), *events = within(ETHD_RECORDING_EVENTS);
  ethd_status status = ethd_npy_read(tick, ethd_trace_columns, sizeof *r.rows, &rows, &r.count, message);
  if (!status) status = ethd__record_events_read(events, &r.events, message);
  if (status) ethd__fail(ethd__exit_code(status), "%s", message);
  r.rows = rows;
  free(tick);
  free(events);
  return r;
}

static const void *cell(const ethd_trace *row, const ethd_column *c, uint32_t i) {
  return (const char *)row + c->offset + 8 * (size_t)i;
}

/* ---- CSV ---- */

static const char *suffix(const char *unit) {
  static const char *const table[][2] = {{"rad", "_rad"}, {"rad/s", "_radps"}, {"m", "_m"},
                                         {"m/s", "_mps"}, {"N", "_n"},         {"Nm", "_nm"}};
  for (size_t i = 0; i < sizeof table / sizeof *table; i++)
    if (!strcmp(table[i][0], unit)) return table[i][1];
  return "";
}

static char *csv_header(void) {
  char *text = NULL;
  size_t length;
  FILE *out = open_memstream(&text, &length);
  if (!out) ethd__fail_memory();
  for (const ethd_column *c = ethd_trace_columns; c->name; c++)
    for (uint32_t i = 0; i < c->count; i++) {
      fprintf(out, "%s%s", c == ethd_trace_columns && !i ? "" : ",", c->name);
      if (c->count > 1) fprintf(out, "_%u", i + 1);
      fputs(suffix(c->unit), out);
    }
  fclose(out);
  return text;
}

/* Half of a recording takes nobody's place. */
static ethd_status stopped(char *message) {
  return ethd__say(message, ETHD_E_FILE, "%s: not written: stopped", arg.out);
}

static ethd_status to_csv(const recording *r, char *message) {
  char *header = csv_header();
  ethd_csv_out *out = ethd_csv_create(arg.out, header, message);
  free(header);
  if (!out) return ETHD_E_FILE;
  for (size_t k = 0; k < r->count && !ethd__stop; k++) {
    for (const ethd_column *c = ethd_trace_columns; c->name; c++)
      for (uint32_t i = 0; i < c->count; i++)
        if (c->type == 'i')
          ethd_csv_integer(out, *(const int64_t *)cell(&r->rows[k], c, i));
        else
          ethd_csv_number(out, *(const double *)cell(&r->rows[k], c, i));
    ethd_csv_row(out);
    ethd__progress(k, r->count, arg.out);
  }
  if (!ethd__stop) return ethd_csv_close(out, message);
  ethd_csv_abandon(out);
  return stopped(message);
}

/* ---- MCAP ---- */

/* JSON has no word for a number that isn't defined, and null is no number to a schema: such a field is left out. */
static bool is_defined(const ethd_trace *row, const ethd_column *c) {
  for (uint32_t i = 0; c->type == 'f' && i < c->count; i++)
    if (!isfinite(*(const double *)cell(row, c, i))) return false;
  return true;
}

static void put_numbers(FILE *out, const ethd_trace *row, const ethd_column *c) {
  for (uint32_t i = 0; i < c->count; i++) {
    if (i) putc(',', out);
    if (c->type == 'i')
      fprintf(out, "%" PRId64, *(const int64_t *)cell(row, c, i));
    else
      fprintf(out, "%.17g", *(const double *)cell(row, c, i));
  }
}

static void put_tick(FILE *out, const ethd_trace *row) {
  char before = '{';
  for (const ethd_column *c = ethd_trace_columns; c->name; c++) {
    if (!is_defined(row, c)) continue;
    fprintf(out, "%c\"%s\":%s", before, c->name, c->count > 1 ? "[" : "");
    put_numbers(out, row, c);
    if (c->count > 1) putc(']', out);
    before = ',';
  }
  putc('}', out); /* the first column is an integer, so there is one field at least */
}

static void put_schema(FILE *out) {
  fputs("{\"type\":\"object\",\"properties\":", out);
  for (const ethd_column *c = ethd_trace_columns; c->name; c++)
    fprintf(out, "%c\"%s\":{\"description\":\"%s\",\"type\":%s}", c == ethd_trace_columns ? '{' : ',', c->name, c->unit,
            c->count > 1 ? "\"array\",\"items\":{\"type\":\"number\"}" : "\"number\"");
  fputs("}}", out);
}

/* JSON is UTF-8: a byte that isn't becomes the character that stands for such ones. */
static void put_string(FILE *out, const char *text) {
  putc('"', out);
  while (*text) {
    uint32_t letter;
    size_t n = ethd__letter_of(text, &letter);
    if (!n)
      fputs("\xef\xbf\xbd", out);
    else if (letter < ' ')
      putc(' ', out);
    else
      fprintf(out, "%s%.*s", strchr("\"\\", *text) ? "\\" : "", (int)n, text);
    text += n ? n : 1;
  }
  putc('"', out);
}

#define EVENT_SCHEMA                                                                                    \
  "{\"type\":\"object\",\"properties\":{\"row\":{\"type\":\"integer\"},\"kind\":{\"type\":\"string\"}," \
  "\"detail\":{\"type\":\"string\"}}}"

/* A text that is written again and again. */
typedef struct text {
  char *at;
  size_t length;
  FILE *file;
} text;

static FILE *again(text *t) {
  if (!t->file) t->file = open_memstream(&t->at, &t->length);
  if (!t->file) ethd__fail_memory();
  rewind(t->file);
  return t->file;
}

static void say(ethd_mcap *mcap, uint16_t topic, int64_t now, text *t) {
  fflush(t->file);
  ethd_mcap_message(mcap, topic, now, t->at, (size_t)ftell(t->file));
}

/* Never backwards. */
static int64_t instant(const recording *r, size_t row, int64_t *shift, int64_t *last) {
  int64_t now = r->rows[row].sense.time_ns + *shift;
  if (now < *last) {
    *shift += *last - now + 1000000;
    now = *last + 1000000;
  }
  return *last = now;
}

static void say_event(ethd_mcap *mcap, uint16_t topic, int64_t now, const ethd__record_event *event, text *t) {
  FILE *out = again(t);
  fprintf(out, "{\"row\":%" PRIu64 ",\"kind\":", event->row);
  put_string(out, event->kind);
  fputs(",\"detail\":", out);
  put_string(out, event->detail);
  putc('}', out);
  say(mcap, topic, now, t);
}

static void put_messages(const recording *r, ethd_mcap *mcap, text *t) {
  put_schema(again(t));
  fflush(t->file);
  t->at[ftell(t->file)] = 0;
  uint16_t ticks = ethd_mcap_topic(mcap, "/tick", "ethd.tick", t->at);
  uint16_t events = ethd_mcap_topic(mcap, "/events", "ethd.event", EVENT_SCHEMA);
  int64_t shift = 0, now = 0;
  size_t e = 0;
  for (size_t k = 0; k < r->count && !ethd__stop; k++) {
    now = instant(r, k, &shift, &now);
    for (; e < r->events.count && r->events.events[e].row <= k; e++)
      say_event(mcap, events, now, &r->events.events[e], t);
    put_tick(again(t), &r->rows[k]);
    say(mcap, ticks, now, t);
    ethd__progress(k, r->count, arg.out);
  }
  for (; e < r->events.count; e++) say_event(mcap, events, now, &r->events.events[e], t);
}

static ethd_status to_mcap(const recording *r, char *message) {
  ethd_mcap *mcap;
  text t = {0};
  ethd_status status = ethd_mcap_create(arg.out, &mcap, message);
  if (status) return status;
  put_messages(r, mcap, &t);
  if (t.file) fclose(t.file);
  free(t.at);
  if (!ethd__stop) return ethd_mcap_close(mcap, message);
  ethd_mcap_abandon(mcap);
  return stopped(message);
}

/* ---- main ---- */

static bool ends_in(const char *path, const char *ending) {
  size_t n = strlen(path), m = strlen(ending);
  return n > m && !strcmp(path + n - m, ending);
}

int main(int argc, char **argv) {
  char message[ETHD_MESSAGE_MAX];
  const struct argp argp = {NULL, parse, "DIR OUT.csv|OUT.mcap", doc, NULL, NULL, NULL};
  ethd__begin();
  argp_parse(&argp, argc, argv, 0, NULL, NULL);
  bool is_csv = ends_in(arg.out, ".csv");
  if (!is_csv && !ends_in(arg.out, ".mcap"))
    ethd__fail(ETHD_EXIT_INPUT, "%s: a name that ends in .csv or .mcap is allowed", arg.out);
  ethd__catch_interrupt();
  ethd__receive(arg.folder);
  refuse_inputs();
  recording r = open_recording();
  ethd_status status = (is_csv ? to_csv : to_mcap)(&r, message);
  ethd__progress(1, 1, arg.out);
  if (status) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  printf("%s: %zu tick%s, %zu event%s\n", arg.out, r.count, ethd__s(r.count), r.events.count, ethd__s(r.events.count));
  free(r.rows);
  ethd__record_events_free(&r.events);
  return ethd__end(ETHD_EXIT_DONE);
}
