/* Decodes bytes from the wire into frames, and checks COBS, length, type, CRC and sequence.

   A frame ends with a zero and contains no other, so the decoder synchronises at the next zero after any bytes; it may
   start anywhere. Bytes come in pieces of any size; nothing is allocated. All [any, rt-safe]. */
#ifndef ETHD__PROXIMITY_RING_DECODER_H
#define ETHD__PROXIMITY_RING_DECODER_H

#include <stdbool.h>
#include <stddef.h>

#include "ethd/base.h"
#include "proximity_ring/frame.h"

typedef struct ethd__ring_frame {
  uint8_t type, flags; /* ETHD__FRAME_* */
  uint16_t seq;
  uint32_t t_us;
  uint16_t counts[ETHD__FRAME_SENSORS];
  uint32_t lost; /* frames missing in the sequence before this one, corrupt ones included */
} ethd__ring_frame;

typedef struct ethd__decoder_counters {
  uint64_t frames;   /* good ones */
  uint64_t corrupt;  /* pieces between zeros that are no frame, counted once recognised; not the first since a reset */
  uint64_t lost;     /* frames missing in the sequence, corrupt ones included */
  uint64_t repeated; /* frames with the same sequence as the last one; they are delivered nevertheless */
} ethd__decoder_counters;

/* Initially all zero. */
typedef struct ethd__decoder {
  ethd__decoder_counters counters;
  uint32_t held; /* bytes of an unfinished piece; over ETHD__FRAME_WIRE: too long for a frame */
  uint16_t seq;  /* of the last frame */
  bool started;  /* a frame has come, so `seq` is valid */
  bool in_step;  /* a zero has come */
  uint8_t piece[ETHD__FRAME_WIRE];
} ethd__decoder;

/* Decodes the next frame from the bytes from *at to `end`, and moves *at behind it. False: there is no frame, and
   *at == end. */
bool ethd__decoder_next(ethd__decoder *decoder, const uint8_t **at, const uint8_t *end, ethd__ring_frame *out) ETHD_RT;

/* Drops an unfinished piece and the sequence, because the port was reopened; the counters stay. */
void ethd__decoder_restart(ethd__decoder *decoder) ETHD_RT;

/* Returns CRC-16/MCRF4XX of the bytes; it is 0 for a frame followed by its CRC. */
uint16_t ethd__frame_crc(const uint8_t *bytes, size_t count) ETHD_RT;

/* Encodes a frame as it goes over the wire; `lost` isn't part of that. */
void ethd__frame_encode(const ethd__ring_frame *frame, uint8_t out[ETHD__FRAME_WIRE]) ETHD_RT;

#endif
