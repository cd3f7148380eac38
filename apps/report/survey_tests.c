#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "report/survey.h"
#include "statistics/paired.h"
#include "text/csv.h"

/* Compares strategies a and b, or with `all` every strategy from a to b, by the people who answered under all of
   them. */
typedef struct asked {
  size_t question;
  size_t a, b, n, above, below;
  bool all;
  double statistic, p, holm;
} asked;

static asked compare_two(const ethd__report *r, const ethd__answers *answer, size_t q, size_t a, size_t b) {
  asked out = {.question = q, .a = a, .b = b};
  double *differences = malloc((r->data.people_count + 1) * sizeof *differences);
  if (!differences) ethd__fail_memory();
  for (size_t p = 0; p < r->data.people_count; p++) {
    differences[out.n] = answer->of[b][q][p] - answer->of[a][q][p];
    if (isnan(differences[out.n])) continue;
    out.above += differences[out.n] > 0, out.below += differences[out.n] < 0;
    out.n++;
  }
  ethd__signed_rank w = ethd__wilcoxon(differences, out.n);
  out.statistic = fmin(w.above, w.below);
  out.p = out.n >= ETHD_STATISTICS_PEOPLE ? w.p : NAN;
  free(differences);
  return out;
}

/* Compares the cells from a to b, which are all of one speed. */
static asked compare_all(const ethd__report *r, const ethd__answers *answer, size_t q, size_t a, size_t b) {
  asked out = {.question = q, .a = a, .b = b, .all = true};
  size_t columns = b - a + 1;
  double *rows = malloc((r->data.people_count * columns + 1) * sizeof *rows);
  if (!rows) ethd__fail_memory();
  for (size_t p = 0; p < r->data.people_count; p++) {
    bool whole = true;
    for (size_t c = 0; c < columns; c++) {
      rows[out.n * columns + c] = answer->of[a + c][q][p];
      whole &= !isnan(answer->of[a + c][q][p]);
    }
    out.n += whole;
  }
  out.statistic = ethd__friedman(rows, out.n, columns, &out.p);
  if (out.n < ETHD_STATISTICS_PEOPLE) out.p = NAN;
  free(rows);
  return out;
}

static void put_test(ethd__report *r, const asked *t, ethd_csv_out *csv) {
  const ethd__group *a = &r->data.group[t->a], *b = &r->data.group[t->b];
  char question[16], what[160], n[24], above[24], below[24], statistic[32], p[32], holm[32];
  snprintf(question, sizeof question, "Q%zu", t->question + 1);
  if (t->all)
    snprintf(what, sizeof what, "all strategies, %s", a->speed.word);
  else
    snprintf(what, sizeof what, "%s - %s, %s", b->cell.law, a->cell.law, a->speed.word);
  snprintf(n, sizeof n, "%zu", t->n);
  snprintf(above, sizeof above, "%zu", t->above);
  snprintf(below, sizeof below, "%zu", t->below);
  const char *cells[] = {question,
                         what,
                         t->all ? "Friedman" : "Wilcoxon",
                         n,
                         t->all ? "-" : above,
                         t->all ? "-" : below,
                         ethd__number_text(t->statistic, 2, statistic),
                         ethd__p_text(t->p, p),
                         ethd__p_text(t->holm, holm),
                         NULL};
  ethd__html_row(&r->page, cells, 3);
  ethd_csv_integer(csv, (int64_t)t->question + 1);
  ethd_csv_word(csv, cells[2]);
  ethd_csv_word(csv, t->all ? "" : a->cell.law);
  ethd_csv_word(csv, t->all ? "" : b->cell.law);
  ethd_csv_word(csv, a->speed.word);
  ethd_csv_integer(csv, (int64_t)t->n);
  const double figures[] = {t->all ? NAN : (double)t->above, t->all ? NAN : (double)t->below, t->statistic, t->p,
                            t->holm};
  for (int i = 0; i < 5; i++) ethd_csv_number(csv, figures[i]);
  ethd_csv_row(csv);
}

/* Makes all tests of all questions and returns how many there are; with NULL it only counts them. */
static size_t make_tests(const ethd__report *r, const ethd__answers *answer, asked *out) {
  const ethd__data *data = &r->data;
  size_t n = 0;
  for (size_t q = 0; q < ethd__question_count(answer->asked); q++)
    for (size_t a = 0, end; !ethd__question_is_text(&answer->asked->question[q]) && a < data->group_count; a = end) {
      /* cells from a to end have the same speed */
      for (end = a; end < data->group_count && !strcmp(data->group[end].speed.word, data->group[a].speed.word);) end++;
      if (end - a > 2 && out) out[n] = compare_all(r, answer, q, a, end - 1);
      n += end - a > 2;
      for (size_t i = a; i < end; i++)
        for (size_t k = i + 1; k < end; k++, n++)
          if (out) out[n] = compare_two(r, answer, q, i, k);
    }
  return n;
}

ethd_status ethd__survey_tests(ethd__report *r, const ethd__answers *answer) {
  static const char *const header[] = {"question", "answers",         "test", "n",       "higher",
                                       "lower",    "W or chi square", "p",    "p, Holm", NULL};
  size_t n = make_tests(r, answer, NULL);
  asked *test = malloc((n + 1) * sizeof *test);
  double *p = malloc((n + 1) * sizeof *p);
  char *path = ethd__report_path(r, "survey-tests.csv");
  if (!test || !p) ethd__fail_memory();
  ethd_csv_out *csv = ethd_csv_create(
      path, "question,test,transition_a,transition_b,speed,n,higher,lower,statistic,p,p_holm", r->message);
  free(path);
  if (csv) {
    make_tests(r, answer, test);
    for (size_t i = 0; i < n; i++) p[i] = test[i].p;
    ethd__holm(p, n);
    ethd__html_table(&r->page,
                     "Answers compared within participants, by ranks. Family of Holm's correction: the p of this table",
                     header, 3);
    for (size_t i = 0; i < n; i++) test[i].holm = p[i], put_test(r, &test[i], csv);
    ethd__html_table_end(&r->page);
  }
  free(test);
  free(p);
  return csv ? ethd_csv_close(csv, r->message) : ETHD_E_FILE;
}
