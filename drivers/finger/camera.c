#include "finger/camera.h"

#include <string.h>

#include "ethd/sense.h"
#include "proximity_ring/decoder.h"

#define MAGIC "EFC1"
#define NOISE_MAX 1.0      /* m */
#define BACK_NS 1000000000 /* no network holds a datagram back for so long: the sender's clock jumped back */
#define AHEAD_NS 50000000  /* nor is one so much quicker than all before: it jumped ahead */
#define ORDER_MAX 1000     /* exposures that may overtake a datagram; if more do, the sender has restarted */

enum { AT_SEQ = 4, AT_TIME = 8, AT_X = 16, AT_Y = 24, AT_NOISE = 32, AT_FLAGS = 40, AT_CRC = 42 };

/* ---- bytes ---- */

static uint64_t get(const uint8_t *at, int bytes) {
  uint64_t word = 0;
  for (int i = bytes; i--;) word = word << 8 | at[i];
  return word;
}

static double get_number(const uint8_t *at) {
  uint64_t word = get(at, 8);
  double number;
  memcpy(&number, &word, sizeof number);
  return number;
}

static void put(uint8_t *at, uint64_t word, int bytes) {
  for (int i = 0; i < bytes; i++, word >>= 8) at[i] = (uint8_t)word;
}

static void put_number(uint8_t *at, double number) {
  uint64_t word;
  memcpy(&word, &number, sizeof word);
  put(at, word, 8);
}

/* Returns whether the numbers can be an exposure's; NaN can't. */
static bool is_possible(const ethd__exposure *e) {
  return e->finger.x >= -ETHD_SENSE_LENGTH_MAX && e->finger.x <= ETHD_SENSE_LENGTH_MAX &&
         e->finger.y >= -ETHD_SENSE_LENGTH_MAX && e->finger.y <= ETHD_SENSE_LENGTH_MAX && e->noise >= 0 &&
         e->noise <= NOISE_MAX;
}

bool ethd__exposure_decode(const uint8_t *bytes, size_t count, ethd__exposure *out) {
  if (count != ETHD__EXPOSURE_SIZE || memcmp(bytes, MAGIC, 4) != 0) return false;
  if (ethd__frame_crc(bytes, ETHD__EXPOSURE_SIZE) != 0) return false;
  *out = (ethd__exposure){.seq = (uint32_t)get(bytes + AT_SEQ, 4),
                          .t_ns = (int64_t)get(bytes + AT_TIME, 8),
                          .finger = {get_number(bytes + AT_X), get_number(bytes + AT_Y)},
                          .noise = get_number(bytes + AT_NOISE),
                          .flags = (uint16_t)get(bytes + AT_FLAGS, 2)};
  if (out->flags & ~ETHD__EXPOSURE_SEEN) return false;
  return !(out->flags & ETHD__EXPOSURE_SEEN) || is_possible(out);
}

void ethd__exposure_encode(const ethd__exposure *e, uint8_t out[ETHD__EXPOSURE_SIZE]) {
  memcpy(out, MAGIC, 4);
  put(out + AT_SEQ, e->seq, 4);
  put(out + AT_TIME, (uint64_t)e->t_ns, 8);
  put_number(out + AT_X, e->finger.x);
  put_number(out + AT_Y, e->finger.y);
  put_number(out + AT_NOISE, e->noise);
  put(out + AT_FLAGS, e->flags, 2);
  put(out + AT_CRC, ethd__frame_crc(out, AT_CRC), 2);
}

/* ---- clock ---- */

/* Differences wrap round as the clocks do, because neither clock's zero means anything. */
static int64_t minus(int64_t a, int64_t b) { return (int64_t)((uint64_t)a - (uint64_t)b); }
static int64_t plus(int64_t a, int64_t b) { return (int64_t)((uint64_t)a + (uint64_t)b); }

static int64_t lesser(int64_t a, int64_t b) { return minus(a, b) < 0 ? a : b; }

static void begin(ethd__camera_clock *c, int64_t late) {
  c->jumps += c->started;
  c->unsettled = c->started ? ETHD__CAMERA_UNSETTLED : 0;
  c->started = true;
  c->least[0] = c->least[1] = late;
  c->in_block = 0;
}

/* A datagram that the network held back is older by both its count and its clock. Where only one of them is older, the
   clock was set back, or the bridge was started again and counts from 0. */
static bool jumped(const ethd__camera_clock *c, const ethd__exposure *e, int64_t late) {
  int64_t off = minus(late, lesser(c->least[0], c->least[1]));
  int32_t step = (int32_t)(e->seq - c->seq);
  bool is_newer = minus(e->t_ns, c->t_ns) > 0;
  return off > BACK_NS || off < -AHEAD_NS || step > ORDER_MAX || step < -ORDER_MAX || is_newer != (step > 0);
}

static void settle(ethd__camera_clock *c, int64_t late) {
  if (c->in_block++ == ETHD__CAMERA_BLOCK) {
    c->least[1] = c->least[0];
    c->least[0] = late;
    c->in_block = 1;
  }
  c->least[0] = lesser(c->least[0], late);
}

bool ethd__camera_clock_step(ethd__camera_clock *c, const ethd__exposure *e, int64_t arrival_ns, int64_t *sample_ns) {
  int64_t late = minus(arrival_ns, e->t_ns);
  if (!c->started || jumped(c, e, late)) {
    begin(c, late);
  } else if (minus(e->t_ns, c->t_ns) <= 0) {
    c->lost++;
    return false;
  } else {
    c->lost += e->seq - c->seq - 1;
  }
  settle(c, late);
  c->seq = e->seq;
  c->t_ns = e->t_ns;
  if (c->unsettled && c->unsettled--) return false;
  *sample_ns = minus(plus(e->t_ns, lesser(c->least[0], c->least[1])), c->delay);
  return true;
}
