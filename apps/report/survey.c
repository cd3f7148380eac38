#include "report/survey.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "text/csv.h"
#include "text/error_text.h"

/* ---- reading ---- */

/* A participant's place in the order of their names. */
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

static int column_of(const ethd__sheet *sheet, size_t question) {
  char name[24];
  snprintf(name, sizeof name, "q%zu", question + 1);
  return ethd__sheet_column(sheet, name);
}

/* Returns whose row it is; NULL if nobody who is analysed, or a cell without taps. */
static const survey_person *row_of(const ethd__report *r, size_t row, const survey_person *people, size_t *group) {
  const ethd__sheet *sheet = &r->table[ETHD_TABLE_SURVEY];
  const survey_person wanted = {ethd__sheet_cell(sheet, row, ethd__sheet_column(sheet, "participant")), 0};
  *group = group_of(&r->data, ethd__sheet_cell(sheet, row, ethd__sheet_column(sheet, "transition")),
                    ethd__sheet_cell(sheet, row, ethd__sheet_column(sheet, "speed")));
  if (*group == r->data.group_count) return NULL;
  return bsearch(&wanted, people, r->data.people_count, sizeof *people, by_id);
}

static ethd_status refuse(const ethd__report *r, size_t row, size_t question, size_t most) {
  const ethd__sheet *sheet = &r->table[ETHD_TABLE_SURVEY];
  const char *found = ethd__sheet_cell(sheet, row, column_of(sheet, question));
  char quote[ETHD_QUOTE_MAX];
  return ethd__say(r->message, ETHD_E_RANGE, "%s:%zu: q%zu: found %s, a whole number from 1 to %zu is allowed",
                   sheet->path, row + 2, question + 1, ethd__quote(found, strlen(found), quote), most);
}

static ethd_status take_row(ethd__report *r, size_t row, const survey_person *people, ethd__answers *out) {
  const ethd__sheet *sheet = &r->table[ETHD_TABLE_SURVEY];
  size_t g;
  const survey_person *who = row_of(r, row, people, &g);
  for (size_t q = 0; q < ethd__question_count(out->asked); q++) {
    const ethd__question *question = &out->asked->question[q];
    int column = column_of(sheet, q);
    size_t most = ethd__answer_count(question);
    double answer;
    if (ethd__question_is_text(question)) {
      out->given += who && *ethd__sheet_cell(sheet, row, column);
      continue;
    }
    bool number = ethd__sheet_number(sheet, row, column, &answer);
    if (number && isnan(answer)) continue;
    if (!number || !(answer >= 1 && answer <= (double)most && answer == floor(answer))) return refuse(r, row, q, most);
    if (!who) continue;
    out->of[g][q][who->person] = answer;
    out->given++;
  }
  return ETHD_OK;
}

static ethd_status take(ethd__report *r, const survey_person *people, ethd__answers *out) {
  for (size_t g = 0; g < r->data.group_count; g++)
    for (size_t q = 0; q < ETHD_STUDY_QUESTIONS; q++) {
      if (!(out->of[g][q] = malloc((r->data.people_count + 1) * sizeof(double)))) ethd__fail_memory();
      for (size_t p = 0; p < r->data.people_count; p++) out->of[g][q][p] = NAN;
    }
  ethd_status status = ETHD_OK;
  for (size_t row = 0; !status && row < r->table[ETHD_TABLE_SURVEY].rows; row++) status = take_row(r, row, people, out);
  return status;
}

static void release(ethd__answers *a) {
  for (size_t g = 0; g < ETHD_REPORT_CELLS; g++)
    for (size_t q = 0; q < ETHD_STUDY_QUESTIONS; q++) free(a->of[g][q]);
}

/* ---- counts ---- */

/* The file has as many columns of counts as the longest scale has answers. */
static size_t most_answers(const ethd__questionnaire *asked) {
  size_t most = 0;
  for (size_t q = 0; q < ethd__question_count(asked); q++) {
    size_t n = ethd__answer_count(&asked->question[q]);
    if (n > most) most = n;
  }
  return most;
}

