/* Converts bytes with their arrival time to readings with their instant: all steps between the port and the sense.

     bytes -> decoder -> board clock -> calibration, plausibility -> rays, sample_ns

   Faults are counted per row of the fault table, so that an occasional reader misses none. No OS, no heap.
   All [rt]. */
#ifndef ETHD__PROXIMITY_RING_RECEIVER_H
#define ETHD__PROXIMITY_RING_RECEIVER_H

#include "proximity_ring/board_clock.h"
#include "proximity_ring/drift.h"
#include "proximity_ring/plausible.h"

/* Time from a frame's t_us to the middle of its measurements, which is sample_ns. [finger_fit] lag is the same in s. */
#define ETHD__MIDDLE_US (ETHD__FRAME_START_US + ETHD__FRAME_SLOT_US * (ETHD__FRAME_LANES - 1) / 2 + 85)
#define ETHD__RAY_LAG(k) (1e-6 * ETHD__FRAME_SLOT_US * ((ETHD__FRAME_LANES - 1) / 2.0 - ETHD__FRAME_SLOT(k)))

typedef struct ethd__ring_reading {
  int64_t sample_ns; /* CLOCK_MONOTONIC */
  double rays[ETHD_RAYS];
  uint32_t out;   /* bits: sensors out of use */
  bool has_drift; /* all sensors together count more or less than at calibration */
} ethd__ring_reading;

typedef struct ethd__receiver_counts {
  uint64_t readings;    /* good ones */
  uint64_t frame_lost;  /* number of events of lost, corrupt or bad frames: row 15 */
  uint64_t sensor;      /* frames with a sensor out of use: row 18 */
  uint64_t board_clock; /* jumps and doubts: row 20 */
} ethd__receiver_counts;

/* Initially all zero but calibration, with known darks, clock.delay and the prepared parts of plausible and drift. */
typedef struct ethd__receiver {
  ethd__calibration calibration;
  ethd__decoder decoder;
  ethd__board_clock clock;
  ethd__plausible plausible;
  ethd__drift drift;
  ethd__receiver_counts counts;
  uint64_t corrupt; /* the decoder's count at the last comparison */
  int64_t last_ns;  /* sample_ns of the last reading; 0: there was none */
} ethd__receiver;

/* Decodes the next reading from the bytes from *at to `end`; the last byte arrived at arrival_ns; moves *at
   behind it. False: there is no reading, and *at == end. */
bool ethd__receiver_next(ethd__receiver *receiver, const uint8_t **at, const uint8_t *end, int64_t arrival_ns,
                         ethd__ring_reading *out) ETHD_RT;

/* Starts again after the port was reopened. */
void ethd__receiver_restart(ethd__receiver *receiver) ETHD_RT;

#endif
