/* The report of a study: tables, pictures, a page. All [main]. */
#ifndef ETHD__APPS_REPORT_REPORT_H
#define ETHD__APPS_REPORT_REPORT_H

#include <stdio.h>

#include "report/data.h"
#include "report/gather.h"
#include "report/html.h"
#include "report/picture.h"
#include "study/folder.h"
#include "tap/claims.h"

/* Who led the hand in a tap. */
typedef enum ethd__leader {
  ETHD_LED_DEVICE,    /* a person's finger in the device's ring */
  ETHD_LED_MOUSE,     /* a person, who led the simulated device's hand */
  ETHD_LED_RECORDED,  /* a recorded movement */
  ETHD_LED_SIMULATED, /* the plant's synthetic hand */
  ETHD_LED_KINDS
} ethd__leader;

/* Results, counted for the page's head. */
typedef struct ethd__report_counts {
  size_t differences, significant;   /* of strategies, p < 0.05 after Holm's correction */
  size_t verdict[ETHD_TAP_VERDICTS]; /* of the paper's sentences */
} ethd__report_counts;

typedef struct ethd__report {
  ethd__folder *folder;           /* the first station's */
  ethd__stations stations;        /* where the taps stand: one folder or several */
  ethd__sheet table[ETHD_TABLES]; /* the study's; taps are in `data` */
  const char *out;                /* folder of pictures and CSV files */
  ethd__data data;
  ethd__data beside; /* taps of another folder, group_count 0: none */
  const char *beside_name;
  const char *tap; /* a recording whose traces are drawn, NULL: the typical one of each cell */
  size_t point;
  uint64_t seed;              /* of the bootstrap */
  size_t led[ETHD_LED_KINDS]; /* test taps */
  ethd__report_counts counts;
  ethd__html page;
  char *message;
} ethd__report;

/* Fills report->led: by the taps' column `hand`, and where the table has none by what the study asked for. */
void ethd__report_led(ethd__report *report);

/* Returns whether the hand was led so in all of the taps. */
bool ethd__report_only(const ethd__report *report, ethd__leader led);

/* Returns a sentence that says what p values and intervals are about: people, or the assumptions of a simulation. */
const char *ethd__report_caveat(const ethd__report *report);

/* Returns whether people's fingers tapped on a real device, so that figures were measured and nothing was fitted. */
bool ethd__report_measured(const ethd__report *report);

/* Returns out/name, which the caller frees; exit 1 without memory. */
char *ethd__report_path(const ethd__report *report, const char *name);

/* Draws NAME with a script that came with the programs, and puts it on the page. values: the script's but for `out`,
   ended by a NULL name; files by their names in report->out. */
ETHD_MUST_CHECK ethd_status ethd__report_picture(ethd__report *report, const char *script, const char *name,
                                                 const char *caption, const ethd__picture_value *values);

/* Writes "smooth, low" and the like. */
const char *ethd__group_label(const ethd__group *group, char out[80]);

/* Writes "12.3 (4.5)"; of one value "12.3", of none "-". */
const char *ethd__mean_text(const ethd__summary5 *s, int digits, char out[48]);
const char *ethd__number_text(double value, int digits, char out[32]);

/* Summarises the values of a group. */
void ethd__group_summary(const ethd__group *group, const ethd__quantity *quantity, ethd__summary5 *out);

/* Writes "1.2 to 3.4", or "-" if there is no interval. */
const char *ethd__interval_text(ethd__interval interval, int digits, char out[72]);
/* Writes "0.0312", "< 0.0001", or "-" if no test was made. */
const char *ethd__p_text(double p, char out[32]);

/* Returns how far strategies may differ in this quantity, in its unit, and still be called alike; NaN: there is no
   margin. */
double ethd__report_margin(const ethd__report *report, int quantity);

/* Returns the number of test taps; *valid becomes that of the valid ones. */
size_t ethd__data_taps(const ethd__data *data, size_t *valid);

/* Each writes its CSV files and pictures, and its part of the page. */
void ethd__report_origin(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_table1(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_claims(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_boxes(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_summary(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_traces(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_encounter(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_reasons(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_validity(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_forces(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_survey(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_pairs(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_interaction(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_tidy(ethd__report *report);
ETHD_MUST_CHECK ethd_status ethd__report_grid(ethd__report *report);
void ethd__report_methods(ethd__report *report);

#endif
