/* The datagram that a motion capture's bridge sends for each exposure: 44 bytes, little endian. It is no maker's
   protocol; a bridge of some ten lines, linked with the maker's SDK, fills it.

     offset  0      4     8              16     24     32      40      42
             | EFC1 | seq | t_ns         | x    | y    | noise | flags | crc |
               4     u32   i64            f64    f64    f64     u16     u16

   seq counts exposures, modulo 2^32. t_ns is the middle of the exposure in the sender's own monotonic clock (NatNet:
   CameraMidExposureTimestamp). x and y, m, are the finger's centre in R_0; noise, m, is its standard deviation in each
   axis, 0 if it isn't known. Bit 0 of flags says that the finger was seen; without it x, y and noise are ignored. The
   other bits are 0. crc is CRC-16/MCRF4XX of the 42 bytes before it.

   The arrival of datagrams gives the sender's clock in host time: each is late by at least `delay`, so the offset is
   the smallest difference among the last ones, minus `delay`. A datagram that the network held back doesn't change it.

     arrival - t_ns |    o         o         o = a datagram
                    | o     o o o      o o
                    |____o________o________  smallest of the last 128 to 256
                    +---------------------> t_ns

   Where a bridge is started again, or its clock is set, the first four exposures only place the clock: one that the
   network held back would otherwise make readings that seem younger than they are. A clock that is set back so little
   that its exposures keep their order isn't noticed; readings then seem that much too old until 256 have come. */
#ifndef ETHD__FINGER_CAMERA_H
#define ETHD__FINGER_CAMERA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "ethd/maths.h"

enum { ETHD__EXPOSURE_SIZE = 44, ETHD__EXPOSURE_SEEN = 1 };

typedef struct ethd__exposure {
  uint32_t seq;
  int64_t t_ns;
  ethd_vec finger; /* m, in R_0 */
  double noise;    /* m */
  uint16_t flags;
} ethd__exposure;

/* Decodes a datagram. False: it isn't an exposure, or its numbers are impossible. [any, rt-safe] */
bool ethd__exposure_decode(const uint8_t *bytes, size_t count, ethd__exposure *out) ETHD_RT;
void ethd__exposure_encode(const ethd__exposure *exposure, uint8_t out[ETHD__EXPOSURE_SIZE]) ETHD_RT;

enum {
  ETHD__CAMERA_BLOCK = 128,
  ETHD__CAMERA_UNSETTLED = 4 /* exposures that place a clock after a jump; they make no reading */
};

/* A clock that begins is zero except for `delay`. */
typedef struct ethd__camera_clock {
  int64_t delay; /* ns, from an exposure to the earliest arrival of its datagram */
  bool started;
  uint32_t seq;                 /* of the last exposure */
  int64_t t_ns;                 /* of the last exposure, too */
  int64_t least[2];             /* ns: the smallest arrival - t_ns of this block, and of the block before */
  uint32_t in_block, unsettled; /* unsettled: exposures to come that make no reading */
  uint64_t lost, jumps;         /* exposures missing or out of order; times that the sender or its clock began anew */
} ethd__camera_clock;

/* Takes an exposure that arrived at arrival_ns. *sample_ns becomes its instant in host time, which is never later than
   its arrival. False: it is older than the last one, or places a clock that
   jumped, and makes no reading. */
bool ethd__camera_clock_step(ethd__camera_clock *clock, const ethd__exposure *exposure, int64_t arrival_ns,
                             int64_t *sample_ns) ETHD_RT;

#endif
