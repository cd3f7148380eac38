/* Judges the residual of a fit: is it as small as the encoders allow, and is it white? All [main]. */
#ifndef ETHD__APPS_IDENTIFY_RESIDUAL_H
#define ETHD__APPS_IDENTIFY_RESIDUAL_H

#include "identify/shooting.h"

enum { ETHD__LAGS = 20, ETHD__TONES = 257 };

typedef struct ethd__whiteness {
  double rms, floor; /* rad; floor: residual of rounding to counts, 0 for ideal encoders */
  double correlation[ETHD__LAGS +
                     1]; /* of residuals at this lag, ticks, where the arm moves by a count or more in each tick */
  double bound;          /* 95 % of a white residual's correlations lie within +- this */
  int outside, largest;  /* number of lags outside; lag of the largest correlation */
  size_t ticks;          /* ticks with such motion */
  double density[ETHD__TONES]; /* rad^2/Hz from 0 to half the sampling rate */
  int tones;
  bool explained; /* neither larger nor less white than rounding makes it */
} ethd__whiteness;

/* Judges the settled windows at the problem's plant. Fills `residual`, shooting->rows numbers. */
void ethd__whiteness_find(ethd__shooting *shooting, double count, double *residual, ethd__whiteness *out);

#endif
