/* Checks that the ring is empty, and uses the sensors' counts as today's darks. */
#ifndef ETHD__PROXIMITY_RING_EMPTY_H
#define ETHD__PROXIMITY_RING_EMPTY_H

#include "proximity_ring/calibration.h"
#include "proximity_ring/decoder.h"

enum { ETHD__EMPTY_FRAMES = 60 }; /* 0.2 s */

#define ETHD__DARK_MOST 5000 /* counts: without a calibrated dark, more than this is reflected light */
#define ETHD__GOOD_LEAST 12  /* sensors that must answer */

/* Initially all zero. */
typedef struct ethd__empty {
  uint32_t frames;
  uint32_t seen[ETHD_RAYS]; /* frames with a count of the sensor */
  double sum[ETHD_RAYS];
} ethd__empty;

/* Adds a frame; missing and saturated counts are left out. [any, rt-safe] */
void ethd__empty_add(ethd__empty *empty, const ethd__ring_frame *frame) ETHD_RT;

/* Makes the means the darks of *calibration; a sensor that counted in fewer than half of the frames gets NaN. Refuses a
   ring that isn't empty, in which a sensor counts more above its calibrated dark than it would with an object across
   the ring, 2 ring_radius away, or more than ETHD__DARK_MOST if it has no calibrated dark. Refuses also if fewer than
   ETHD__GOOD_LEAST sensors counted in half of the frames. [main] */
ETHD_MUST_CHECK ethd_status ethd__empty_check(const ethd__empty *empty, double ring_radius,
                                              ethd__calibration *calibration, char message[ETHD_MESSAGE_MAX]);

#endif
