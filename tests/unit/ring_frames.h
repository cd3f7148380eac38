/* Frames of a proximity ring, drawn by number, and noise on a wire. */
#ifndef ETHD_TESTS_RING_FRAMES_H
#define ETHD_TESTS_RING_FRAMES_H

#include <string.h>

#include "draw.h"
#include "proximity_ring/decoder.h"

static inline ethd__ring_frame ring_frame(uint32_t i) {
  ethd__ring_frame f = {.type = ETHD__FRAME_TYPE, .seq = (uint16_t)i};
  f.t_us = (uint32_t)((uint64_t)i * 1000000 / ETHD__FRAME_RATE);
  for (uint32_t k = 0; k < ETHD__FRAME_SENSORS; k++)
    f.counts[k] = (uint16_t)(draw_bits((uint64_t)i * ETHD__FRAME_SENSORS + k) % 65536);
  return f;
}

/* Frames first .. first + count - 1, one behind the other. */
static inline void ring_wire(uint32_t first, uint32_t count, uint8_t *out) {
  for (uint32_t i = 0; i < count; i++) {
    ethd__ring_frame f = ring_frame(first + i);
    ethd__frame_encode(&f, out + (size_t)ETHD__FRAME_WIRE * i);
  }
}

static inline int ring_same(const ethd__ring_frame *a, const ethd__ring_frame *b) {
  return a->type == b->type && a->flags == b->flags && a->seq == b->seq && a->t_us == b->t_us &&
         memcmp(a->counts, b->counts, sizeof a->counts) == 0;
}

/* Noise number i on the bytes of one frame: flipped bits, changed, lost and doubled bytes, bursts, a cut.
   Returns how many bytes there are then, at most ETHD__FRAME_WIRE + 2. */
static inline size_t ring_noise(uint64_t i, uint8_t wire[ETHD__FRAME_WIRE + 2]) {
  size_t n = ETHD__FRAME_WIRE;
  for (uint64_t k = 0, changes = 1 + draw_bits(i * 16) % 6; k < changes; k++) {
    uint64_t r = draw_bits(i * 16 + k + 1);
    size_t at = (r >> 8) % n, length = 1 + (r >> 40) % 6;
    switch (r % 8) {
    case 0: wire[at] = (uint8_t)(r >> 16); break;
    case 1: memmove(wire + at, wire + at + 1, n - at - 1), n -= n > 1; break;
    case 2:
      if (n < ETHD__FRAME_WIRE + 2) memmove(wire + at + 1, wire + at, n - at), n++;
      break;
    case 3:
      for (size_t j = at; j < n && j < at + length; j++) wire[j] = (uint8_t)draw_bits(r + j);
      break;
    default: wire[at] ^= (uint8_t)(1u << ((r >> 16) & 7)); break;
    }
  }
  return n;
}

#endif
