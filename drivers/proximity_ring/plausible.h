/* What a frame says, beyond its CRC: can it be true?

   A CRC of 16 bits lets one of 65 536 damaged frames pass. Behind it stand
     flags     bits that are always 0, and those that the counts confirm
     slew      a distance changes by `speed` times the time since the last frame and `slack` at most
     geometry  the rays lie within `gate` round a circle of the finger's radius
   A few rays that fail are left out; over SUSPECTS_MAX of them make it a bad frame. Three bad frames in a row
   are believed: something was put into the ring.

   A sensor that fails in five frames more than it does well is out of use, until it has done well as often:
   missing, saturated where no finger is, under half its dark, with a suspect ray, or stuck: the same count while
   half of the others move. All [rt]. */
#ifndef ETHD_PROXIMITY_RING_PLAUSIBLE_H
#define ETHD_PROXIMITY_RING_PLAUSIBLE_H

#include "proximity_ring/calibration.h"
#include "proximity_ring/decoder.h"

enum { ETHD__SUSPECTS_MAX = 3, ETHD__BAD_IN_A_ROW = 3, ETHD__FAILING = 5 };

/* Zeroed but for the first part, which ethd__plausible_prepare makes: ready. */
typedef struct ethd__plausible {
  ethd_fit fit;        /* robust, with the gate */
  double speed, slack; /* m/s, m */

  bool started;
  uint16_t counts[ETHD_RAYS]; /* of the last frame */
  double d[ETHD_RAYS];        /* m, of the last good one; NaN: none */
  uint32_t t_us;              /* likewise */
  uint32_t bad_in_a_row;
  uint8_t failing[ETHD_RAYS]; /* 0 to ETHD__FAILING */
  uint32_t out;               /* bits: sensors out of use */
  uint64_t bad, suspects;     /* frames; rays left out of good ones */
} ethd__plausible;

/* gate, slack in m, speed in m/s. [main] */
ETHD_MUST_CHECK ethd_status ethd__plausible_prepare(double ring_radius, double finger_radius, double gate, double speed,
                                                    double slack, ethd__plausible *out, ethd_error *error);

/* The frame's distances into rays; NaN for those left out and sensors out of use. False: a bad frame, rays are
   undefined. */
bool ethd__plausible_step(ethd__plausible *plausible, const ethd__calibration *calibration,
                          const ethd__ring_frame *frame, double rays[ETHD_RAYS]) ETHD_RT;

#endif
