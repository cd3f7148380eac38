/* Plays touches by the simulator: an arm and a finger from a window's state on, beside what encoders and readings
   showed. All [main]. */
#ifndef ETHD__APPS_IDENTIFY_TOUCH_PLAY_H
#define ETHD__APPS_IDENTIFY_TOUCH_PLAY_H

#include "identify/touching.h"

#define ETHD__TOUCH_READINGS 96 /* of a touch, at most */

/* A reading that was taken within the window, at t, s after its first tick. */
typedef struct ethd__touch_reading {
  double t;
  ethd_vec centre, finger;
} ethd__touch_reading;

/* Fills the readings of the first `ticks` ticks of a touch, and returns how many there are. */
int ethd__touch_samples(const ethd__evidence *evidence, const ethd__onset *onset, int ticks,
                        ethd__touch_reading out[ETHD__TOUCH_READINGS]);

/* Returns the touch that a window holds, NULL if it holds none. */
const ethd__onset *ethd__touch_onset(const ethd__evidence *evidence, const ethd__fit_window *window);

/* The subject's try_all: fills each trial's residuals, in standard deviations of encoders and readings. */
void ethd__touch_try_all(const ethd__shooting *shooting, const ethd__fit_window *window, const ethd__trial *trials,
                         int count);

#endif
