/* Fits the finger to touches: its mass, the hand's spring and damper, the pad. A touch is a window whose state holds
   the arm's state, the hand's voluntary path (a cubic of time in each axis) and the gap of that tap; the simulator
   predicts the encoders and the readings of the finger's centre. The path isn't measured apart from the finger's own
   motion, so it is fitted with the rest, and the intervals allow for what that leaves open. All [main]. */
#ifndef ETHD__APPS_IDENTIFY_TOUCH_FIT_H
#define ETHD__APPS_IDENTIFY_TOUCH_FIT_H

#include "identify/fit.h"
#include "identify/sensing.h"

#define ETHD__TOUCHES_LEAST 10

typedef struct ethd__touch_fit {
  size_t seen, used;   /* touches; those of them whose motion the model explains */
  double least, most;  /* s of a touch that are fitted, from the first reading that is near */
  double rms;          /* of the residual, in standard deviations of encoders and readings */
  bool explained;      /* else none of the finger's numbers is taken */
  ethd__bracket noise; /* m, of the readings; NaN: touches are too few */
  double simulated;    /* s, of the evaluations, */
  double seconds;      /* of the processor */
} ethd__touch_fit;

/* Fits the evidence's touches with the arm of fit->plant, and puts the finger's numbers, their intervals and what isn't
   seen into `fit`. Does nothing if there are fewer than ETHD__TOUCHES_LEAST. */
void ethd__touch_fit_run(const ethd__evidence *evidence, const ethd__sensing *sensing, ethd__fit *fit,
                         ethd__touch_fit *out);

#endif