static void put_counts(ethd__report *r, const ethd__answers *a, size_t g, size_t q, ethd_csv_out *csv) {
  const ethd__group *group = &r->data.group[g];
  size_t people = r->data.people_count, scale = ethd__answer_count(&a->asked->question[q]);
  size_t n = 0, count[ETHD_STUDY_ANSWERS] = {0};
  double *values = malloc((people + 1) * sizeof *values);
  ethd__summary5 s;
  if (!values) ethd__fail_memory();
  for (size_t p = 0; p < people; p++)
    if (!isnan(a->of[g][q][p])) values[n++] = a->of[g][q][p], count[(int)a->of[g][q][p] - 1]++;
  ethd__summarise(values, n, &s);
  free(values);
  char label[80], of[24], each[ETHD_STUDY_ANSWERS][24], median[32], quartiles[72], mean[48];
  const char *cells[ETHD_STUDY_ANSWERS + 6] = {ethd__group_label(group, label), of};
  snprintf(of, sizeof of, "%zu", n);
  ethd_csv_integer(csv, (int64_t)q + 1);
  ethd_csv_word(csv, group->cell.law);
  ethd_csv_word(csv, group->speed.word);
  ethd_csv_integer(csv, (int64_t)g + 1);
  ethd_csv_integer(csv, (int64_t)n);
  for (size_t k = 0; k < most_answers(a->asked); k++) {
    if (k < scale) snprintf(each[k], sizeof each[k], "%zu", count[k]);
    if (k < scale) cells[2 + k] = each[k];
    ethd_csv_number(csv, k < scale ? (double)count[k] : NAN);
  }
  cells[2 + scale] = ethd__number_text(s.median, 1, median);
  cells[3 + scale] = ethd__interval_text((ethd__interval){s.q1, s.q3, 0, 0}, 1, quartiles);
  cells[4 + scale] = ethd__mean_text(&s, 2, mean);
  const double figures[] = {s.median, s.q1, s.q3, s.mean, s.sd, (double)scale};
  for (int i = 0; i < 6; i++) ethd_csv_number(csv, figures[i]);
  ethd_csv_row(csv);
  ethd__html_row(&r->page, cells, 1);
}

static void put_question(ethd__report *r, const ethd__answers *a, size_t q, ethd_csv_out *csv) {
  const ethd__question *question = &a->asked->question[q];
  size_t scale = ethd__answer_count(question);
  char caption[1024], word[ETHD_STUDY_ANSWERS][320];
  const char *header[ETHD_STUDY_ANSWERS + 6] = {"cell", "n"};
  snprintf(caption, sizeof caption, "Q%zu: %s", q + 1, question->text);
  for (size_t k = 0; k < scale; k++) {
    char words[256];
    ethd__answer_words(question, (int)k + 1, words, sizeof words);
    snprintf(word[k], sizeof word[k], question->answers ? "%zu %s" : "%zu", k + 1, words);
    header[2 + k] = word[k];
  }
  header[2 + scale] = "median", header[3 + scale] = "quartiles", header[4 + scale] = "mean (sd)";
  ethd__html_table(&r->page, caption, header, 1);
  for (size_t g = 0; g < r->data.group_count; g++) put_counts(r, a, g, q, csv);
  ethd__html_table_end(&r->page);
}

static ethd_status counts(ethd__report *r, const ethd__answers *a) {
  char header[256] = "question,transition,speed,cell,n", *path = ethd__report_path(r, "survey-answers.csv");
  for (size_t k = 0; k < most_answers(a->asked); k++)
    snprintf(header + strlen(header), sizeof header - strlen(header), ",n%zu", k + 1);
  snprintf(header + strlen(header), sizeof header - strlen(header), ",median,q1,q3,mean,sd,answers");
  ethd_csv_out *csv = ethd_csv_create(path, header, r->message);
  free(path);
  if (!csv) return ETHD_E_FILE;
  ethd__html_markup(&r->page, "<p>How many participants gave each answer. Answers count as ordered, in the order in "
                              "which they were offered.</p>\n");
  for (size_t q = 0; q < ethd__question_count(a->asked); q++)
    if (!ethd__question_is_text(&a->asked->question[q])) put_question(r, a, q, csv);
  return ethd_csv_close(csv, r->message);
}

/* ---- words ---- */

