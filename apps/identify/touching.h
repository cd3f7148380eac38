/* The arm with the finger that touches it, as the subject of a fit. All [main]. */
#ifndef ETHD__APPS_IDENTIFY_TOUCHING_H
#define ETHD__APPS_IDENTIFY_TOUCHING_H

#include "identify/sensing.h"
#include "identify/shooting.h"

/* Where a touch's state has what: the arm's four numbers; position, speed, acceleration and jerk of the voluntary path
   (x, y each); the gap of ring and finger, m; where the transmission gives way the links' lead. */
enum { ETHD__TOUCH_PATH = 4, ETHD__TOUCH_GAP = 12, ETHD__TOUCH_LEAD = 13, ETHD__TOUCH_STATES = 17 };

/* Opens a problem with a window for each of the evidence's touches, at most `most`. A window ends `after` s after the
   first reading that is near, and has a first guess at its state. The residuals are in standard deviations of encoders
   and readings, which follow from shooting->plant's count and noise. tolerance: the simulator's, m/s. */
void ethd__touching_open(const ethd__evidence *evidence, double after, size_t most, double tolerance,
                         ethd__shooting *out);

/* Lets window i end `after` s after the first reading that is near; call ethd__shooting_ready after it. */
void ethd__touching_end(ethd__shooting *shooting, size_t i, double after);

/* Finds the states for shooting->plant from the first guesses on: first of short windows, in which the finger hardly
   presses, then of longer ones. A guess that is far off would press so hard that nothing leads back. In the end all
   windows end `after` s after the first reading that is near, and are to be settled. */
void ethd__touching_approach(ethd__shooting *shooting, double after);

/* Returns the noise of the readings, m, by the residuals of settled windows; NaN where they are too few. */
ethd__bracket ethd__touching_noise(const ethd__shooting *shooting);

#endif
