#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "report/report.h"
#include "study/dictionary.h"
#include "text/csv.h"

#define STEPS 5

typedef struct answers {
  double sum[3];
  size_t n; /* participants who answered all three */
} answers;

static bool read_row(const ethd__sheet *sheet, size_t row, double answer[3]) {
  static const char *const names[3] = {"q1", "q2", "q3"};
  for (int q = 0; q < 3; q++)
    if (!ethd__sheet_number(sheet, row, ethd__sheet_column(sheet, names[q]), &answer[q]) ||
        !(answer[q] >= 1 && answer[q] <= STEPS))
      return false;
  return true;
}

static answers of_group(const ethd__sheet *sheet, const ethd__group *group) {
  answers a = {.n = 0};
  int law = ethd__sheet_column(sheet, "transition"), speed = ethd__sheet_column(sheet, "speed");
  for (size_t row = 0; row < sheet->rows; row++) {
    double answer[3];
    if (strcmp(ethd__sheet_cell(sheet, row, law), group->cell.law) ||
        strcmp(ethd__sheet_cell(sheet, row, speed), group->speed.word) || !read_row(sheet, row, answer))
      continue;
    for (int q = 0; q < 3; q++) a.sum[q] += answer[q];
    a.n++;
  }
  return a;
}

static void write_row(ethd__report *r, const ethd__group *group, const answers *a, ethd_csv_out *csv) {
  char label[80], n[24], mean[3][32];
  snprintf(n, sizeof n, "%zu", a->n);
  ethd_csv_word(csv, group->cell.law);
  ethd_csv_word(csv, group->speed.word);
  ethd_csv_integer(csv, (int64_t)a->n);
  for (int q = 0; q < 3; q++) {
    double value = a->n ? a->sum[q] / (double)a->n : NAN;
    ethd__number_text(value, 2, mean[q]);
    ethd_csv_number(csv, value);
  }
  ethd_csv_row(csv);
  const char *cells[] = {ethd__group_label(group, label), n, mean[0], mean[1], mean[2], NULL};
  ethd__html_row(&r->page, cells, 1);
}

static ethd_status with_answers(ethd__report *r, const ethd__sheet *sheet) {
  static const char *const header[] = {"cell", "n", "Q1", "Q2", "Q3", NULL};
  char *path = ethd__report_path(r, "survey-means.csv");
  ethd_csv_out *csv = ethd_csv_create(path, "transition,speed,n,q1,q2,q3", r->message);
  ethd_status status = csv ? ETHD_OK : ETHD_E_FILE;
  if (csv) {
    ethd__html_markup(&r->page, "<ol>\n");
    for (int q = 0; q < 3; q++) {
      ethd__html_markup(&r->page, "<li>");
      ethd__html_text(&r->page, ethd__questions[q]);
      ethd__html_markup(&r->page, "</li>\n");
    }
    ethd__html_markup(&r->page, "</ol>\n");
    ethd__html_table(&r->page, "Mean answers, of participants who answered", header, 1);
    for (size_t i = 0; i < r->data.group_count; i++) {
      answers a = of_group(sheet, &r->data.group[i]);
      write_row(r, &r->data.group[i], &a, csv);
    }
    ethd__html_table_end(&r->page);
    status = ethd_csv_close(csv, r->message);
  }
  free(path);
  if (status) return status;
  static const ethd__picture_value values[] = {
      {"in", "survey-means.csv", true}, {"note", "dashed: the ideal answer", false}, {NULL, NULL, false}};
  return ethd__report_picture(r, "report-survey.gp", "survey.png", "As figure 18 of the paper: mean answers by cell.",
                              values);
}

ethd_status ethd__report_survey(ethd__report *r) {
  char *path = ethd__folder_path(r->folder->path, ETHD_STUDY_SURVEY);
  ethd__sheet sheet = {0};
  size_t given = 0;
  ethd_status status = access(path, F_OK) == 0 ? ethd__sheet_read(path, &sheet, r->message) : ETHD_OK;
  free(path);
  if (status) return status;
  for (size_t i = 0; i < r->data.group_count; i++) given += of_group(&sheet, &r->data.group[i]).n;
  ethd__html_heading(&r->page, "survey", "Survey");
  if (given)
    status = with_answers(r, &sheet);
  else
    ethd__html_markup(
        &r->page,
        "<p>Nobody has answered. Simulated participants feel nothing: their answers are left empty, never made "
        "up.</p>\n");
  ethd__sheet_free(&sheet);
  return status;
}
