/* Checks that the ring is empty, and takes what its sensors then count for today's darks. */
#ifndef ETHD_PROXIMITY_RING_EMPTY_H
#define ETHD_PROXIMITY_RING_EMPTY_H

#include "proximity_ring/calibration.h"
#include "proximity_ring/decoder.h"

enum { ETHD__EMPTY_FRAMES = 60 }; /* 0.2 s */

#define ETHD__DARK_MOST 5000 /* counts: more is light that comes back, when no dark was calibrated */
#define ETHD__GOOD_LEAST 12  /* sensors */

/* Zeroed: ready. */
typedef struct ethd__empty {
  uint32_t frames;
  uint32_t seen[ETHD_RAYS]; /* frames in which the sensor counted */
  double sum[ETHD_RAYS];
} ethd__empty;

/* Adds a frame; missing and saturated counts are left out. [any, rt-safe] */
void ethd__empty_add(ethd__empty *empty, const ethd__ring_frame *frame) ETHD_RT;

/* Takes the means for darks of *calibration. Refuses when a sensor counts more above its calibrated dark than what
   an object across the ring, 2 ring_radius away, would send back, or over ETHD__DARK_MOST without one:
   something is in the ring. And with under 12 sensors that counted in half of the frames; the others have NaN.
   [main] */
ETHD_MUST_CHECK ethd_status ethd__empty_check(const ethd__empty *empty, double ring_radius,
                                              ethd__calibration *calibration, char message[ETHD_MESSAGE_MAX]);

#endif
