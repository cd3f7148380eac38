/* Finds the board's clock in host time from the arrival times of its frames.

     arrival - board time
       |   o        o                  Every arrival is late by what lies between: at least `delay`, often
       |      o  o     o  o   o        more (bursts, stalls), never less. So host time runs along the lower
       |  o__________o_________o       envelope of the arrivals, `delay` below it.
       +----------------------------> board time

   The envelope is the line under all points with the least sum of distances: the edge of their lower hull at their
   mean. A point is the lowest of 16 frames, and the last 128 such blocks (7 s) count. The line is computed again with
   each block, and a point under it lowers it at once. Its slope, the drift, is used after 0.3 s, and kept over a jump,
   because a rebooted board still has its quartz.

   A frame's time must fit its sequence. If it doesn't, the clock jumped, or the frame is corrupt and has passed the
   CRC. The next frame decides: it fits either the doubtful frame or the frame before it. All [rt]. */
#ifndef ETHD__PROXIMITY_RING_BOARD_CLOCK_H
#define ETHD__PROXIMITY_RING_BOARD_CLOCK_H

#include "proximity_ring/decoder.h"

enum { ETHD__CLOCK_BLOCK = 16, ETHD__CLOCK_BLOCKS = 128 };

typedef enum ethd__clock_verdict {
  ETHD__CLOCK_GOOD = 0,
  ETHD__CLOCK_DOUBTFUL, /* the frame's time contradicts its sequence: don't use it */
  ETHD__CLOCK_JUMPED,   /* the board was reset, or its clock jumped: aligned again from this frame on */
  ETHD__CLOCK_RETURNED  /* the doubtful frame before this one was corrupt; this one is good */
} ethd__clock_verdict;

typedef struct ethd__clock_point {
  double x, y; /* board time; arrival - board time. s, from the base on */
} ethd__clock_point;

/* Initially zero except for `delay`. */
typedef struct ethd__board_clock {
  double delay; /* s, from a frame's t_us to its earliest arrival */

  double drift;     /* host seconds per board second, minus 1 */
  double offset;    /* of the envelope at x = 0, s */
  int64_t base_ns;  /* host time at which y is 0 */
  int64_t board_us; /* since the base */
  uint32_t t_us;    /* of the last good frame */
  uint16_t seq;     /* of the last good frame, too */
  bool started, doubtful;
  ethd__ring_frame doubt; /* the frame that didn't follow */
  uint32_t in_block;      /* frames of the block that is being filled */
  uint32_t blocks;        /* number of blocks since the base */
  ethd__clock_point block, points[ETHD__CLOCK_BLOCKS];
  uint64_t jumps, doubts; /* counted */
} ethd__board_clock;

/* Takes a frame whose last byte arrived at arrival_ns (CLOCK_MONOTONIC). *t_ns becomes the host's instant of its t_us,
   unless the frame is doubtful. */
ethd__clock_verdict ethd__board_clock_step(ethd__board_clock *clock, const ethd__ring_frame *frame, int64_t arrival_ns,
                                           int64_t *t_ns) ETHD_RT;

/* Starts again with the next frame, because the port was reopened; the drift stays. */
void ethd__board_clock_restart(ethd__board_clock *clock) ETHD_RT;

#endif
