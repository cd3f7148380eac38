#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "report/report.h"
#include "statistics/paired.h"
#include "study/dictionary.h"
#include "text/csv.h"
#include "text/error_text.h"

enum { QUESTIONS = 3, STEPS = 5 };

/* Answers of a cell to a question, by participant as in the taps; NaN: none was given. */
typedef struct answers {
  double *of[ETHD_REPORT_CELLS][QUESTIONS];
  size_t given;
} answers;

/* The participants in the order of their names. */
typedef struct survey_person {
  const char *id;
  size_t person;
} survey_person;

static int by_id(const void *a, const void *b) {
  return strcmp(((const survey_person *)a)->id, ((const survey_person *)b)->id);
}

static survey_person *sort_people(const ethd__data *data) {
  survey_person *out = malloc((data->people_count + 1) * sizeof *out);
  if (!out) ethd__fail_memory();
  for (size_t p = 0; p < data->people_count; p++) out[p] = (survey_person){data->people[p], p};
  qsort(out, data->people_count, sizeof *out, by_id);
  return out;
}

static size_t group_of(const ethd__data *data, const char *law, const char *speed) {
  size_t g = 0;
  while (g < data->group_count && (strcmp(data->group[g].cell.law, law) || strcmp(data->group[g].speed.word, speed)))
    g++;
  return g;
}

/* False: a cell that holds no answer from 1 to 5, and isn't empty either. */
static bool take_row(const ethd__report *r, const ethd__sheet *sheet, size_t row, const survey_person *people,
                     answers *out) {
  static const char *const names[QUESTIONS] = {"q1", "q2", "q3"};
  const survey_person wanted = {ethd__sheet_cell(sheet, row, ethd__sheet_column(sheet, "participant")), 0};
  const survey_person *who = bsearch(&wanted, people, r->data.people_count, sizeof *people, by_id);
  size_t g = group_of(&r->data, ethd__sheet_cell(sheet, row, ethd__sheet_column(sheet, "transition")),
                      ethd__sheet_cell(sheet, row, ethd__sheet_column(sheet, "speed")));
  for (int q = 0; q < QUESTIONS; q++) {
    double answer;
    if (!ethd__sheet_number(sheet, row, ethd__sheet_column(sheet, names[q]), &answer)) return false;
    if (isnan(answer)) continue;
    if (!(answer >= 1 && answer <= STEPS && answer == floor(answer))) return false;
    if (!who || g == r->data.group_count) continue;
    out->of[g][q][who->person] = answer;
    out->given++;
  }
  return true;
}

static ethd_status take(ethd__report *r, const ethd__sheet *sheet, answers *out) {
  size_t people = r->data.people_count;
  for (size_t g = 0; g < r->data.group_count; g++)
    for (int q = 0; q < QUESTIONS; q++) {
      if (!(out->of[g][q] = malloc((people + 1) * sizeof(double)))) ethd__fail_memory();
      for (size_t p = 0; p < people; p++) out->of[g][q][p] = NAN;
    }
  survey_person *order = sort_people(&r->data);
  size_t row = 0;
  while (row < sheet->rows && take_row(r, sheet, row, order, out)) row++;
  free(order);
  if (row == sheet->rows) return ETHD_OK;
  return ethd__say(r->message, ETHD_E_RANGE, "%s:%zu: an answer that is no whole number from 1 to %d", sheet->path,
                   row + 2, STEPS);
}

static void release(answers *a) {
  for (size_t g = 0; g < ETHD_REPORT_CELLS; g++)
    for (int q = 0; q < QUESTIONS; q++) free(a->of[g][q]);
}

/* ---- counts ---- */

static void put_counts(ethd__report *r, const answers *a, size_t g, int q, ethd_csv_out *csv) {
  const ethd__group *group = &r->data.group[g];
  size_t people = r->data.people_count, n = 0, count[STEPS] = {0};
  double *values = malloc((people + 1) * sizeof *values);
  ethd__summary5 s;
  if (!values) ethd__fail_memory();
  for (size_t p = 0; p < people; p++)
    if (!isnan(a->of[g][q][p])) values[n++] = a->of[g][q][p], count[(int)a->of[g][q][p] - 1]++;
  ethd__summarise(values, n, &s);
  free(values);
  char question[16], label[80], of[24], each[STEPS][24], median[32], quartiles[72], mean[48];
  const char *cells[STEPS + 7] = {question, ethd__group_label(group, label), of};
  snprintf(question, sizeof question, "Q%d", q + 1);
  snprintf(of, sizeof of, "%zu", n);
  ethd_csv_integer(csv, q + 1);
  ethd_csv_word(csv, group->cell.law);
  ethd_csv_word(csv, group->speed.word);
  ethd_csv_integer(csv, (int64_t)g + 1);
  ethd_csv_integer(csv, (int64_t)n);
  for (int k = 0; k < STEPS; k++) {
    snprintf(each[k], sizeof each[k], "%zu", count[k]);
    cells[3 + k] = each[k];
    ethd_csv_integer(csv, (int64_t)count[k]);
  }
  cells[3 + STEPS] = ethd__number_text(s.median, 1, median);
  cells[4 + STEPS] = ethd__interval_text((ethd__interval){s.q1, s.q3, 0, 0}, 1, quartiles);
  cells[5 + STEPS] = ethd__mean_text(&s, 2, mean);
  const double figures[] = {s.median, s.q1, s.q3, s.mean, s.sd};
  for (int i = 0; i < 5; i++) ethd_csv_number(csv, figures[i]);
  ethd_csv_row(csv);
  ethd__html_row(&r->page, cells, 2);
}

