/* The report of a study: tables, pictures, a page. All [main]. */
#ifndef ETHD_REPORT_REPORT_H
#define ETHD_REPORT_REPORT_H

#include <stdio.h>

#include "report/data.h"
#include "report/html.h"
#include "report/picture.h"
#include "report/stats.h"
#include "study/folder.h"

typedef struct ethd__report {
  ethd__folder *folder;
  const char *out; /* folder of pictures and CSV files */
  ethd__data data;
  ethd__data beside; /* taps of another folder, group_count 0: none */
  const char *beside_name;
  const char *tap; /* a recording whose traces are drawn, NULL: the typical one of each cell */
  size_t point;
  uint64_t seed; /* of the bootstrap */
  ethd__html page;
  char *message;
} ethd__report;

/* People's fingers on a device that isn't the simulated one: its figures were measured, nothing was fitted. */
bool ethd__report_measured(const ethd__report *report);

/* out/name; exit 1 without memory. */
char *ethd__report_path(const ethd__report *report, const char *name);

/* Draws NAME with a script that came with the programs, and puts it on the page. values: the script's but for `out`,
   ended by a NULL name; files by their names in report->out. */
ETHD_MUST_CHECK ethd_status ethd__report_picture(ethd__report *report, const char *script, const char *name,
                                                 const char *caption, const ethd__picture_value *values);

/* "smooth, low" and the like. */
const char *ethd__group_label(const ethd__group *group, char out[80]);

/* "12.3 (4.5)", "12.3" of one, "-" of none. */
const char *ethd__mean_text(const ethd__summary5 *s, int digits, char out[48]);
const char *ethd__number_text(double value, int digits, char out[32]);

/* Values of a group, summed up. */
void ethd__group_summary(const ethd__group *group, const ethd__quantity *quantity, ethd__summary5 *out);

/* Each writes its CSV files and pictures, and its part of the page. */
ETHD_MUST_CHECK ethd_status ethd__report_table1(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_boxes(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_traces(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_reasons(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_survey(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_pairs(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_grid(ethd__report *report);
void ethd__report_methods(ethd__report *report);

#endif
