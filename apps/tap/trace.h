/* A tap's ticks as a table for plots: depths behind the wall, speeds along n. */
#ifndef ETHD__APPS_TAP_TRACE_H
#define ETHD__APPS_TAP_TRACE_H

#include "tap/metrics.h"

/* Data for the conversion of ticks to depths. */
typedef struct ethd__view {
  ethd__rule rule;
  double wall;                       /* m: of the wall along n */
  double ring_radius, finger_radius; /* m */
} ethd__view;

/* Writes the table. Its time counts from t_r/vo; depths are those of the ring's front, the finger and the hand along n,
   from the wall into it. [main] */
ETHD_MUST_CHECK ethd_status ethd__trace_write(const char *path, const ethd__view *view, const ethd__tap_rows *rows,
                                              char message[ETHD_MESSAGE_MAX]);

#endif
