/* The arm with the finger that touches it, as the subject of a fit. All [main]. */
#ifndef ETHD_APPS_IDENTIFY_TOUCHING_H
#define ETHD_APPS_IDENTIFY_TOUCHING_H

#include "identify/sensing.h"
#include "identify/shooting.h"

/* Where a touch's state has what: the arm's four numbers; position, speed, acceleration and jerk of the voluntary path
   (x, y each); the gap of ring and finger, m; where the transmission gives way the links' lead. */
enum { ETHD__TOUCH_PATH = 4, ETHD__TOUCH_GAP = 12, ETHD__TOUCH_LEAD = 13, ETHD__TOUCH_STATES = 17 };

/* Opens a problem with a window for each of the evidence's touches, at most `most`. A window ends `after` s after the
   first reading that is near, and has a first guess at its state. The residuals are in standard deviations of encoders
   and readings, which follow from shooting->plant's count and noise. */
void ethd__touching_open(const ethd__evidence *evidence, double after, size_t most, ethd__shooting *out);

#endif
