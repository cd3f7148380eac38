/* Random numbers as a function of a key: no state is kept between calls.

   Philox 4x32-10 (Salmon et al., SC 2011) over the counter (tap, stream, counter) under the key `seed`.
   Bits are equal on every machine. [any, rt-safe] */
#ifndef ETHD__SIM_RANDOM_H
#define ETHD__SIM_RANDOM_H

#include <stdint.h>

#include "ethd/base.h"

typedef struct ethd__sim_key {
  uint64_t seed, tap;
} ethd__sim_key;

/* The purpose of a number. */
enum {
  ETHD__STREAM_SPEED,
  ETHD__STREAM_RADIUS,
  ETHD__STREAM_PHASE,
  ETHD__STREAM_START,
  ETHD__STREAM_OVERSHOOT,
  ETHD__STREAM_LATERAL,
  ETHD__STREAM_ENCODER,  /* counter: joint */
  ETHD__STREAM_CENTRE_X, /* counter: reading */
  ETHD__STREAM_CENTRE_Y,
  ETHD__STREAM_RAY,                          /* and the 15 after it */
  ETHD__STREAM_ZONE = ETHD__STREAM_RAY + 16, /* one for each barrier */
  ETHD__STREAM_NAIL = ETHD__STREAM_ZONE + 16
};

/* The block cipher itself: counter in, four random words out. */
void ethd__philox(const uint32_t key[2], uint32_t block[4]) ETHD_RT;

/* Returns a uniform number in [0, 1), a multiple of 2^-53. */
double ethd__uniform(ethd__sim_key key, uint32_t stream, uint32_t counter) ETHD_RT;

/* Returns a normal number with mean 0 and standard deviation 1. */
double ethd__normal(ethd__sim_key key, uint32_t stream, uint32_t counter) ETHD_RT;

/* Returns a normal number, drawn anew until it is within +-cut (cut > 0). */
double ethd__normal_cut(ethd__sim_key key, uint32_t stream, double cut) ETHD_RT;

#endif
