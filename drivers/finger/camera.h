/* What a motion capture's bridge sends for each exposure: one datagram, 44 bytes, little endian. No maker's protocol: a
   bridge of some ten lines, linked with the maker's SDK, fills it.

     offset  0      4     8              16     24     32      40      42
             | EFC1 | seq | t_ns         | x    | y    | noise | flags | crc |
               4     u32   i64            f64    f64    f64     u16     u16

   seq counts exposures, modulo 2^32. t_ns is the middle of the exposure in the sender's own monotonic clock (NatNet:
   CameraMidExposureTimestamp). x, y, m: the finger's centre in R_0; noise, m: its sd, each axis, 0: not known. flags bit 0:
   the finger was seen; else x, y and noise aren't looked at; other bits are 0. crc: CRC-16/MCRF4XX of the 42 bytes before.

   The sender's clock in host time, from when its datagrams arrive: each is late by at least `delay`, so the smallest
   difference of the last ones, less `delay`, is the offset; a datagram that the network held back doesn't move it.

     arrival - t_ns |    o         o         o = a datagram
                    | o     o o o      o o
                    |____o________o________  smallest of the last 128 to 256
                    +---------------------> t_ns                                                                     */
#ifndef ETHD__FINGER_CAMERA_H
#define ETHD__FINGER_CAMERA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "ethd/vec.h"

enum { ETHD__EXPOSURE_SIZE = 44, ETHD__EXPOSURE_SEEN = 1 };

typedef struct ethd__exposure {
  uint32_t seq;
  int64_t t_ns;
  ethd_vec finger; /* m, in R_0 */
  double noise;    /* m */
  uint16_t flags;
} ethd__exposure;

/* False: no such datagram, or numbers that can't be. [any, rt-safe] */
bool ethd__exposure_decode(const uint8_t *bytes, size_t count, ethd__exposure *out) ETHD_RT;
void ethd__exposure_encode(const ethd__exposure *exposure, uint8_t out[ETHD__EXPOSURE_SIZE]) ETHD_RT;

enum { ETHD__CAMERA_BLOCK = 128 };

/* Zeroed, with `delay` set: ready. */
typedef struct ethd__camera_clock {
  int64_t delay; /* ns, from an exposure to the earliest arrival of its datagram */
  bool started;
  uint32_t seq;     /* of the last */
  int64_t t_ns;     /* likewise */
  int64_t least[2]; /* ns, arrival - t_ns: of this block, of the one before */
  uint32_t in_block;
  uint64_t lost, jumps; /* exposures missing or out of order; times that the sender or its clock began anew */
} ethd__camera_clock;

/* An exposure that arrived at arrival_ns. *sample_ns: when it was, in host time, never later than it arrived. False: it
   is older than the last one, and of no use. */
bool ethd__camera_clock_step(ethd__camera_clock *clock, const ethd__exposure *exposure, int64_t arrival_ns,
                             int64_t *sample_ns) ETHD_RT;

#endif
