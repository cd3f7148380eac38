/* Frames of the proximity ring out of a stream of bytes. */

#include "unit/rig.h"
#include "unit/ring_frames.h"

enum { COUNT = 50 };

static uint8_t wire[COUNT * ETHD__FRAME_WIRE];

/* All frames of `size` bytes handed over in pieces of `piece`; returns how many, each as it was sent. */
static uint32_t decode(ethd__decoder *d, const uint8_t *bytes, size_t size, size_t piece) {
  uint32_t frames = 0;
  for (size_t from = 0; from < size; from += piece) {
    const uint8_t *at = bytes + from, *end = at + (size - from < piece ? size - from : piece);
    ethd__ring_frame frame;
    while (ethd__decoder_next(d, &at, end, &frame)) {
      ethd__ring_frame sent = ring_frame(frame.seq);
      ck_assert(ring_same(&frame, &sent));
      frames++;
    }
    ck_assert_ptr_eq(at, end);
  }
  return frames;
}

TEST(test_crc) {
  ck_assert_uint_eq(ethd__frame_crc((const uint8_t *)"123456789", 9), ETHD__FRAME_CRC_CHECK);
  uint32_t bitwise = ETHD__FRAME_CRC_START;
  uint8_t bytes[256];
  for (uint32_t i = 0; i < sizeof bytes; i++) {
    bitwise ^= bytes[i] = (uint8_t)draw_bits(i);
    for (int b = 0; b < 8; b++) bitwise = bitwise >> 1 ^ (bitwise & 1 ? ETHD__FRAME_CRC_POLYNOMIAL : 0);
    ck_assert_uint_eq(ethd__frame_crc(bytes, i + 1), bitwise);
  }
}

TEST(test_pieces) {
  ring_wire(0, COUNT, wire);
  for (size_t i = 0; i < sizeof wire; i++) ck_assert((wire[i] == 0) == (i % ETHD__FRAME_WIRE == ETHD__FRAME_WIRE - 1));
  for (size_t piece = 1; piece <= sizeof wire; piece += piece < 100 ? 1 : 97) {
    ethd__decoder d = {0};
    ck_assert_uint_eq(decode(&d, wire, sizeof wire, piece), COUNT);
    ck_assert(d.counters.frames == COUNT && !d.counters.corrupt && !d.counters.lost && !d.counters.repeated);
  }
}

/* Frames that are all zeros or hold none, and every number of zeros between. */
TEST(test_zeros) {
  for (uint32_t mask = 0; mask < 65536; mask += 13) {
    ethd__ring_frame frame = {.type = ETHD__FRAME_TYPE, .seq = (uint16_t)mask}, got;
    for (int k = 0; k < ETHD__FRAME_SENSORS; k++) frame.counts[k] = mask >> k & 1 ? 0xa5a5 : 0;
    ethd__frame_encode(&frame, wire);
    ck_assert_ptr_eq(memchr(wire, 0, sizeof wire), wire + ETHD__FRAME_WIRE - 1);
    ethd__decoder d = {0};
    const uint8_t *at = wire;
    ck_assert(ethd__decoder_next(&d, &at, wire + ETHD__FRAME_WIRE, &got) && ring_same(&got, &frame));
  }
}

/* Wherever one starts to listen, the next whole frame is understood, and nothing is called corrupt. */
TEST(test_any_start) {
  ring_wire(0, COUNT, wire);
  for (size_t start = 0; start <= ETHD__FRAME_WIRE; start++)
    for (size_t piece = 1; piece < 60; piece += 7) {
      ethd__decoder d = {0};
      uint32_t whole = start == 0 ? COUNT : COUNT - 1;
      ck_assert_uint_eq(decode(&d, wire + start, sizeof wire - start, piece), whole);
      ck_assert(!d.counters.corrupt && !d.counters.lost);
    }
}

/* Any byte changed, lost or doubled costs that frame (and the next, if it was the zero between). */
TEST(test_one_byte) {
  static uint8_t noisy[sizeof wire + 1];
  for (size_t hit = 0; hit < 3 * ETHD__FRAME_WIRE; hit++)
    for (int kind = 0; kind < 258; kind++) {
      size_t at = ETHD__FRAME_WIRE + hit, size = 10 * ETHD__FRAME_WIRE;
      ring_wire(0, 10, noisy);
      if (kind < 256 && noisy[at] == kind) continue;
      if (kind < 256) noisy[at] = (uint8_t)kind;
      if (kind == 256) memmove(noisy + at, noisy + at + 1, --size - at);
      if (kind == 257) memmove(noisy + at + 1, noisy + at, size++ - at);
      bool delimiter = hit % ETHD__FRAME_WIRE == ETHD__FRAME_WIRE - 1;
      uint32_t harmed = !delimiter ? 1 : kind == 257 ? 0 : 2; /* a zero twice harms none */
      ethd__decoder d = {0};
      ck_assert_uint_eq(decode(&d, noisy, size, 17), 10 - harmed);
      ck_assert_uint_eq(d.counters.lost, harmed);
      ck_assert(harmed ? d.counters.corrupt >= 1 && d.counters.corrupt <= 2 : d.counters.corrupt == 0);
    }
}

TEST(test_flood) {
  static uint8_t flood[1 << 20];
  for (uint32_t value = 1; value < 256; value += 127) {
    ethd__decoder d = {0};
    memset(flood, (int)value, sizeof flood);
    ck_assert_uint_eq(decode(&d, wire, 1, 1), 0);
    for (int i = 0; i < 4; i++) ck_assert_uint_eq(decode(&d, flood, sizeof flood, 65536 + value), 0);
    ring_wire(0, 4, wire);
    ck_assert_uint_eq(decode(&d, wire, (size_t)4 * ETHD__FRAME_WIRE, 11), 3);
  }
}

static ethd__ring_frame through(ethd__decoder *d, uint16_t seq, uint8_t flags) {
  ethd__ring_frame frame = ring_frame(seq), got = {0};
  frame.flags = flags;
  ethd__frame_encode(&frame, wire);
  const uint8_t *at = wire;
  ck_assert(ethd__decoder_next(d, &at, wire + ETHD__FRAME_WIRE, &got));
  return got;
}

TEST(test_sequence) {
  ethd__decoder d = {0};
  ck_assert_uint_eq(through(&d, 65533, 0).lost, 0); /* the first one: nothing to compare it with */
  ck_assert_uint_eq(through(&d, 65534, 0).lost, 0);
  ck_assert_uint_eq(through(&d, 2, 0).lost, 3); /* 65535, 0, 1 */
  ck_assert_uint_eq(through(&d, 2, 0).lost, 0);
  ck_assert_uint_eq(d.counters.repeated, 1);
  ck_assert_uint_eq(through(&d, 0, ETHD__FRAME_FIRST).lost, 0); /* board 0 was reset */
  ck_assert_uint_eq(through(&d, 4, 0).lost, 3);
  ethd__decoder_restart(&d);
  ck_assert_uint_eq(through(&d, 900, 0).lost, 0);
  ck_assert(d.counters.lost == 6 && d.counters.frames == 7 && d.counters.corrupt == 0);
}

/* A frame of another type is none of ours, be its CRC right. */
TEST(test_type) {
  ethd__ring_frame frame = ring_frame(1), got;
  ethd__decoder d = {.in_step = true};
  frame.type = 2;
  ethd__frame_encode(&frame, wire);
  const uint8_t *at = wire;
  ck_assert(!ethd__decoder_next(&d, &at, wire + ETHD__FRAME_WIRE, &got));
  ck_assert_uint_eq(d.counters.corrupt, 1);
}