static void put_texts(ethd__report *r, const survey_person *people, size_t q, const ethd__question *question) {
  static const char *const header[] = {"participant", "cell", "answer", NULL};
  const ethd__sheet *sheet = &r->table[ETHD_TABLE_SURVEY];
  char caption[1024];
  snprintf(caption, sizeof caption, "Q%zu: %s", q + 1, question->text);
  ethd__html_table(&r->page, caption, header, 3);
  for (size_t row = 0; row < sheet->rows; row++) {
    size_t g;
    const survey_person *who = row_of(r, row, people, &g);
    const char *words = ethd__sheet_cell(sheet, row, column_of(sheet, q));
    char label[80];
    if (!who || !*words) continue;
    ethd__html_row(&r->page, (const char *const[]){who->id, ethd__group_label(&r->data.group[g], label), words, NULL},
                   3);
  }
  ethd__html_table_end(&r->page);
}

/* ---- pictures ---- */

/* Shortens long words, between letters, and ends them with an ellipsis. */
static void clip(char words[256]) {
  size_t n = 32;
  if (strlen(words) <= n) return;
  while (n && (words[n] & 0xc0) == 0x80) n--;
  snprintf(words + n, 256 - n, "\u2026");
}

/* "1 very natural to 5 very unnatural" */
static const char *scale_of(const ethd__question *question, char out[600]) {
  char first[256] = "", last[256] = "";
  int count = (int)ethd__answer_count(question);
  if (question->answers) {
    ethd__answer_words(question, 1, first, sizeof first);
    ethd__answer_words(question, count, last, sizeof last);
  }
  clip(first), clip(last);
  snprintf(out, 600, "1 %s%sto %d %s", first, *first ? " " : "", count, last);
  return out;
}

static ethd_status draw(ethd__report *r, const ethd__answers *a, size_t q) {
  const ethd__question *question = &a->asked->question[q];
  char number[24], answers[24], scale[600], name[40], caption[200];
  snprintf(number, sizeof number, "%zu", q + 1);
  snprintf(answers, sizeof answers, "%zu", ethd__answer_count(question));
  snprintf(name, sizeof name, "survey-q%zu.png", q + 1);
  snprintf(caption, sizeof caption, "Q%zu: the answers by cell.%s", q + 1,
           a->asked->own ? "" : " Figure 18 of the paper has the means of its participants' answers.");
  const ethd__picture_value values[] = {{"in", "survey-answers.csv", true},
                                        {"question", number, false},
                                        {"answers", answers, false},
                                        {"scale", scale_of(question, scale), false},
                                        {NULL, NULL, false}};
  return ethd__report_picture(r, "report-survey.gp", name, caption, values);
}

/* ---- the section ---- */

static ethd_status with_answers(ethd__report *r, const ethd__answers *a, const survey_person *people) {
  size_t questions = ethd__question_count(a->asked), texts = 0;
  for (size_t q = 0; q < questions; q++) texts += ethd__question_is_text(&a->asked->question[q]);
  if (!a->asked->own)
    ethd__html_markup(&r->page, "<p>The questions are the paper's, in words of our own. The best answers are 3 (just "
                                "then), 3 (stood still) and 1 (very natural).</p>\n");
  ethd_status status = texts < questions ? counts(r, a) : ETHD_OK;
  for (size_t q = 0; !status && q < questions; q++)
    if (!ethd__question_is_text(&a->asked->question[q])) status = draw(r, a, q);
  if (!status && texts < questions) status = ethd__survey_tests(r, a);
  for (size_t q = 0; !status && q < questions; q++)
    if (ethd__question_is_text(&a->asked->question[q])) put_texts(r, people, q, &a->asked->question[q]);
  return status;
}

ethd_status ethd__report_survey(ethd__report *r) {
  ethd__answers a = {.asked = &r->folder->protocol.questionnaire};
  survey_person *people = sort_people(&r->data);
  ethd_status status = take(r, people, &a);
  ethd__html_heading(&r->page, "survey", "Survey");
  if (!status && a.given)
    status = with_answers(r, &a, people);
  else if (!status)
    ethd__html_print(&r->page, "<p>%s</p>\n",
                     r->folder->protocol.survey ? "Nobody has answered. Simulated participants feel nothing: their "
                                                  "answers are left empty, never made up."
                                                : "This study asked no questions.");
  release(&a);
  free(people);
  return status;
}
