/* The datagram that a tracker's bridge sends for each position of the finger: a motion capture's or a headset's
   program, linked with its maker's SDK. It is JSON (RFC 8259), at most ETHD__EXPOSURE_SIZE bytes, decoded by jansson:

     {"seq": 258, "t": 12.5, "p": [0.25, -0.1, 0.3], "noise": 0.013, "v": [0, 0, 0.4], "v_noise": 0.05, "confidence": 1}

     seq         counts the datagrams, modulo 2^32
     t           s: the instant of the position, in the sender's own monotonic clock: the middle of the exposure
                 (NatNet: CameraMidExposureTimestamp), or the time for which a headset's runtime located the joint
     p           m: the finger's centre in R_0, [x, y] or [x, y, z]; without it the finger wasn't seen
     noise       m: standard deviation of each axis; without it, or 0: not known
     v, v_noise  m/s: the finger's velocity and the standard deviation of each axis; both or neither
     confidence  0 to 1, 1 without it

   seq and t are needed. A datagram with an unknown key, a wrong type or a number out of range is refused.

   The arrival of datagrams gives the sender's clock in host time: each is late by at least `delay`, so the offset is
   the smallest difference among the last ones, minus `delay`. A datagram delayed by the network doesn't change it.

     arrival - t_ns |    o         o         o = a datagram
                    | o     o o o      o o
                    |____o________o________  smallest of the last 128 to 256
                    +---------------------> t_ns

   After a restart of the bridge, or a change of its clock, the first four exposures only synchronise the clock: a
   datagram delayed by the network would otherwise make readings seem too young. A clock that is set back so little that
   its exposures keep their order isn't noticed; readings then seem too old by this amount until 256 have come. */
#ifndef ETHD__FINGER_CAMERA_H
#define ETHD__FINGER_CAMERA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "ethd/maths.h"

enum { ETHD__EXPOSURE_SIZE = 1024 };

typedef struct ethd__exposure {
  uint32_t seq;
  int64_t t_ns;
  uint32_t axes;         /* of finger and v: 2 or 3; 0: the finger wasn't seen */
  ethd_vec3 finger, v;   /* m, m/s, in R_0 */
  double noise, v_noise; /* m, m/s; 0: not known */
  double confidence;     /* 0 to 1 */
} ethd__exposure;

/* Decodes a datagram. False: it is refused, and `why` says why. Allocates memory. [any] */
bool ethd__exposure_decode(const char *bytes, size_t count, ethd__exposure *out, char why[ETHD_MESSAGE_MAX]);

enum {
  ETHD__CAMERA_BLOCK = 128,
  ETHD__CAMERA_UNSETTLED = 4 /* exposures that synchronise a clock after a jump; they make no reading */
};

/* A clock that begins is zero except for `delay`. */
typedef struct ethd__camera_clock {
  int64_t delay; /* ns, from an exposure to the earliest arrival of its datagram */
  bool started;
  uint32_t seq;                 /* of the last exposure */
  int64_t t_ns;                 /* of the last exposure, too */
  int64_t least[2];             /* ns: the smallest arrival - t_ns of this block, and of the block before */
  uint32_t in_block, unsettled; /* unsettled: exposures to come that make no reading */
  uint64_t lost, jumps;         /* exposures missing or out of order; restarts of the sender or jumps of its clock */
} ethd__camera_clock;

/* Processes an exposure that arrived at arrival_ns. *sample_ns becomes its instant in host time, which is never later
   than its arrival. False: it makes no reading, because it is older than the last one or synchronises a clock that
   jumped. */
bool ethd__camera_clock_step(ethd__camera_clock *clock, const ethd__exposure *exposure, int64_t arrival_ns,
                             int64_t *sample_ns) ETHD_RT;

#endif
