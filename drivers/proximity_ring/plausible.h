/* Checks whether a frame with a good CRC is plausible: a CRC of 16 bits lets one of 65 536 damaged frames pass.

     flags     some bits are always 0, and the counts confirm others
     slew      a distance changes by at most `slack` plus `speed` times the time since the last frame
     geometry  the rays lie within `gate` of a circle of the finger's radius

   A few failing rays are left out; if more than SUSPECTS_MAX fail, the frame is bad. After three bad frames in a row
   the next one is accepted, because something was put into the ring.

   A sensor is out of use once its failed frames exceed its good frames by five, until it has been good as often. It
   fails if it is missing, saturated where no finger is, under half its dark, has a suspect ray, or is stuck: its count
   stays the same while half of the others change. All [rt]. */
#ifndef ETHD__PROXIMITY_RING_PLAUSIBLE_H
#define ETHD__PROXIMITY_RING_PLAUSIBLE_H

#include "proximity_ring/calibration.h"
#include "proximity_ring/decoder.h"

enum { ETHD__SUSPECTS_MAX = 3, ETHD__BAD_IN_A_ROW = 3, ETHD__FAILING = 5 };

/* Initially all zero but the first part, which ethd__plausible_prepare fills. */
typedef struct ethd__plausible {
  ethd_fit fit;        /* robust, with the gate */
  double speed, slack; /* m/s, m */

  bool started;
  uint16_t counts[ETHD_RAYS]; /* of the last frame */
  double d[ETHD_RAYS];        /* m, of the last good one; NaN: none */
  uint32_t t_us;              /* of the last good one, too */
  uint32_t bad_in_a_row;
  uint8_t failing[ETHD_RAYS]; /* 0 to ETHD__FAILING */
  uint32_t out;               /* bits: sensors out of use */
  uint64_t bad, suspects;     /* frames; rays left out of good ones */
} ethd__plausible;

/* Prepares the first part; gate and slack in m, speed in m/s. [main] */
ETHD_MUST_CHECK ethd_status ethd__plausible_prepare(double ring_radius, double finger_radius, double gate, double speed,
                                                    double slack, ethd__plausible *out, ethd_error *error);

/* Puts the frame's distances into `rays`, with NaN for rays that are left out and sensors out of use. False: the frame
   is bad, and `rays` is undefined. */
bool ethd__plausible_step(ethd__plausible *plausible, const ethd__calibration *calibration,
                          const ethd__ring_frame *frame, double rays[ETHD_RAYS]) ETHD_RT;

#endif
