/* Motion and contact of the finger, by the same rule for every law.

        hand's path      touch plane                 depth   how far the ring is behind the wall at the touch
          o-----------------|-->  v_hand             early   touched before the ring was behind the wall, or within
       ring  ( o  )         |//// wall                       ETHD_TAP_NEAR of it and slower than ETHD_TAP_STILL */
#ifndef ETHD__APPS_TAP_FELT_H
#define ETHD__APPS_TAP_FELT_H

#include "tap/metrics.h"

#define ETHD_TAP_FELT 0.06    /* s after the touch at which the wall's offset counts as felt */
#define ETHD_TAP_CARRIED 0.02 /* s before the touch: window of a device's finger's mean speed */
#define ETHD_TAP_NEAR 0.3e-3  /* m */
#define ETHD_TAP_STILL 0.02   /* m/s: the paper's v_th */

typedef struct ethd__felt {
  double v_hand; /* m/s of the hand's path at the plane where a finger touches; NaN: it doesn't cross it */
  double depth;  /* m, of the true ring at the touch; NaN: no touch */
  double eps;    /* m: the wall's offset ETHD_TAP_FELT after it; NaN: no wall */
  bool early;    /* true without a touch */
} ethd__felt;

/* Returns the figures of a tap. begin: the tap's first tick; touch: the first with the pad touching, rows->count: there
   is none. */
ethd__felt ethd__felt_of(const ethd__tap_rows *rows, const ethd__rule *rule, size_t begin, size_t touch);

#endif
