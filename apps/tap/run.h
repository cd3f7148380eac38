/* Runs the cells of a study, one after another. */
#ifndef ETHD__APPS_TAP_RUN_H
#define ETHD__APPS_TAP_RUN_H

#include "tap/output.h"

/* The plan: every law at each of the study's speeds, `taps` times. */
typedef struct ethd__tap_plan {
  const ethd__study *study;
  const char *const *laws;
  size_t law_count;
  uint64_t taps;
} ethd__tap_plan;

/* Makes room for plan->law_count * study->speed_count cells and their results; NULL: no memory. */
ethd__cell *ethd__cells_create(const ethd__tap_plan *plan);
void ethd__cells_free(ethd__cell *cells);

/* Refuses causes of failure of the first taps: unknown laws, setups that don't fit, a touch out of reach. */
ETHD_MUST_CHECK ethd_status ethd__plan_check(const ethd__tap_plan *plan, char message[ETHD_MESSAGE_MAX]);

/* Fills the cells, laws outermost. Ends early, with ETHD_OK, once ethd__stop is set. */
ETHD_MUST_CHECK ethd_status ethd__cells_run(const ethd__tap_plan *plan, ethd__output *output, ethd__cell *cells,
                                            char message[ETHD_MESSAGE_MAX]);

/* Writes folder/LAW-SPEED.csv for every cell that has taps: its typical tap, run again. */
ETHD_MUST_CHECK ethd_status ethd__cells_trace(const ethd__tap_plan *plan, const char *folder, const ethd__cell *cells,
                                              char message[ETHD_MESSAGE_MAX]);

#endif
