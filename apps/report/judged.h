/* The sample by which the paper's sentences are judged: the taps beside the study where there are any, which are more,
   else the study's own. All [main]. */
#ifndef ETHD__APPS_REPORT_JUDGED_H
#define ETHD__APPS_REPORT_JUDGED_H

#include "report/report.h"

const ethd__data *ethd__judged_data(const ethd__report *report);

/* Returns the sample, whose cells are put into `cells`. */
ethd__sample ethd__judged_sample(const ethd__report *report, ethd__cell cells[ETHD_REPORT_CELLS]);

/* Returns "this study", or the name of the other one. */
const char *ethd__judged_name(const ethd__report *report);

/* Returns whether the sample was measured; taps beside the study count as simulated. */
bool ethd__judged_measured(const ethd__report *report);

#endif
