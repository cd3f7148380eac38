/* The answers of a study's questionnaire. All [main]. */
#ifndef ETHD__APPS_REPORT_SURVEY_H
#define ETHD__APPS_REPORT_SURVEY_H

#include "report/report.h"

/* Answers by cell, question and participant, all in the order of report->data; NaN: none was given, or the question
   asks for words. */
typedef struct ethd__answers {
  const ethd__questionnaire *asked;
  double *of[ETHD_REPORT_CELLS][ETHD_STUDY_QUESTIONS];
  size_t given;
} ethd__answers;

/* Writes the table of tests within participants and its file survey-tests.csv: for each question with numbered answers,
   each two strategies at a speed (Wilcoxon), and all of them together if there are more (Friedman). */
ETHD_MUST_CHECK ethd_status ethd__survey_tests(ethd__report *report, const ethd__answers *answers);

#endif
