#include "explain/search.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#include "cli/cli.h"
#include "ethd/ethd.h"
#include "sim/random.h"
#include "text/error_text.h"
#include "text/file.h"
#include "text/text.h"

#define BEST 0.15     /* share of the population, its best, from which p is drawn */
#define CROSSING 0.85 /* chance of each number that a child takes it from the step instead of its parent */
#define FALLEN 0.01   /* by less the least total hasn't fallen */
#define STEP_LEAST 0.3
#define STEP_MOST 0.9

/* ---- draws ---- */

enum { FACTOR, PARENT_BEST, PARENT_A, PARENT_B, ALWAYS, CROSS, FIRST };

static double draw(const ethd__explain_search *s, uint32_t generation, uint32_t number, uint32_t what, uint32_t which) {
  const ethd__sim_key key = {s->question->seed, ((uint64_t)generation << 32) + number};
  return ethd__uniform(key, what, which);
}

static uint32_t index_of(double share, uint32_t count) { return (uint32_t)(share * count); }

/* Fills the order of the population, the best first. */
static void rank(const ethd__explain_search *s, uint32_t *order) {
  for (uint32_t i = 0; i < s->population; i++) {
    uint32_t k = i;
    for (; k > 0 && s->total[order[k - 1]] > s->total[i]; k--) order[k] = order[k - 1];
    order[k] = i;
  }
}

static ethd__explain_point first(const ethd__explain_search *s, uint32_t number) {
  ethd__explain_point p = ethd__explain_known(&s->question->structure);
  for (uint32_t n = 0; number && n < ETHD_EXPLAIN_NUMBERS; n++) p.share[n] = draw(s, 0, number, FIRST, n);
  return p;
}

/* A number that left its bounds is put halfway between its parent and the bound. */
static double within(double share, double from) { return share < 0 ? from / 2 : share > 1 ? (1 + from) / 2 : share; }

static ethd__explain_point child_of(const ethd__explain_search *s, const uint32_t *order, uint32_t generation,
                                    uint32_t i) {
  double f = STEP_LEAST + (STEP_MOST - STEP_LEAST) * draw(s, generation, i, FACTOR, 0);
  uint32_t top = (uint32_t)fmax(2, BEST * s->population);
  const double *x = s->point[i].share,
               *p = s->point[order[index_of(draw(s, generation, i, PARENT_BEST, 0), top)]].share;
  const double *a = s->point[index_of(draw(s, generation, i, PARENT_A, 0), s->population)].share;
  const double *b = s->point[index_of(draw(s, generation, i, PARENT_B, 0), s->population)].share;
  uint32_t always = index_of(draw(s, generation, i, ALWAYS, 0), ETHD_EXPLAIN_NUMBERS);
  ethd__explain_point child = s->point[i];
  for (uint32_t n = 0; n < ETHD_EXPLAIN_NUMBERS; n++)
    if (n == always || draw(s, generation, i, CROSS, n) < CROSSING)
      child.share[n] = within(x[n] + f * (p[n] - x[n]) + f * (a[n] - b[n]), x[n]);
  return child;
}

/* ---- the journal: a line that says what is searched for, then a line for each total, in the order of judging ---- */

typedef struct journal {
  FILE *file;
  double *totals;
  size_t count, next; /* totals that an earlier run kept; the next of them to be used */
} journal;

static char *describe(const ethd__explain_search *s) {
  char *out = NULL;
  size_t length;
  const ethd__explain_question *q = s->question;
  FILE *f = open_memstream(&out, &length);
  if (!f) ethd__fail_memory();
  fprintf(f, "ethd-explain %s seed %llu population %u taps %u compliant %d tick %d asked %d%d%d bounds", ETHD_VERSION,
          (unsigned long long)q->seed, s->population, q->taps, q->structure.compliant, q->structure.tick, q->asked[0],
          q->asked[1], q->asked[2]);
  for (int n = 0; n < ETHD_EXPLAIN_NUMBERS; n++)
    fprintf(f, " %.9g:%.9g", ethd__explain_priors[n].low, ethd__explain_priors[n].high);
  if (fclose(f)) ethd__fail_memory();
  return out;
}

static ethd_status take_totals(const char *path, const char *what, char *text, journal *j, char *message) {
  char *line = text, *end = strchr(text, '\n');
  if (!end || (size_t)(end - text) != strlen(what) || strncmp(text, what, strlen(what)) != 0)
    return ethd__say(message, ETHD_E_DIFFERS, "%s: the journal of another search; another --work is needed", path);
  size_t lines = 0;
  for (line = end + 1; (end = strchr(line, '\n')); line = end + 1) lines++;
  if (!(j->totals = malloc((lines + 1) * sizeof *j->totals))) ethd__fail_memory();
  for (line = strchr(text, '\n') + 1; (end = strchr(line, '\n')); line = end + 1) {
    double *total = &j->totals[j->count++];
    if (!ethd__number(line, (size_t)(end - line), total) || !(*total >= 0))
      return ethd__say(message, ETHD_E_SYNTAX, "%s:%zu: no sum of misses", path, j->count + 1);
  }
  return ETHD_OK;
}

