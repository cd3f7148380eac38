#include "proximity_ring/decoder.h"

#include <string.h>

enum { CODED = ETHD__FRAME_WIRE - 1 };

/* The polynomial's taps are so few that a byte at once takes three shifts and no table:
     y = x ^ x << 4 (8 bits), crc = crc >> 8 ^ y << 8 ^ y << 3 ^ y >> 4, x = byte ^ crc. */
uint16_t ethd__frame_crc(const uint8_t *bytes, size_t count) {
  uint32_t crc = ETHD__FRAME_CRC_START;
  for (size_t i = 0; i < count; i++) {
    uint32_t x = (bytes[i] ^ crc) & 0xff, y = (x ^ x << 4) & 0xff;
    crc = crc >> 8 ^ y << 8 ^ y << 3 ^ y >> 4;
  }
  return (uint16_t)crc;
}

static uint32_t word(const uint8_t *at) { return at[0] | (uint32_t)at[1] << 8; }

/* COBS: each code byte stands where a zero was and says how far the next code is. */
static bool uncobs(const uint8_t coded[CODED], uint8_t out[ETHD__FRAME_SIZE]) {
  memcpy(out, coded + 1, ETHD__FRAME_SIZE);
  uint32_t at = coded[0];
  while (at < CODED) {
    uint32_t step = out[at - 1];
    out[at - 1] = 0;
    at += step;
  }
  return at == CODED;
}

static void unpack(const uint8_t raw[ETHD__FRAME_SIZE], ethd__ring_frame *out) {
  const uint8_t *t = raw + ETHD__FRAME_AT_TIME;
  out->type = raw[ETHD__FRAME_AT_TYPE];
  out->flags = raw[ETHD__FRAME_AT_FLAGS];
  out->seq = (uint16_t)word(raw + ETHD__FRAME_AT_SEQ);
  out->t_us = word(t) | word(t + 2) << 16;
  for (int k = 0; k < ETHD__FRAME_SENSORS; k++) out->counts[k] = (uint16_t)word(raw + ETHD__FRAME_AT_COUNTS + 2 * k);
}

/* Counts the frames that the sequence misses. A reset of board 0 restarts the sequence. */
static void follow(ethd__decoder *d, ethd__ring_frame *frame) {
  uint16_t step = (uint16_t)(frame->seq - d->seq);
  bool fresh = !d->started || (frame->flags & ETHD__FRAME_FIRST);
  frame->lost = fresh || step == 0 ? 0 : step - 1u;
  d->counters.repeated += !fresh && step == 0;
  d->counters.lost += frame->lost;
  d->counters.frames++;
  d->seq = frame->seq;
  d->started = true;
}

static bool is_frame(const uint8_t *piece, size_t count, ethd__ring_frame *out) {
  uint8_t raw[ETHD__FRAME_SIZE];
  if (count != CODED || !uncobs(piece, raw)) return false;
  if (raw[ETHD__FRAME_AT_TYPE] != ETHD__FRAME_TYPE || ethd__frame_crc(raw, sizeof raw) != 0) return false;
  unpack(raw, out);
  return true;
}

/* Handles the end of a piece. Two zeros in a row enclose none. */
static bool finish(ethd__decoder *d, const uint8_t *piece, size_t count, ethd__ring_frame *out) {
  bool begun = d->in_step, told = d->held > CODED;
  d->in_step = true;
  d->held = 0;
  if (count == 0) return false;
  if (is_frame(piece, count, out)) {
    follow(d, out);
    return true;
  }
  d->counters.corrupt += begun && !told;
  return false;
}

/* Keeps a piece's bytes; of one that is too long, only the fact that it is. That is counted at once, because noise
   may go on for long without a zero. */
static void hold(ethd__decoder *d, const uint8_t *bytes, size_t count) {
  bool fitted = d->held <= CODED;
  size_t room = d->held < ETHD__FRAME_WIRE ? ETHD__FRAME_WIRE - d->held : 0;
  size_t kept = count < room ? count : room;
  memcpy(d->piece + (ETHD__FRAME_WIRE - room), bytes, kept);
  d->held += (uint32_t)kept;
  d->counters.corrupt += fitted && d->held > CODED && d->in_step;
}

bool ethd__decoder_next(ethd__decoder *d, const uint8_t **at, const uint8_t *end, ethd__ring_frame *out) {
  while (*at < end) {
    const uint8_t *from = *at, *zero = memchr(from, ETHD__FRAME_DELIMITER, (size_t)(end - from));
    size_t count = (size_t)((zero ? zero : end) - from);
    bool begun = d->held != 0;
    if (begun || !zero) hold(d, from, count);
    *at = zero ? zero + 1 : end;
    if (zero && finish(d, begun ? d->piece : from, begun ? d->held : count, out)) return true;
  }
  return false;
}

void ethd__decoder_restart(ethd__decoder *d) {
  d->held = 0;
  d->started = d->in_step = false;
}

static void put_word(uint8_t *at, uint32_t value) {
  at[0] = (uint8_t)value;
  at[1] = (uint8_t)(value >> 8);
}

static void cobs(const uint8_t raw[ETHD__FRAME_SIZE], uint8_t out[CODED]) {
  uint32_t code = 0;
  memcpy(out + 1, raw, ETHD__FRAME_SIZE);
  for (uint32_t i = 1; i < CODED; i++) {
    if (out[i] != 0) continue;
    out[code] = (uint8_t)(i - code);
    code = i;
  }
  out[code] = (uint8_t)(CODED - code);
}

void ethd__frame_encode(const ethd__ring_frame *frame, uint8_t out[ETHD__FRAME_WIRE]) {
  uint8_t raw[ETHD__FRAME_SIZE];
  raw[ETHD__FRAME_AT_TYPE] = frame->type;
  raw[ETHD__FRAME_AT_FLAGS] = frame->flags;
  put_word(raw + ETHD__FRAME_AT_SEQ, frame->seq);
  put_word(raw + ETHD__FRAME_AT_TIME, frame->t_us);
  put_word(raw + ETHD__FRAME_AT_TIME + 2, frame->t_us >> 16);
  for (int k = 0; k < ETHD__FRAME_SENSORS; k++) put_word(raw + ETHD__FRAME_AT_COUNTS + 2 * k, frame->counts[k]);
  put_word(raw + ETHD__FRAME_AT_CRC, ethd__frame_crc(raw, ETHD__FRAME_AT_CRC));
  cobs(raw, out);
  out[CODED] = ETHD__FRAME_DELIMITER;
}
