/* Detects a common drift of the sensors: by light, dirt or heat all of them count more or less than at their
   calibration. Every distance is then wrong, and no ray is off the others' circle. But an offset of the counts moves
   the far distances more than the near ones, so the points of a finger beside the ring's middle no longer lie on a
   circle. The offset that puts them on a circle again is fitted over a window of frames. The finger only has to be
   round. */
#ifndef ETHD__PROXIMITY_RING_DRIFT_H
#define ETHD__PROXIMITY_RING_DRIFT_H

#include <stdbool.h>

#include "proximity_ring/calibration.h"
#include "proximity_ring/decoder.h"

enum { ETHD__DRIFT_FRAMES = 150 }; /* half a second */

/* Initially all zero but the first part, which ethd__drift_prepare fills; all zero: it watches nothing. */
typedef struct ethd__drift {
  ethd_fit fit; /* with a free radius */
  ethd_vec direction[ETHD_RAYS];

  double across, along, beside; /* of the window so far: sums of e g, g g and e e, see drift.c */
  double grows;                 /* m per count: sum of the radius's changes */
  uint32_t frames;
  double offset; /* m: error of the last window's radius, > 0 too large; 0: not known */
  bool is_off;   /* the offset is a drift */
} ethd__drift;

/* Prepares the first part; ring_radius and finger_radius in m. [main] */
ETHD_MUST_CHECK ethd_status ethd__drift_prepare(double ring_radius, double finger_radius, ethd__drift *out,
                                                ethd_error *error);

/* Adds a good frame with its rays, m; NaN rays don't count. [rt] */
void ethd__drift_step(ethd__drift *drift, const ethd__calibration *calibration, const ethd__ring_frame *frame,
                      const double rays[ETHD_RAYS]) ETHD_RT;

#endif
