/* What ethd-check says about a valid configuration. */
#ifndef ETHD_CHECK_REPORT_H
#define ETHD_CHECK_REPORT_H

#include "ethd/config.h"

/* The setup as it was understood, as a configuration that gives the same setup again. */
void ethd__report_setup(const ethd_config *config);

typedef struct ethd__bounds {
  const ethd_config *config;
  int delay;    /* whole ticks from measurement to force */
  double count; /* rad per encoder count at the joint, NaN: unknown */
} ethd__bounds;

/* Stability bounds of the gains, in words and numbers; returns how many are exceeded. */
int ethd__report_bounds(const ethd__bounds *bounds);

#endif
