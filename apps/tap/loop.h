/* Runs a tap, tick by tick. */
#ifndef ETHD__APPS_TAP_LOOP_H
#define ETHD__APPS_TAP_LOOP_H

#include "tap/metrics.h"

#define ETHD_TAP_AFTER 0.15 /* s from t_r/vo to the end of a tap */
#define ETHD_TAP_LOST 0.3   /* s from the end of the path, if the ring hasn't met a wall */

/* Resets the controller except its law's memory `learned` (ETHD_MEMORY numbers), starts `tap` and steps to its end;
   rows hold its ticks, the first at time 0. ETHD_E_MEMORY, or the error of ethd_sim_start; the controller's faults are
   in the rows and don't end the tap. */
ETHD_MUST_CHECK ethd_status ethd__tap_run(ethd_sim *sim, ethd_control *control, const ethd_sim_tap *tap,
                                          const double *learned, const ethd__rule *rule, ethd__tap_rows *rows);

/* A tap that is run one tick at a time, so that the caller can lead the finger meanwhile. Rule and rows outlive it. */
typedef struct ethd__tapping {
  ethd_sim *sim;
  ethd_control *control;
  const ethd__rule *rule;
  ethd__tap_rows *rows;
  ethd__approach approach;
  size_t last; /* the last tick known so far */
} ethd__tapping;

ETHD_MUST_CHECK ethd_status ethd__tapping_begin(ethd_sim *sim, ethd_control *control, const ethd_sim_tap *tap,
                                                const ethd__rule *rule, ethd__tap_rows *rows, ethd__tapping *out);

/* Runs one tick; ETHD_STATUS_EMPTY: the tap is over. */
ETHD_MUST_CHECK ethd_status ethd__tapping_step(ethd__tapping *tapping);

/* Makes room for one more row. ETHD_E_MEMORY. */
ETHD_MUST_CHECK ethd_status ethd__tap_rows_room(ethd__tap_rows *rows);

void ethd__tap_rows_free(ethd__tap_rows *rows);

#endif