static ethd_status refuse(const char *path, char *message) {
  return ethd__say(message, ETHD_E_FILE, "%s: %s", path, strerror(errno ? errno : EIO));
}

/* Returns the length of the whole lines. The last line is cut off where a process was ended while it wrote. */
static size_t whole_lines(const char *text, size_t length) {
  while (length && text[length - 1] != '\n') length--;
  return length;
}

/* Opens the journal. What is there stays there; only a last line that isn't whole is cut off. */
static ethd_status open_file(const char *path, const char *what, journal *j, char *message) {
  char *text = NULL;
  size_t length = 0;
  int fd = ethd__file_edit(path, true, message);
  if (fd < 0) return ETHD_E_FILE;
  if (!(j->file = fdopen(fd, "ab"))) return refuse(path, message);
  if (flock(fileno(j->file), LOCK_EX | LOCK_NB))
    return ethd__say(message, ETHD_E_FILE, "%s: another process works on this search", path);
  ethd_status status = ethd_text_read(path, (size_t)1 << 26, &text, &length, message);
  size_t whole = status ? 0 : whole_lines(text, length);
  bool is_begun = !status && length == strlen(text) && !strncmp(text, what, length); /* ended within its first line */
  if (!status && !(is_begun && !whole)) status = take_totals(path, what, text, j, message);
  free(text);
  if (status) return status;
  if (ftruncate(fileno(j->file), (off_t)whole)) return refuse(path, message);
  errno = 0;
  if (!whole) fprintf(j->file, "%s\n", what);
  return fflush(j->file) ? refuse(path, message) : ETHD_OK;
}

static ethd_status open_journal(const ethd__explain_search *s, journal *j, char *message) {
  char *what = describe(s);
  *j = (journal){0};
  ethd_status status = s->journal ? open_file(s->journal, what, j, message) : ETHD_OK;
  free(what);
  return status;
}

static ethd_status judge(ethd__explain_search *s, journal *j, const ethd__explain_point *point, double enough,
                         double *total, char *message) {
  ethd__explain_figures figures;
  s->judged++;
  if (j->next < j->count) {
    *total = j->totals[j->next++];
    return ETHD_OK;
  }
  ethd__explain_twin twin;
  ethd__explain_make(&s->question->base, &s->question->structure, point, &twin);
  ethd_status status = ethd__explain_judge(s->question, &twin, enough, &figures, total, message);
  if (status || !j->file) return status;
  errno = 0;
  fprintf(j->file, "%.17g\n", *total);
  if (!fflush(j->file)) return ETHD_OK;
  (void)!refuse(s->journal, message);
  return ETHD_E_UNFINISHED;
}

/* ---- the whole ---- */

uint32_t ethd__explain_best(const ethd__explain_search *s) {
  uint32_t best = 0;
  for (uint32_t i = 1; i < s->population; i++)
    if (s->total[i] < s->total[best]) best = i;
  return best;
}

static ethd_status breed(ethd__explain_search *s, journal *j, uint32_t generation, char *message) {
  uint32_t order[ETHD_EXPLAIN_POPULATION_MAX];
  rank(s, order);
  for (uint32_t i = 0; i < s->population && !ethd__stop; i++) {
    double total;
    ethd__explain_point child = child_of(s, order, generation, i);
    ethd_status status = judge(s, j, &child, s->total[i], &total, message);
    if (status) return status;
    if (total <= s->total[i]) s->point[i] = child, s->total[i] = total;
    if (total < (1 - FALLEN) * s->mark) s->mark = total, s->lowered = generation;
  }
  return ETHD_OK;
}

ethd_status ethd__explain_run(ethd__explain_search *s, char message[ETHD_MESSAGE_MAX]) {
  journal j;
  ethd_status status = open_journal(s, &j, message);
  for (uint32_t i = 0; !status && i < s->population; i++) {
    s->point[i] = first(s, i);
    s->total[i] = (double)INFINITY;
    if (!ethd__stop) status = judge(s, &j, &s->point[i], (double)INFINITY, &s->total[i], message);
  }
  s->mark = s->total[ethd__explain_best(s)];
  for (uint32_t g = 1; !status && g <= s->generations && !ethd__stop && !ethd__explain_at_end(s); g++) {
    ethd__progress(g - 1, s->generations, "generations");
    status = breed(s, &j, g, message);
    s->done = g;
  }
  ethd__progress(s->generations, s->generations, "generations");
  if (j.file && fclose(j.file) && !status) status = refuse(s->journal, message);
  free(j.totals);
  return status;
}