static ethd_status counts(ethd__report *r, const answers *a) {
  static const char *const header[] = {"question", "cell", "n",      "1",         "2",         "3",
                                       "4",        "5",    "median", "quartiles", "mean (sd)", NULL};
  char *path = ethd__report_path(r, "survey-answers.csv");
  ethd_csv_out *csv =
      ethd_csv_create(path, "question,transition,speed,cell,n,n1,n2,n3,n4,n5,median,q1,q3,mean,sd", r->message);
  free(path);
  if (!csv) return ETHD_E_FILE;
  ethd__html_markup(&r->page, "<ol>\n");
  for (int q = 0; q < QUESTIONS; q++) ethd__html_print(&r->page, "<li>%s</li>\n", ethd__questions[q]);
  ethd__html_markup(&r->page, "</ol>\n");
  ethd__html_table(&r->page, "Answers: how many gave each; the paper shows their means (figure 18)", header, 2);
  for (int q = 0; q < QUESTIONS; q++)
    for (size_t g = 0; g < r->data.group_count; g++) put_counts(r, a, g, q, csv);
  ethd__html_table_end(&r->page);
  return ethd_csv_close(csv, r->message);
}

/* ---- tests ---- */

/* A comparison of two strategies (b < 0: of all at that speed) by those who answered under all of them. */
typedef struct asked {
  int question;
  size_t a, b, n, above, below;
  bool all;
  double statistic, p, holm;
} asked;

static asked compare_two(const ethd__report *r, const answers *answer, int q, size_t a, size_t b) {
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

/* Cells a to b, of one speed. */
static asked compare_all(const ethd__report *r, const answers *answer, int q, size_t a, size_t b) {
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
  snprintf(question, sizeof question, "Q%d", t->question + 1);
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
  ethd_csv_integer(csv, t->question + 1);
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

/* All tests of all questions; how many. NULL: counts them alone. */
static size_t make_tests(const ethd__report *r, const answers *answer, asked *out) {
  const ethd__data *data = &r->data;
  size_t n = 0;
  for (int q = 0; q < QUESTIONS; q++)
    for (size_t a = 0, end; a < data->group_count; a = end) { /* a to end: one speed */
      for (end = a; end < data->group_count && !strcmp(data->group[end].speed.word, data->group[a].speed.word);) end++;
      if (end - a > 2 && out) out[n] = compare_all(r, answer, q, a, end - 1);
      n += end - a > 2;
      for (size_t i = a; i < end; i++)
        for (size_t k = i + 1; k < end; k++, n++)
          if (out) out[n] = compare_two(r, answer, q, i, k);
    }
  return n;
}

static ethd_status tests(ethd__report *r, const answers *answer) {
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

/* ---- the section ---- */

static ethd_status with_answers(ethd__report *r, const answers *a) {
  ethd_status status = counts(r, a);
  if (!status) status = tests(r, a);
  if (status) return status;
  static const ethd__picture_value values[] = {
      {"in", "survey-answers.csv", true},
      {"note", "shares of the answers 1 to 5, each in its piece of the bar", false},
      {NULL, NULL, false}};
  return ethd__report_picture(r, "report-survey.gp", "survey.png",
                              "The answers by cell. Figure 18 of the paper has their means.", values);
}

ethd_status ethd__report_survey(ethd__report *r) {
  ethd__sheet sheet;
  answers a = {.given = 0};
  ethd_status status = ethd__gather(&r->stations, ETHD_STUDY_SURVEY, &sheet, r->message);
  if (!status) status = take(r, &sheet, &a);
  ethd__html_heading(&r->page, "survey", "Survey");
  if (!status && a.given)
    status = with_answers(r, &a);
  else if (!status)
    ethd__html_markup(
        &r->page,
        "<p>Nobody has answered. Simulated participants feel nothing: their answers are left empty, never made "
        "up.</p>\n");
  release(&a);
  ethd__sheet_free(&sheet);
  return status;
}
