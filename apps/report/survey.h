/* The answers of a study's questionnaire. All [main]. */
#ifndef ETHD_REPORT_SURVEY_H
#define ETHD_REPORT_SURVEY_H

#include "report/report.h"

/* Answers by cell, question and participant, all in the order of report->data; NaN: none was given, or the question
   asks for words. */
typedef struct ethd__answers {
  const ethd__questionnaire *asked;
  double *of[ETHD_REPORT_CELLS][ETHD_STUDY_QUESTIONS];
  size_t given;
} ethd__answers;

/* The table of tests within participants, with its file survey-tests.csv: each question with numbered answers, each two
   strategies at a speed (Wilcoxon), and all of them where there are more (Friedman). */
ETHD_MUST_CHECK ethd_status ethd__survey_tests(ethd__report *report, const ethd__answers *answers);

#endif
