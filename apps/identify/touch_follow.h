/* How far touches follow the model. The longer a touch, the more it shows; but a hand that brakes or turns back doesn't
   move on a cubic. So each touch is followed as far as what is added to it is explained, less a while in which braking
   that began wouldn't show yet. All [main]. */
#ifndef ETHD__APPS_IDENTIFY_TOUCH_FOLLOW_H
#define ETHD__APPS_IDENTIFY_TOUCH_FOLLOW_H

#include "identify/shooting.h"

#define ETHD__TOUCH_SHORTEST 0.015 /* s after the first reading that is near, at which the first fit ends */

enum { ETHD__TOUCHES_MOST = 64 /* touches of a fit, and */, ETHD__TOUCH_EVALUATIONS = 40 /* its evaluations */ };

/* Fills the sum of squares that is left of each touch. */
void ethd__touch_squares(ethd__shooting *touches, double *squares);

/* Fits at most ETHD__TOUCHES_MOST touches, which end ETHD__TOUCH_SHORTEST after their first reading that is near,
   then longer and longer ones, and takes out those that are strange from their beginning on. Returns the sum of squares
   that is left. */
double ethd__touch_follow(ethd__shooting *touches);

#endif
