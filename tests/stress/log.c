#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <string.h>

#include "cli/cli.h"
#include "stress/stress.h"
#include "text/text.h"

/* 0 exact, 1 just allowed, over 1 failed; what isn't a number has failed. */
static double load(const ethd__stress_result *r) {
  double off = r->bound ? r->measured : fabs(r->measured - r->analytic);
  double most = r->bound ? r->analytic : r->allowed;
  if (off <= most) return most > 0 ? off / most : 0;
  double over = off / most;
  return over > 1 ? over : (double)INFINITY;
}

/* Of two results with the same words: bounds of 0 have no load to tell them apart. */
static bool worse(const ethd__stress_result *r, const ethd__stress_result *than) {
  double a = load(r), b = load(than);
  return a > b || (a == b && r->bound && r->measured > than->measured);
}

static void print(const ethd__stress_result *r) {
  char count[48] = "";
  if (r->count > 1) snprintf(count, sizeof count, ", worst of %llu", (unsigned long long)r->count);
  printf("  %-62s %12.6g %s %-12.6g %-6s", r->what, r->measured, r->bound ? "<=" : "= ", r->analytic, r->unit);
  if (r->bound)
    printf(" %19s", "");
  else
    printf(" %7.1e of %7.1e", fabs(r->measured - r->analytic), r->allowed);
  printf("  %s%s\n", load(r) <= 1 ? "ok" : "FAILED", count);
}

void ethd__stress_flush(ethd__stress_log *log) {
  for (int i = 0; i < log->count; i++) print(&log->lines[i]);
  fflush(stdout);
  log->count = 0;
}

/* Finds the line with these words, or adds one at the end. */
static ethd__stress_result *line_of(ethd__stress_log *log, const char *what) {
  for (int i = 0; i < log->count; i++)
    if (strcmp(log->lines[i].what, what) == 0) return &log->lines[i];
  if (log->count == ETHD__STRESS_LINES) ethd__stress_flush(log);
  memset(&log->lines[log->count], 0, sizeof *log->lines);
  return &log->lines[log->count++];
}

static void add(ethd__stress_log *log, const ethd__stress_result *r) {
  ethd__stress_result *line = line_of(log, r->what);
  uint64_t count = line->count;
  int passed = load(r) <= 1;
  if (count == 0 || worse(r, line)) *line = *r;
  line->count = count + 1;
  if (!passed) log->failures++;
  if (log->csv)
    fprintf(log->csv, "%s,\"%s\",%.17g,%s,%.17g,%s,%.17g,%d\n", log->test, r->what, r->measured, r->bound ? "<=" : "=",
            r->analytic, r->unit, r->allowed, passed);
}

#define WORDS(r, what)                               \
  do {                                               \
    va_list args;                                    \
    va_start(args, what);                            \
    vsnprintf((r).what, sizeof(r).what, what, args); \
    va_end(args);                                    \
  } while (0)

void ethd__stress_near(ethd__stress_log *log, const char *unit, double measured, double analytic, double share,
                       const char *what, ...) {
  ethd__stress_result r = {.unit = unit, .measured = measured, .analytic = analytic};
  r.allowed = share * fabs(analytic);
  WORDS(r, what);
  add(log, &r);
}

void ethd__stress_within(ethd__stress_log *log, const char *unit, double measured, double analytic, double distance,
                         const char *what, ...) {
  ethd__stress_result r = {.unit = unit, .measured = measured, .analytic = analytic, .allowed = distance};
  WORDS(r, what);
  add(log, &r);
}

void ethd__stress_bound(ethd__stress_log *log, const char *unit, double measured, double bound, const char *what, ...) {
  ethd__stress_result r = {.unit = unit, .measured = measured, .analytic = bound, .bound = 1};
  WORDS(r, what);
  add(log, &r);
}

void ethd__stress_note(ethd__stress_log *log, const char *text, ...) {
  va_list args;
  ethd__stress_flush(log);
  va_start(args, text);
  printf("  ");
  vprintf(text, args);
  printf("\n");
  va_end(args);
}

static ethd_replace tables[2]; /* that are open */

FILE *ethd__stress_data(const ethd__stress_log *log, const char *name, const char *header) {
  char path[4096], message[ETHD_MESSAGE_MAX];
  if (!log->folder) return NULL;
  ethd_replace *table = &tables[tables[0].file != NULL];
  snprintf(path, sizeof path, "%s/%s", log->folder, name);
  if (ethd_replace_begin(path, table, message) < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  fprintf(table->file, "%s\n", header);
  return table->file;
}

void ethd__stress_close(FILE *data) {
  char message[ETHD_MESSAGE_MAX];
  if (!data) return;
  ethd_replace *table = &tables[tables[0].file != data];
  if (ethd_replace_commit(table, message) < 0) ethd__fail(ETHD_EXIT_FAILED, "%s", message);
  table->file = NULL;
}
